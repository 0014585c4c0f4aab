//! Options of `verify`.

use std::path::PathBuf;

use clap::Args;

use crate::job::arguments::ProgramArgs;
use crate::options::{EXIT_CODES, number, small};

/// How far off is the tool along any compensated program?
///
/// Solves the machine along a program against the one that it was made from: who or what compensated it does not matter, and
/// nothing is taken from how it was written. Says the error along it, feature by feature where the job names some, and whether it
/// keeps the tolerance. Lines are those of the original, output lines those of the program.
#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES, after_long_help = HELP)]
#[command(mut_arg("program", |arg| arg
    .long("against")
    .short(None)
    .value_name("ORIGINAL")
    .help("The original: the program as it is drawn; without it, the one that the job names")
    .long_help(None)))]
// Options of other commands along a program are hidden, and refused in words.
#[command(mut_arg("report", |arg| arg.hide(true)))]
#[command(mut_arg("restart", |arg| arg.hide(true)))]
#[command(mut_arg("free_turn", |arg| arg.hide(true)))]
#[command(mut_arg("stiff_turn", |arg| arg.hide(true)))]
#[command(mut_arg("turn_plot", |arg| arg.hide(true)))]
#[command(mut_arg("uncertain", |arg| arg.hide(true)))]
#[command(mut_arg("machines", |arg| arg.hide(true)))]
pub(crate) struct VerifyArgs {
    /// The program that is verified
    #[arg(value_name = "PROGRAM")]
    pub(crate) verified: PathBuf,
    /// Job file (TOML): model, original, placement, load, tolerances, features
    #[arg(long, value_name = "JOB")]
    pub(crate) job: Option<PathBuf>,
    /// Preset or model file
    #[arg(long, value_name = "MODEL")]
    pub(crate) model: Option<String>,
    #[command(flatten)]
    pub(crate) original: ProgramArgs,
    /// How far the tool may be off in all, micrometres [default: what `compensate` allows itself]
    #[arg(long, value_name = "UM", help_heading = "Tolerances", allow_negative_numbers = true, value_parser = number)]
    pub(crate) tolerance_um: Option<f64>,
    /// Digits after the point with which the program was written, in mm; their rounding is part of
    /// what `compensate` allows itself [default: 4, or those of the job]
    #[arg(long, value_name = "N", help_heading = "Tolerances", allow_negative_numbers = true, value_parser = small)]
    pub(crate) decimals: Option<u8>,
    /// Print the result as JSON (the text goes to the standard error), or write it to FILE
    #[arg(long, value_name = "FILE", num_args = 0..=1, default_missing_value = "-", help_heading = "Outputs")]
    pub(crate) json: Option<PathBuf>,
}

const HELP: &str = r#"Examples:
  kinetostat verify part-compensated.ngc --job job.toml
  kinetostat verify other.ngc --against part.ngc --model orthoglide \
      --tool-length-mm 100 --part-origin-mm 20 20 120 --milling 215 -10 -25 \
      --tolerance-um 5 --points points.csv

Features in the job file:
  [[features]]
  name = "pocket"
  lines = [12, 40]                 # of the original
  tolerance_um = 5                 # without it, that of the program

Exit codes:
  0    verified: every tolerance is kept
  1    wrong input: a file, a number or an option; the message says which
  2    no answer: not converged, or a point that cannot be reached
  3    a tolerance is missed, or something is cut otherwise than in the original; the
       line is said
  4    verified; the tolerances are kept only if the assumptions hold
  130  stopped with Ctrl-C; nothing was written"#;
