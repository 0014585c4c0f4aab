//! Options of `demo`.

use std::path::PathBuf;

use clap::Args;

use crate::options::{EXIT_CODES, whole};

/// Mill a circular groove on a bending machine: the first look
///
/// Writes the program, the compensated program, the report, the result and the points, and the
/// model and job files that repeat the run.
#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES)]
pub(crate) struct DemoArgs {
    /// Directory for the files; it is made if it does not exist
    #[arg(long, value_name = "DIR", default_value = "kinetostat-demo")]
    pub(crate) out: PathBuf,
    /// Overwrite files of the same names in it
    #[arg(long)]
    pub(crate) force_overwrite: bool,
    /// Print the result as JSON; the text goes to the standard error
    #[arg(long)]
    pub(crate) json: bool,
    /// Number of threads; all cores without it
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = whole)]
    pub(crate) threads: Option<usize>,
}
