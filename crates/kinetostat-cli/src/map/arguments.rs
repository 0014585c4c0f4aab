//! Options of `map`.

use std::path::PathBuf;

use clap::Args;

use crate::options::{number, whole};

/// How stiff is the machine all over its workspace
///
/// Puts the tool at every place of a grid, all with one orientation, and tells where it is stiff and
/// where soft; under a force, how far the tool goes and whether the machine stays stable. Places
/// that cannot be reached are counted. Memory does not grow with the grid.
#[derive(Debug, Args)]
#[command(after_help = crate::options::EXIT_CODES, after_long_help = HELP)]
pub(crate) struct MapArgs {
    /// Preset or model file
    #[arg(value_name = "MODEL")]
    pub(crate) model: String,
    /// Places along x of the base, mm: from, to (they rise whichever end is named first), and how many
    /// [default: 21]; or one value. Without it, as at home
    #[arg(long, num_args = 1..=3, value_names = ["FROM", "TO", "N"], allow_negative_numbers = true, help_heading = "Grid", value_parser = number)]
    pub(crate) x: Option<Vec<f64>>,
    /// The same along y
    #[arg(long, num_args = 1..=3, value_names = ["FROM", "TO", "N"], allow_negative_numbers = true, help_heading = "Grid", value_parser = number)]
    pub(crate) y: Option<Vec<f64>>,
    /// The same along z
    #[arg(long, num_args = 1..=3, value_names = ["FROM", "TO", "N"], allow_negative_numbers = true, help_heading = "Grid", value_parser = number)]
    pub(crate) z: Option<Vec<f64>>,
    /// Orientation of the tool everywhere by a named convention, as in a_b_c_kuka_deg=0,0,90, or the
    /// word follows: at every place the one nearest to that at home which the machine can have.
    /// Without it, the orientation at home; it follows where the machine cannot hold one. Several: the
    /// worst of them counts at a place
    #[arg(long, value_name = "CONVENTION=A,B,C", help_heading = "Grid")]
    pub(crate) rotation: Vec<String>,
    /// Distance of the tool's tip along z of the flange, mm
    #[arg(long, value_name = "L", allow_negative_numbers = true, value_parser = number)]
    pub(crate) tool_length_mm: Option<f64>,
    /// Force on the tool's tip, N, base axes. Several: the worst of them counts at a place
    #[arg(long, num_args = 3, value_names = ["FX", "FY", "FZ"], allow_negative_numbers = true, value_parser = number)]
    pub(crate) force: Option<Vec<f64>>,
    /// Moment on the tool about its tip, N m, base axes; one for all forces, or one for each
    #[arg(long, num_args = 3, value_names = ["MX", "MY", "MZ"], allow_negative_numbers = true, value_parser = number)]
    pub(crate) moment: Option<Vec<f64>>,
    /// Draw a section of the map (SVG)
    #[arg(long, value_name = "FILE", help_heading = "Outputs")]
    pub(crate) plot: Option<PathBuf>,
    /// What is drawn: softest, x, y, z (stiffness), displacement, rotation, or a column of a variable of
    /// --variables, as in margin, joint_efforts_2 or f1
    #[arg(
        long,
        value_name = "WHAT",
        default_value = "softest",
        help_heading = "Outputs",
        requires = "plot"
    )]
    pub(crate) show: String,
    /// Further variables for the answer and the files, SI, with commas: stiffness_stiffest,
    /// rotational_stiffness_z, principal_stiffness, principal_directions, joint_efforts, effort_share,
    /// share_to_buckling, margin, singularity_distance, f1 to f6 (natural frequencies, Hz), ...; a wrong
    /// name lists all
    #[arg(
        long,
        value_name = "NAMES",
        value_delimiter = ',',
        help_heading = "Outputs"
    )]
    pub(crate) variables: Vec<String>,
    /// Where a grid in space is cut for the drawing, as in z=150 (the nearest places, mm); across z in
    /// its middle without it
    #[arg(
        long,
        value_name = "AXIS=MM",
        allow_hyphen_values = true,
        help_heading = "Outputs",
        requires = "plot"
    )]
    pub(crate) section: Option<String>,
    /// All places as a table (CSV), written as they are solved
    #[arg(long, value_name = "FILE", help_heading = "Outputs")]
    pub(crate) csv: Option<PathBuf>,
    /// All places for ParaView (legacy VTK, SI)
    #[arg(long, value_name = "FILE", help_heading = "Outputs")]
    pub(crate) vtk: Option<PathBuf>,
    /// All places as NetCDF-3, SI
    #[arg(long, value_name = "FILE", help_heading = "Outputs")]
    pub(crate) netcdf: Option<PathBuf>,
    /// All places as Parquet, SI
    #[arg(long, value_name = "FILE", help_heading = "Outputs")]
    pub(crate) parquet: Option<PathBuf>,
    /// Keep what is solved in this directory, and go on from there after a run that was stopped
    #[arg(long, value_name = "DIR", help_heading = "Outputs")]
    pub(crate) resume: Option<PathBuf>,
    /// Print the answer as JSON; the text goes to the standard error
    #[arg(long, help_heading = "Outputs")]
    pub(crate) json: bool,
    /// Overwrite outputs that exist (never an input)
    #[arg(long, help_heading = "Outputs")]
    pub(crate) force_overwrite: bool,
    /// Number of threads; all cores without it. The result is the same
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = whole)]
    pub(crate) threads: Option<usize>,
}

/// A figure of a place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Quantity {
    /// Stiffness against a force in the softest direction
    Softest,
    /// Stiffness against a force along x
    X,
    /// Stiffness against a force along y
    Y,
    /// Stiffness against a force along z
    Z,
    /// Displacement of the tool under the load
    Displacement,
    /// Rotation of the tool under the load
    Rotation,
}

const HELP: &str = "\
Examples:
  kinetostat map orthoglide --x -60 60 41 --y -60 60 41 --plot xy.svg
  kinetostat map my_robot.toml --tool-length-mm 180 --x 800 1600 21 \\
      --y -400 400 21 --z 400 1200 5 --rotation a_b_c_kuka_deg=0,90,0 \\
      --csv map.csv
  kinetostat map my_robot.toml --x 800 1600 --z 400 1200 --force 300 0 -500 \\
      --plot displacement.svg --show displacement
  kinetostat map orthoglide --x -60 60 --y -60 60 --z -60 60 \\
      --force 100 0 0 --force 0 100 0 --variables margin,joint_efforts \\
      --netcdf map.nc --vtk map.vtk --resume map_rows

Stiffness is force per motion of the tip along it while the tool may turn, as a
spring balance would show it. Without --force and --moment the machine is
unloaded and as drawn; with one of them (zeros too) it bears that load and its
own weight, with preloads and deviations.

Exit codes:
  0    answered
  1    wrong input: a file, a number or an option; the message says which
  2    no answer: the machine can be put at none of the places
  130  stopped with Ctrl-C; nothing was written";
