//! Options of `deflect`.

use std::path::PathBuf;

use clap::Args;

use crate::job::arguments::ProgramArgs;
use crate::options::EXIT_CODES;
use crate::place::arguments::PlaceArgs;

/// How far is the tool off: at one place, or along a program
///
/// With --at: displacement and rotation under a load at one place, actuator forces and stability.
/// With a job file, or with --program: the same along a whole program, with report and tables;
/// nothing is compensated. The outputs that a job file names are those of `compensate`: name what
/// you want here with --report, --points and --json.
#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES, after_long_help = DEFLECT_HELP)]
pub(crate) struct DeflectArgs {
    /// Preset, model file, or job file
    #[arg(value_name = "MODEL|JOB")]
    pub(crate) subject: String,
    #[command(flatten)]
    pub(crate) place: PlaceArgs,
    #[command(flatten)]
    pub(crate) program: ProgramArgs,
    /// Print the result as JSON (the text goes to the standard error), or write it to FILE
    #[arg(long, value_name = "FILE", num_args = 0..=1, default_missing_value = "-", help_heading = "Outputs")]
    pub(crate) json: Option<PathBuf>,
}

const DEFLECT_HELP: &str = "\
Examples:
  kinetostat deflect orthoglide --at 0 0 0 --force 215 -10 -25
  kinetostat deflect my_robot.toml --at 1200 0 800 --tool-length-mm 150 \\
      --rotation a_b_c_kuka_deg=0,90,0 --force 0 0 -500 --moment 0 0 20
  kinetostat deflect job.toml --report report.html
  kinetostat deflect orthoglide --program part.ngc --part-origin-mm 0 0 100 \\
      --tool-length-mm 100 --force 0 0 200

Force and moment act on the tool at its tip; axes are those of the base.

Exit codes:
  0    answered
  1    wrong input: a file, a number or an option; the message says which
  2    no answer: not converged, or a point that cannot be reached
  130  stopped with Ctrl-C; nothing was written";
