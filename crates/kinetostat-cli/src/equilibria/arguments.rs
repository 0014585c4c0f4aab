//! Options of `equilibria`.

use clap::Args;

use crate::end_condition::arguments::EndArgs;
use crate::files::answer_files::AnswerFiles;
use crate::options::{EXIT_CODES, number, whole};
use crate::place::arguments::PlaceArgs;

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
    pub(crate) outputs: AnswerFiles,
}

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
