//! `kinetostat completions` and `kinetostat man`: completions for a shell, and manual pages.
//!
//! It takes the command line itself, from above, and gives files made of it.

use std::path::{Path, PathBuf};

use clap::Args;
use kinetostat_diagnostic::ErrorCode;

use crate::files::outputs::{Existing, Outputs, written};
use crate::ui::failure::{Answer, Failing};
use crate::ui::screen::{self, Stream};

pub(crate) fn completions(args: &CompletionsArgs, mut command: clap::Command) -> Answer<()> {
    let mut bytes = Vec::new();
    clap_complete::generate(args.shell, &mut command, "kinetostat", &mut bytes);
    screen::print_bytes(&bytes)
}

pub(crate) fn man(args: &ManArgs, mut root: clap::Command) -> Answer<()> {
    root.build();
    let page = |command: &clap::Command| -> Answer<Vec<u8>> {
        let mut bytes = Vec::new();
        clap_mangen::Man::new(command.clone())
            .render(&mut bytes)
            .map_err(|error| {
                ErrorCode::Internal.failure(format!("the manual page cannot be made: {error}"))
            })?;
        Ok(bytes)
    };
    let Some(directory) = &args.out else {
        return screen::print_bytes(&page(&root)?);
    };
    let existing = if args.force_overwrite {
        Existing::Replace
    } else {
        Existing::KeepSame
    };
    let mut outputs = Outputs::new(existing, Vec::new());
    let mut all = vec![("kinetostat".to_owned(), root.clone())];
    collect(&root, "kinetostat", &mut all);
    for (name, command) in &all {
        let target = Path::new(directory).join(format!("{name}.1"));
        let index = outputs.claim("manual page", &target)?;
        outputs.fill(index, &page(command)?)?;
    }
    let paths = outputs.commit()?;
    screen::print(Stream::Out, written(&paths).trim_start())
}

/// All subcommands, named as in `kinetostat-model-show`.
fn collect(command: &clap::Command, prefix: &str, all: &mut Vec<(String, clap::Command)>) {
    for sub in command.get_subcommands().filter(|s| s.get_name() != "help") {
        let name = format!("{prefix}-{}", sub.get_name());
        all.push((name.clone(), sub.clone()));
        collect(sub, &name, all);
    }
}

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
