//! Options of `check`.

use std::path::PathBuf;

use clap::Args;

use crate::options::{EXIT_CODES, number};

/// What a model file or a job file says, in words
///
/// Of a model: platforms, limbs, actuators with units and limits, passive joints, springs, masses;
/// mobility, stiffness at home, effect of deviations, stability under gravity; and everything that
/// looks wrong. Of a job: its model, program, placement, load and outputs, and whether the ends of
/// the program can be reached; the program is read, not run.
#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES, after_long_help = CHECK_HELP)]
pub(crate) struct CheckArgs {
    /// Preset, model file or job file
    #[arg(value_name = "MODEL|JOB")]
    pub(crate) model: String,
    /// Load on the tool by which deflections are judged, N, base axes; 1 kN along each axis without it
    #[arg(long, num_args = 3, value_names = ["FX", "FY", "FZ"], allow_negative_numbers = true, value_parser = number)]
    pub(crate) force: Option<Vec<f64>>,
    /// Compare with poses jogged on the machine instead: a table (CSV) or TOML with joint values and
    /// the measured pose of the tool
    #[arg(long, value_name = "FILE")]
    pub(crate) pose: Option<PathBuf>,
    /// How far apart such poses may be, mm; 0.1 degrees for each millimetre
    #[arg(long, value_name = "MM", default_value = "1", requires = "pose", allow_negative_numbers = true, value_parser = number)]
    pub(crate) pose_tolerance_mm: f64,
    /// Print the findings as JSON; the text goes to the standard error
    #[arg(long)]
    pub(crate) json: bool,
}

const CHECK_HELP: &str = "\
Examples:
  kinetostat check orthoglide
  kinetostat check my_robot.toml --force 0 0 -500
  kinetostat check job.toml

Exit codes:
  0    answered
  1    wrong input: a file, a number or an option; the message says which
  2    no answer: not converged, or a point that cannot be reached
  130  stopped with Ctrl-C; nothing was written";
