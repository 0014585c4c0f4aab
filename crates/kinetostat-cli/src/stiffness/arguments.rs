//! Options of `stiffness`.

use clap::Args;

use crate::options::{EXIT_CODES, number};
use crate::place::arguments::PlaceArgs;

/// How stiff is the machine at one place
///
/// The 6 x 6 stiffness matrix of the tool with units, axes and reference point, its principal
/// directions, and the share of each limb; under a load if a force is given.
#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES, after_long_help = STIFFNESS_HELP)]
pub(crate) struct StiffnessArgs {
    /// Preset or model file
    #[arg(value_name = "MODEL")]
    pub(crate) model: String,
    #[command(flatten)]
    pub(crate) place: PlaceArgs,
    /// Force on the tool's tip, N
    #[arg(long, num_args = 3, value_names = ["FX", "FY", "FZ"], allow_negative_numbers = true, value_parser = number)]
    pub(crate) force: Option<Vec<f64>>,
    /// Moment on the tool about its tip, N m
    #[arg(long, num_args = 3, value_names = ["MX", "MY", "MZ"], allow_negative_numbers = true, value_parser = number)]
    pub(crate) moment: Option<Vec<f64>>,
    /// Distance of the tool's tip along z of the flange, mm
    #[arg(long, value_name = "L", allow_negative_numbers = true, value_parser = number)]
    pub(crate) tool_length_mm: Option<f64>,
    /// Print the result as JSON; the text goes to the standard error
    #[arg(long)]
    pub(crate) json: bool,
}

const STIFFNESS_HELP: &str = "\
Examples:
  kinetostat stiffness orthoglide --at 0 0 0
  kinetostat stiffness heavy_6r --tool-length-mm 200
  kinetostat stiffness orthoglide --at 50 50 150 --tool-length-mm 100 \\
      --force 215 -10 -25

Exit codes:
  0    answered
  1    wrong input: a file, a number or an option; the message says which
  2    no answer: not converged, or a point that cannot be reached";
