//! Options of `completions` and `man`.

use std::path::PathBuf;

use clap::Args;

/// Completions for a shell, to be saved where the shell looks for them
#[derive(Debug, Args)]
pub(crate) struct CompletionsArgs {
    /// Shell that reads the completions
    pub(crate) shell: clap_complete::Shell,
}

/// Manual pages
#[derive(Debug, Args)]
pub(crate) struct ManArgs {
    /// Write one page per command into this directory instead of printing the first
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Overwrite pages that exist
    #[arg(long, requires = "out")]
    pub(crate) force_overwrite: bool,
}
