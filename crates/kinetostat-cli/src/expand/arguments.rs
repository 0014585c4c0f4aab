//! Options of `expand`.

use std::path::PathBuf;

use clap::{ArgAction, Args, ValueEnum};
use kinetostat_program::Dialect;

use crate::job::arguments::ReadingArgs;

/// A program with subprograms, variables and cycles as plain blocks
///
/// Runs the program once and writes what it runs: subprograms, loops and branches as their blocks,
/// expressions as numbers, canned cycles and polar words as moves, G41 and G42 as the way of the
/// tool's centre. The moves are those of LinuxCNC. What is not followed is refused with its line.
#[derive(Debug, Args)]
#[command(after_long_help = HELP)]
pub(crate) struct ExpandArgs {
    /// G-code program
    #[arg(value_name = "PROGRAM")]
    pub(crate) program: PathBuf,
    /// File for the flat program; without it, it is printed
    #[arg(long, short, value_name = "FILE")]
    pub(crate) out: Option<PathBuf>,
    /// Folder of subprograms beside that of the program (repeat for more)
    #[arg(long, value_name = "FOLDER", action = ArgAction::Append)]
    pub(crate) subprograms: Vec<PathBuf>,
    /// Diameter of a tool for G41 and G42, mm, as in 3=6.5 (repeat for more)
    #[arg(long, value_name = "TOOL=MM", action = ArgAction::Append)]
    pub(crate) tool_diameter_mm: Vec<String>,
    /// Value of a numbered parameter before the program, as in 100=2.5 (repeat for more)
    #[arg(long, value_name = "NUMBER=VALUE", action = ArgAction::Append)]
    pub(crate) parameter: Vec<String>,
    /// Controller that the program is written for; what controllers read differently is refused without it
    #[arg(long, value_enum, value_name = "NAME")]
    pub(crate) dialect: Option<DialectArg>,
    /// Leave out the comments that say the line of each block
    #[arg(long)]
    pub(crate) no_comments: bool,
    /// Overwrite the output if it exists (never the input)
    #[arg(long)]
    pub(crate) force_overwrite: bool,
    #[command(flatten)]
    pub(crate) reading: ReadingArgs,
}

/// Controllers whose readings are followed.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub(crate) enum DialectArg {
    /// LinuxCNC 2.9
    #[value(name = "linuxcnc")]
    LinuxCnc,
    /// Fanuc's milling controllers, and those that follow them
    Fanuc,
}

impl DialectArg {
    pub(crate) fn dialect(self) -> Dialect {
        match self {
            Self::LinuxCnc => Dialect::LinuxCnc,
            Self::Fanuc => Dialect::Fanuc,
        }
    }
}

const HELP: &str = "\
Examples:
  kinetostat expand part.ngc --out flat.ngc
  kinetostat expand part.ngc --subprograms macros --tool-diameter-mm 1=6
  kinetostat compensate job.toml --program flat.ngc

Exit codes:
  0    answered
  1    wrong input: a file, a number or an option; the message says which";
