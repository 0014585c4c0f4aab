//! Options of `map`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

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
    /// Places along x of the base, mm: from, to, and how many [default: 21]; or one value. Without
    /// it, as at home
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
    /// Without it, the orientation at home; it follows where the machine cannot hold one
    #[arg(long, value_name = "CONVENTION=A,B,C", help_heading = "Grid")]
    pub(crate) rotation: Option<String>,
    /// Distance of the tool's tip along z of the flange, mm
    #[arg(long, value_name = "L", allow_negative_numbers = true, value_parser = number)]
    pub(crate) tool_length_mm: Option<f64>,
    /// Force on the tool's tip, N, base axes
    #[arg(long, num_args = 3, value_names = ["FX", "FY", "FZ"], allow_negative_numbers = true, value_parser = number)]
    pub(crate) force: Option<Vec<f64>>,
    /// Moment on the tool about its tip, N m, base axes
    #[arg(long, num_args = 3, value_names = ["MX", "MY", "MZ"], allow_negative_numbers = true, value_parser = number)]
    pub(crate) moment: Option<Vec<f64>>,
    /// Draw a section of the map (SVG)
    #[arg(long, value_name = "FILE", help_heading = "Outputs")]
    pub(crate) plot: Option<PathBuf>,
    /// What is drawn
    #[arg(long, value_enum, value_name = "WHAT", default_value_t = Quantity::Softest, help_heading = "Outputs", requires = "plot")]
    pub(crate) show: Quantity,
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
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Quantity {
    /// Stiffness against a force in the softest direction
    Softest,
    /// Stiffness against a force along x
    X,
    /// Stiffness against a force along y
    Y,
    /// Stiffness against a force along z
    Z,
    /// How far the tool goes under the load
    Displacement,
    /// How far it turns under the load
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

Stiffness is force per motion of the tip along it while the tool may turn, as a
spring balance would show it. Without --force and --moment the machine is
unloaded and as drawn; with one of them (zeros too) it bears that load and its
own weight, with preloads and deviations.

Exit codes:
  0    answered
  1    wrong input: a file, a number or an option; the message says which
  2    no answer: the machine can be put at none of the places
  130  stopped with Ctrl-C; nothing was written";
