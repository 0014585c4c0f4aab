//! Options of `reproduce`.

use std::path::PathBuf;

use clap::Args;

use crate::options::EXIT_CODES;

/// The numbers of the COROUSSO report L1.1, computed again and set beside their print
///
/// Each table, each equation with a number in it and each figure of chapters 2 to 7: what is printed,
/// what comes out, and whether they agree; where they do not, why.
#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES)]
pub(crate) struct ReproduceArgs {
    /// Which one, as in table-5.2, eq-3.34 or fig-5.7; all without it
    #[arg(value_name = "ID")]
    pub(crate) id: Option<String>,
    /// Print the numbers as JSON; the text goes to the standard error
    #[arg(long)]
    pub(crate) json: bool,
    /// Write a page with all numbers and the figures drawn
    #[arg(long, value_name = "FILE", help_heading = "Outputs")]
    pub(crate) html: Option<PathBuf>,
    /// Overwrite an existing file
    #[arg(long, help_heading = "Outputs")]
    pub(crate) force_overwrite: bool,
}
