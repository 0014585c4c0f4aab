//! Options of `curve` and `equilibria`.

use std::path::PathBuf;

use clap::{ArgAction, Args};

use crate::command_line::{EXIT_CODES, PlaceArgs, number, whole};

/// Force against displacement: stiffness, limit points, buckling, jumps
///
/// Pushes the tool along a direction and tells which force it takes, or grows a load and tells where
/// the tool goes: around limit points, with the places where the machine snaps and where it lands.
/// Of a model with one limb between base and tool it follows every branch that crosses, too; of a
/// machine of several limbs or platforms the branch of the start.
#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES, after_long_help = CURVE_HELP)]
pub(crate) struct CurveArgs {
    /// Preset or model file
    #[arg(value_name = "MODEL")]
    pub(crate) model: String,
    #[command(flatten)]
    pub(crate) place: PlaceArgs,
    /// Distance of the tool's tip along z of the flange, mm
    #[arg(long, value_name = "L", allow_negative_numbers = true, value_parser = number)]
    pub(crate) tool_length_mm: Option<f64>,
    /// Push the tool along this direction of the base
    #[arg(long, num_args = 3, value_names = ["X", "Y", "Z"], allow_negative_numbers = true, help_heading = "Motion", value_parser = number, conflicts_with_all = ["about", "factor"])]
    pub(crate) direction: Option<Vec<f64>>,
    /// from this to that displacement, counted from the commanded place, mm
    #[arg(long, num_args = 2, value_names = ["FROM", "TO"], allow_negative_numbers = true, help_heading = "Motion", value_parser = number, requires = "direction")]
    pub(crate) displacement_mm: Option<Vec<f64>>,
    /// Turn the tool about this direction of the base
    #[arg(long, num_args = 3, value_names = ["X", "Y", "Z"], allow_negative_numbers = true, help_heading = "Motion", value_parser = number, conflicts_with = "factor")]
    pub(crate) about: Option<Vec<f64>>,
    /// from this to that angle, counted from the commanded place, degrees
    #[arg(long, num_args = 2, value_names = ["FROM", "TO"], allow_negative_numbers = true, help_heading = "Motion", value_parser = number, requires = "about")]
    pub(crate) turn_deg: Option<Vec<f64>>,
    /// The curve ends where the force along the direction (N, or N m) leaves these limits
    #[arg(long, num_args = 2, value_names = ["LOW", "HIGH"], allow_negative_numbers = true, help_heading = "Motion", value_parser = number, conflicts_with = "factor")]
    pub(crate) force_limits: Option<Vec<f64>>,
    /// Load that grows: force on the tool's tip, N, base axes
    #[arg(long, num_args = 3, value_names = ["FX", "FY", "FZ"], allow_negative_numbers = true, help_heading = "Growing load", value_parser = number, requires = "factor")]
    pub(crate) force: Option<Vec<f64>>,
    /// Load that grows: moment on the tool about its tip, N m, base axes
    #[arg(long, num_args = 3, value_names = ["MX", "MY", "MZ"], allow_negative_numbers = true, help_heading = "Growing load", value_parser = number, requires = "factor")]
    pub(crate) moment: Option<Vec<f64>>,
    /// Load that grows: force on a named node of the chain, N, base axes (repeat for more)
    #[arg(long, value_name = "NODE=FX,FY,FZ", action = ArgAction::Append, allow_hyphen_values = true, help_heading = "Growing load", requires = "factor")]
    pub(crate) grow: Vec<String>,
    /// from this to that many times the load
    #[arg(long, num_args = 2, value_names = ["FROM", "TO"], allow_negative_numbers = true, help_heading = "Growing load", value_parser = number)]
    pub(crate) factor: Option<Vec<f64>>,
    #[command(flatten)]
    pub(crate) end: EndArgs,
    /// Branches followed at most [default: 12]
    #[arg(long, value_name = "N", help_heading = "Search", allow_negative_numbers = true, value_parser = whole)]
    pub(crate) branches: Option<usize>,
    /// Points of one branch at most, each way [default: 600]
    #[arg(long, value_name = "N", help_heading = "Search", allow_negative_numbers = true, value_parser = whole)]
    pub(crate) points: Option<usize>,
    /// Search for shapes that no branch connects with the start, and follow them too
    #[arg(long, help_heading = "Search")]
    pub(crate) all: bool,
    #[command(flatten)]
    pub(crate) outputs: CurveOutputs,
}

/// All shapes that a chain or a machine can take while its tool is held, or under a force
///
/// A chain may have several equilibria, stable and unstable, for one place of its tool, and so has a
/// machine near a flat posture: this finds them, sorts them by energy, and says how complete the
/// list is and how sure.
#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES, after_long_help = EQUILIBRIA_HELP)]
pub(crate) struct EquilibriaArgs {
    /// Preset or model file
    #[arg(value_name = "MODEL")]
    pub(crate) model: String,
    #[command(flatten)]
    pub(crate) place: PlaceArgs,
    /// Distance of the tool's tip along z of the flange, mm
    #[arg(long, value_name = "L", allow_negative_numbers = true, value_parser = number)]
    pub(crate) tool_length_mm: Option<f64>,
    /// The tool is held this far from the commanded place, base axes, mm
    #[arg(long, num_args = 3, value_names = ["DX", "DY", "DZ"], allow_negative_numbers = true, value_parser = number)]
    pub(crate) displaced_mm: Option<Vec<f64>>,
    /// and turned by this rotation vector, base axes, degrees
    #[arg(long, num_args = 3, value_names = ["RX", "RY", "RZ"], allow_negative_numbers = true, value_parser = number)]
    pub(crate) turned_deg: Option<Vec<f64>>,
    /// Force on the tool's tip, N, base axes; with it the tool is free unless --hold says otherwise
    #[arg(long, num_args = 3, value_names = ["FX", "FY", "FZ"], allow_negative_numbers = true, value_parser = number, conflicts_with = "constant_force")]
    pub(crate) force: Option<Vec<f64>>,
    /// Moment on the tool about its tip, N m, base axes
    #[arg(long, num_args = 3, value_names = ["MX", "MY", "MZ"], allow_negative_numbers = true, value_parser = number, conflicts_with = "constant_moment")]
    pub(crate) moment: Option<Vec<f64>>,
    #[command(flatten)]
    pub(crate) end: EndArgs,
    /// Evenly spread starts at most [default: 5000]
    #[arg(long, value_name = "N", help_heading = "Search", allow_negative_numbers = true, value_parser = whole)]
    pub(crate) starts: Option<usize>,
    /// The search ends after this many starts in a row that found nothing new [default: 400; 100 for a machine of several limbs]
    #[arg(long, value_name = "N", help_heading = "Search", allow_negative_numbers = true, value_parser = whole)]
    pub(crate) fruitless: Option<usize>,
    #[command(flatten)]
    pub(crate) outputs: CurveOutputs,
}

/// What holds the tool, and what acts all the time.
#[derive(Debug, Default, Args)]
pub(crate) struct EndArgs {
    /// Directions in which the tool is held, as in x,y,rz; the others are free. Also: all, none
    #[arg(
        long,
        value_name = "LIST",
        help_heading = "Tool",
        conflicts_with = "free"
    )]
    pub(crate) hold: Option<String>,
    /// Directions in which the tool is free, as in y,rz; the others are held. Also: rotations, and
    /// others (all but the one it is pushed along)
    #[arg(long, value_name = "LIST", help_heading = "Tool")]
    pub(crate) free: Option<String>,
    /// Axes of these directions in the base, as in a_b_c_kuka_deg=30,0,0; without it, the base
    #[arg(long, value_name = "CONVENTION=A,B,C", help_heading = "Tool")]
    pub(crate) axes: Option<String>,
    /// Force that acts on the tool's tip all the time, N, base axes
    #[arg(long, num_args = 3, value_names = ["FX", "FY", "FZ"], allow_negative_numbers = true, help_heading = "Constant load", value_parser = number)]
    pub(crate) constant_force: Option<Vec<f64>>,
    /// Moment that acts on the tool all the time, N m, base axes
    #[arg(long, num_args = 3, value_names = ["MX", "MY", "MZ"], allow_negative_numbers = true, help_heading = "Constant load", value_parser = number)]
    pub(crate) constant_moment: Option<Vec<f64>>,
    /// Force on a named node of the chain all the time, N, base axes (repeat for more)
    #[arg(long, value_name = "NODE=FX,FY,FZ", action = ArgAction::Append, allow_hyphen_values = true, help_heading = "Constant load")]
    pub(crate) load: Vec<String>,
}

/// Where the answer goes besides the screen.
#[derive(Debug, Default, Args)]
pub(crate) struct CurveOutputs {
    /// Print the result as JSON (the text goes to the standard error), or write it to FILE
    #[arg(long, value_name = "FILE", num_args = 0..=1, default_missing_value = "-", help_heading = "Outputs")]
    pub(crate) json: Option<PathBuf>,
    /// All points as a table (CSV)
    #[arg(long, value_name = "FILE", help_heading = "Outputs")]
    pub(crate) csv: Option<PathBuf>,
    /// The drawing (SVG)
    #[arg(long, value_name = "FILE", help_heading = "Outputs")]
    pub(crate) plot: Option<PathBuf>,
    /// Overwrite outputs that exist (never an input)
    #[arg(long, help_heading = "Outputs")]
    pub(crate) force_overwrite: bool,
}

const CURVE_HELP: &str = "\
Examples:
  kinetostat curve three_link_z --direction -1 0 0 --displacement-mm 0 400 \\
      --plot z.svg
      push a Z-shaped chain together by 400 mm: where does it buckle?
  kinetostat curve two_link --direction 1 0 0 --displacement-mm -100 60 \\
      --load elbow=0,-0.5,0
      the same with a load of 0.5 N down on the node 'elbow'
  kinetostat curve three_link_s --force -1 0 0 --factor 0 2 --hold y
      grow a force along the chain: critical load factor, buckling mode
  kinetostat curve heavy_6r --at 1200 0 900 --direction 0 0 1 \\
      --displacement-mm -2 2 --free others --csv points.csv
  kinetostat curve orthoglide --at -120 -120 -120 --direction -1 -1 -1 \\
      --displacement-mm -20 40 --plot flat.svg
      a parallel machine pushed through its flat posture

Solid lines are stable, dashed ones are not. Unless --hold or --free say
otherwise, a tool that is pushed is held in all other directions, and a tool
under a growing load is free in all directions.

Exit codes:
  0    answered
  1    wrong input: a file, a number or an option; the message says which
  2    no answer: not converged, or a point that cannot be reached
  130  stopped with Ctrl-C; nothing was written";

const EQUILIBRIA_HELP: &str = "\
Examples:
  kinetostat equilibria three_link_z --displaced-mm -200 0 0 --plot shapes.svg
      the shapes of a Z-shaped chain pushed together by 200 mm
  kinetostat equilibria two_link --load elbow=0,-1.5,0
      with a load of 1.5 N down on the node 'elbow'
  kinetostat equilibria my_robot.toml --at 1200 0 900 --force 0 0 -3000 --json
  kinetostat equilibria orthoglide --at -120 -120 -120 --force 0 0 0
      a parallel machine near its flat posture: it may also rest behind it

Without a force the tool is held at its commanded place (or displaced from it),
with one it is free; --hold and --free say otherwise, direction by direction.

Exit codes:
  0    answered
  1    wrong input: a file, a number or an option; the message says which
  2    no answer: not converged, or a point that cannot be reached
  130  stopped with Ctrl-C; nothing was written";
