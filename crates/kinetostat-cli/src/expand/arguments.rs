//! Options of `expand`.

use std::path::PathBuf;

use clap::Args;

use crate::job::arguments::ReadingArgs;
use crate::job::expansion::arguments::ExpansionArgs;
use crate::job::robot_arguments::StatedArgs;

/// A program with subprograms, variables and cycles as plain blocks
///
/// Runs the program once and writes what it runs: subprograms, loops and branches as their blocks,
/// expressions as numbers, canned cycles and polar words as moves, G41 and G42 as the way of the
/// tool's centre. The moves are those of LinuxCNC. What is not followed is refused with its line.
#[derive(Debug, Args)]
#[command(after_long_help = HELP)]
pub(crate) struct ExpandArgs {
    /// Program in G-code, of SINUMERIK (.mpf) or Heidenhain (.h), in APT (.apt, .cls), KRL (.src) or RAPID (.mod)
    #[arg(value_name = "PROGRAM")]
    pub(crate) program: PathBuf,
    /// File for the flat program; without it, it is printed
    #[arg(long, short, value_name = "FILE")]
    pub(crate) out: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) with: ExpansionArgs,
    #[command(flatten)]
    pub(crate) stated: StatedArgs,
    /// Overwrite the output if it exists (never the input)
    #[arg(long)]
    pub(crate) force_overwrite: bool,
    #[command(flatten)]
    pub(crate) reading: ReadingArgs,
}

const HELP: &str = "\
Examples:
  kinetostat expand part.ngc --out flat.ngc
  kinetostat expand part.ngc --subprograms macros --tool-diameter-mm 1=6
  kinetostat compensate job.toml --program part.ngc --expand
      the same on the way to another command

Exit codes:
  0    answered
  1    wrong input: a file, a number or an option; the message says which";
