//! Options of `curve`.

use clap::{ArgAction, Args};

use crate::end_condition::arguments::EndArgs;
use crate::files::answer_files::AnswerFiles;
use crate::options::{EXIT_CODES, number, whole};
use crate::place::arguments::PlaceArgs;

/// Force against displacement: stiffness, limit points, buckling, jumps
///
/// Pushes the tool along a direction and tells which force it takes, or grows a load and tells where
/// the tool goes: around limit points, with the places where the machine snaps and where it lands.
/// It follows every branch that crosses, too.
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
    #[arg(long, num_args = 2, value_names = ["FROM", "TO"], allow_negative_numbers = true, help_heading = "Motion", value_parser = number, requires = "about", conflicts_with = "displacement_mm")]
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
    /// Load that grows: force on a named node of the chain, N, base axes (repeat for more); not of a
    /// machine of several limbs
    #[arg(long, value_name = "NODE=FX,FY,FZ", action = ArgAction::Append, allow_hyphen_values = true, help_heading = "Growing load", requires = "factor")]
    pub(crate) grow: Vec<String>,
    /// from this to that many times the load
    #[arg(long, num_args = 2, value_names = ["FROM", "TO"], allow_negative_numbers = true, help_heading = "Growing load", value_parser = number)]
    pub(crate) factor: Option<Vec<f64>>,
    #[command(flatten)]
    pub(crate) end: EndArgs,
    /// Branches followed at most, from the start and from each shape that --all finds [default: 12]
    #[arg(long, value_name = "N", help_heading = "Search", allow_negative_numbers = true, value_parser = whole)]
    pub(crate) branches: Option<usize>,
    /// Points of one branch at most, each way [default: 600]
    #[arg(long, value_name = "N", help_heading = "Search", allow_negative_numbers = true, value_parser = whole)]
    pub(crate) points: Option<usize>,
    /// Search for shapes that no branch connects with the start, and follow them too
    #[arg(long, help_heading = "Search")]
    pub(crate) all: bool,
    #[command(flatten)]
    pub(crate) outputs: AnswerFiles,
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
