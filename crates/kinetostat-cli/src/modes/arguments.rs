//! Options of `modes`.

use clap::Args;

use crate::files::answer_files::AnswerFiles;
use crate::options::{EXIT_CODES, whole};
use crate::vibration::arguments::VibrationArgs;
use crate::vibration::damping::DampingArgs;

/// At which frequencies a machine vibrates at a place, and what moves
///
/// Modes about the equilibrium under weight, preloads and the load: signed frequencies (negative:
/// unstable), motion of the tool, shares of kinetic energy by body and of elastic energy by joint and
/// link, and how many directions vibrate, are free, unstable, massless, neutral or rigid.
#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES, after_long_help = HELP)]
pub(crate) struct ModesArgs {
    #[command(flatten)]
    pub(crate) machine: VibrationArgs,
    /// Directions in which the tool is held while it vibrates, as in x,y,rz; also: all
    #[arg(long, value_name = "LIST")]
    pub(crate) hold: Option<String>,
    /// How many modes are shown, the lowest first; unstable and free ones come before
    #[arg(long, value_name = "N", default_value = "8", allow_negative_numbers = true, value_parser = whole)]
    pub(crate) modes: usize,
    #[command(flatten)]
    pub(crate) damping: DampingArgs,
    #[command(flatten)]
    pub(crate) outputs: AnswerFiles,
}

const HELP: &str = "\
Examples:
  kinetostat modes heavy_6r
  kinetostat modes heavy_6r --at 1500 300 900 --tool-length-mm 150 \\
      --force 300 0 -500 --damping 0.03 --plot shapes.svg
  kinetostat modes heavy_6r --hold x,y,z --csv modes.csv

Exit codes:
  0    answered; unstable, free and neutral directions are answers
  1    wrong input: a file, a number or an option, or a model without mass
  2    no answer: not converged, or a point that cannot be reached";
