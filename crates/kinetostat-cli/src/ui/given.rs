//! The options that stand on the command line, so that a command refuses those that it has no use for.

use std::path::{Path, PathBuf};

use clap::ArgMatches;
use clap::parser::ValueSource;
use kinetostat_diagnostic::ErrorCode;

use crate::ui::failure::{Answer, Failing};

/// Options that were given, as they are written.
#[derive(Clone, Debug, Default)]
pub(crate) struct Given {
    options: Vec<String>,
    /// True if the result is to be printed as JSON, and not only written to a file.
    pub(crate) json_on_screen: bool,
}

/// `--json` is a flag in some commands, and takes the name of a file, or `-`, in the others.
fn json_on_screen(matches: &ArgMatches) -> bool {
    let file = matches.try_get_one::<PathBuf>("json").ok().flatten();
    let flag = matches.try_get_one::<bool>("json").ok().flatten();
    file.is_some_and(|file| file == Path::new("-")) || flag.is_some_and(|flag| *flag)
}

impl Given {
    /// The options of the command that was called.
    pub(crate) fn of(command: &clap::Command, matches: &ArgMatches) -> Self {
        let Some((name, matches)) = matches.subcommand() else {
            return Self::default();
        };
        let Some(command) = command.find_subcommand(name) else {
            return Self::default();
        };
        let inner = Self::of(command, matches);
        let own = command.get_arguments().filter(|argument| {
            let id = argument.get_id().as_str();
            let source = matches
                .try_contains_id(id)
                .ok()
                .and_then(|_| matches.value_source(id));
            source == Some(ValueSource::CommandLine)
        });
        let own = own.filter_map(|argument| Some(format!("--{}", argument.get_long()?)));
        Self {
            options: own.chain(inner.options).collect(),
            json_on_screen: inner.json_on_screen || json_on_screen(matches),
        }
    }

    /// Refuses every option but these; `why` says what the others are for.
    pub(crate) fn refuse_but(&self, used: &[&str], why: &str) -> Answer<()> {
        self.refuse_first(|option| !used.contains(&option), why)
    }

    /// Refuses these options; `why` says what they are for.
    pub(crate) fn refuse(&self, unused: &[&str], why: &str) -> Answer<()> {
        self.refuse_first(|option| unused.contains(&option), why)
    }

    fn refuse_first(&self, is_unused: impl Fn(&str) -> bool, why: &str) -> Answer<()> {
        match self.options.iter().find(|option| is_unused(option)) {
            Some(option) => Err(ErrorCode::Unused.failure(format!("{option} {why}"))),
            None => Ok(()),
        }
    }
}
