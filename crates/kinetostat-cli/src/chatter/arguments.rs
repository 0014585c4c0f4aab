//! Options of `chatter`.

use std::path::PathBuf;

use clap::Args;

use crate::files::answer_files::AnswerFiles;
use crate::options::{EXIT_CODES, number, whole};
use crate::vibration::damping::DampingArgs;

/// Where a program chatters, and at which spindle speed and depth it would not
///
/// Takes the job of `compensate` with a material, a cutter and a stock (or an engagement), and a model
/// with masses. Along the program the tools go through the stock; wherever the cut or the posture
/// changes, the limit of depth at the programmed spindle speed is computed: exact, in the posture of
/// the machine there, under the mean force of the cut. Where it does not chatter, the vibration that
/// the passing teeth force, and what it leaves on the wall. Flat end mills with straight edges or a helix;
/// spindles that turn to the right; no process damping.
#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES, after_long_help = HELP)]
pub(crate) struct ChatterArgs {
    /// Job file (TOML)
    #[arg(value_name = "JOB")]
    pub(crate) job: PathBuf,
    /// Preset or model file, in place of the job's
    #[arg(long, value_name = "MODEL")]
    pub(crate) model: Option<String>,
    /// G-code program, in place of the job's
    #[arg(long, short, value_name = "FILE")]
    pub(crate) program: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) damping: DampingArgs,
    /// Modes above this count by their flexibility at rest, Hz [default: 300, and as far as modes count]
    #[arg(long, value_name = "F", allow_negative_numbers = true, value_parser = number)]
    pub(crate) modes_up_to_hz: Option<f64>,
    /// Places of one cut that are farther apart are judged by themselves, mm [default: 25]
    #[arg(long, value_name = "MM", allow_negative_numbers = true, value_parser = number)]
    pub(crate) every_mm: Option<f64>,
    /// Most places that are judged [default: 2000]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = whole)]
    pub(crate) most_places: Option<usize>,
    /// Number of threads; all cores without it. The result is the same
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = whole)]
    pub(crate) threads: Option<usize>,
    #[command(flatten)]
    pub(crate) outputs: AnswerFiles,
}

const HELP: &str = "\
Examples:
  kinetostat chatter milling.toml --damping 0.03
  kinetostat chatter milling.toml --damping 0.03 --plot chatter.svg --csv chatter.csv

Exit codes:
  0    answered, whether it chatters or not
  1    wrong input: a file, a number or an option, or a model without mass
  2    no answer: not converged, or a point that cannot be reached
  130  stopped with Ctrl-C; nothing was written";
