//! The kinetostat command as a library: how far a machine bends along a program, and a program that cuts where
//! it should.
//!
//! One folder per command; commands do not know each other. Below them, from the top down, what they share:
//! `shown` (machine and path in three dimensions), `program` (a run along a program), `vibration` (a machine that vibrates at a place), `end_condition` (how a tool is held), `job` (the query of such a run), `place`
//! (one place in the workspace), `machine` (what is said of a machine), `options`, `files`, and `ui`, which prints
//! and knows the exit codes. `command_line` stands above all.
//!
//! The command itself calls [`main`]; another program, as the Python package, calls [`run_inside`].

mod assemble;
mod chatter;
mod check;
mod command_line;
mod compare;
mod compensate;
mod convert;
mod curve;
mod deflect;
mod demo;
mod dialect;
mod end_condition;
mod engagement;
mod equilibria;
mod expand;
mod explain;
mod files;
mod force;
mod frf;
mod identify;
mod import;
mod job;
mod lobes;
mod long;
mod machine;
mod map;
mod mirror;
mod model;
mod modes;
mod options;
mod place;
mod placing;
mod plan_measurement;
mod program;
mod reproduce;
mod schema;
mod shares;
mod shell;
mod shown;
mod start;
mod stiffness;
mod tolerance;
mod ui;
mod verify;
mod vibration;
mod view;

pub use kinetostat_view::Refused;
pub use shown::viewed::Viewed;

use std::ffi::OsString;
use std::process::ExitCode;
use std::sync::Arc;

use clap::error::ErrorKind;
use clap::{CommandFactory, FromArgMatches};
use kinetostat_diagnostic::ErrorCode;
use kinetostat_machining::Watch;

use crate::command_line::help::{with_help_words, with_short_help};
use crate::command_line::inputs::{self, with_spellings};
use crate::command_line::{Cli, Command, no_number, plain_numbers};
use crate::files::journal;
use crate::ui::failure::{Answer, Code, Failing, Failure};
use crate::ui::given::Given;
use crate::ui::host::{self, Host};
use crate::ui::{json, progress, screen};

/// Entry point of the command as a process of its own.
///
/// Words come from the process, and so do exit code, printed text and Ctrl-C.
#[must_use]
pub fn main() -> ExitCode {
    ExitCode::from(run_as_process(std::env::args_os()))
}

/// Entry point with given words, the first of them the program's name: it prints to the standard streams, catches Ctrl-C
/// and returns the exit code.
#[must_use]
pub fn run_as_process(words: impl Iterator<Item = OsString>) -> u8 {
    answer(words, || {
        progress::catch_interrupts(journal::remove_temporary);
        keep_quiet_about_broken_tables();
    })
}

/// Silences panics of the Parquet library about broken files: they are caught and reported where the file is read.
fn keep_quiet_about_broken_tables() {
    let usual = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        let place = panic.location().map(std::panic::Location::file);
        if !place.is_some_and(|file| file.contains("parquet-")) {
            usual(panic);
        }
    }));
}

/// Result of a command that ran inside another program.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Outcome {
    /// 0 answered, 1 wrong input, 2 no answer, 3 tolerance missed, 130 stopped: as the exit code of the process would be.
    pub code: u8,
    /// Standard output.
    pub out: Vec<u8>,
    /// Standard error, without colours.
    pub err: Vec<u8>,
}

/// Runs a command inside another program: nothing is printed, and no signal is caught. Several threads may do so at once.
///
/// `words` begin with the name of the command (`stiffness`). `watch` hears of progress; where it says that the work
/// is cancelled the command ends with code 130 and no file is put in place.
///
/// ```
/// # use std::sync::Arc;
/// use kinetostat_machining::Unwatched;
///
/// let words = ["stiffness", "orthoglide", "--at", "0", "0", "0", "--json"];
/// let outcome = kinetostat_cli::run_inside(words.map(Into::into), Arc::new(Unwatched));
/// assert_eq!(outcome.code, 0);
/// assert!(outcome.out.starts_with(b"{"));
/// ```
pub fn run_inside(
    words: impl IntoIterator<Item = OsString>,
    watch: Arc<dyn Watch + Send + Sync>,
) -> Outcome {
    let host = Arc::new(Host::new(watch));
    let all = std::iter::once(OsString::from("kinetostat")).chain(words);
    let code = host::working_for(Some(host.clone()), || answer(all, || ()));
    let (out, err) = host.printed();
    Outcome { code, out, err }
}

/// All commands with their options, as the reader of the command line knows them: from it the interface of the Python
/// package is made.
///
/// ```
/// let command = kinetostat_cli::command();
/// assert!(command.find_subcommand("stiffness").is_some());
/// ```
#[must_use]
pub fn command() -> clap::Command {
    Cli::command()
}

/// The exit code of a command; `begin` is called when its words are understood.
fn answer(words: impl Iterator<Item = OsString>, begin: impl FnOnce()) -> u8 {
    let words = with_help_words(plain_numbers(words));
    let asks_for_json = asks_for_json(&words);
    if let Some(what) = no_number(&words) {
        return refused(&ErrorCode::Value.failure(what), asks_for_json);
    }
    let command = Cli::command();
    let words = match inputs::in_place(&command, words) {
        Ok(words) => words,
        Err(failure) => return refused(&failure, asks_for_json),
    };
    let (cli, given) = match parsed(command, words) {
        Ok(parsed) => parsed,
        Err(error) => {
            screen::complain_of_line(&error);
            // Help and version were requested; everything else is wrong input.
            if matches!(
                error.kind(),
                ErrorKind::DisplayHelp | ErrorKind::DisplayVersion
            ) {
                return 0;
            }
            if asks_for_json {
                let text = error.render().to_string();
                let failure = ErrorCode::CommandLine.failure(text.trim());
                json::print_errors(&failure);
            }
            return Code::WrongInput as u8;
        }
    };
    begin();
    match run(cli.command, &given) {
        Ok(()) => 0,
        Err(failure) => refused(&failure, given.json_on_screen),
    }
}

/// True if words that are not understood ask for JSON on the screen: `--json` without the name of a file.
fn asks_for_json(words: &[OsString]) -> bool {
    let mut after = words.iter().skip_while(|word| *word != "--json");
    let next = |word: &OsString| word.to_str().is_some_and(|word| word.starts_with('-'));
    after.next().is_some() && after.next().is_none_or(next)
}

/// Reports a failure, with `as_json` also as JSON on the standard output, and returns its exit code.
fn refused(failure: &Failure, as_json: bool) -> u8 {
    screen::complain(failure);
    if as_json {
        json::print_errors(failure);
    }
    failure.code() as u8
}

/// The command of a line, and the options that it gives.
fn parsed(command: clap::Command, words: Vec<OsString>) -> Result<(Cli, Given), clap::Error> {
    let mut command = with_spellings(command);
    if words.iter().any(|word| word == "-h") {
        command = with_short_help(command);
    }
    let mut matches = command.try_get_matches_from_mut(words)?;
    let given = Given::of(&command, &matches);
    let cli = Cli::from_arg_matches_mut(&mut matches);
    Ok((cli.map_err(|error| error.format(&mut command))?, given))
}

fn run(command: Command, given: &Given) -> Answer<()> {
    match command {
        Command::Demo(args) => demo::run(&args),
        Command::Start(args) => start::run(&args),
        Command::Compensate(args) => compensate::run(*args, given),
        Command::Deflect(args) => deflect::run(*args, given),
        Command::Stiffness(args) => stiffness::run(&args),
        Command::Shares(args) => shares::run(&args),
        Command::Modes(args) => modes::run(&args),
        Command::Frf(args) => frf::run(&args),
        Command::Lobes(args) => lobes::run(&args, given),
        Command::Chatter(args) => chatter::run(&args),
        Command::Compare(args) => compare::run(&args),
        Command::Map(args) => map::run(&args),
        Command::Mirror(args) => mirror::run(&args),
        Command::Place(args) => placing::run(&args, given),
        Command::Verify(args) => verify::run(&args),
        Command::Tolerance(args) => tolerance::run(&args),
        Command::Assemble(args) => assemble::run(&args),
        Command::Curve(args) => curve::run(&args),
        Command::Equilibria(args) => equilibria::run(&args),
        Command::Force(args) => force::run(&args, given),
        Command::Engagement(args) => engagement::run(&args),
        Command::Expand(args) => expand::run(&args),
        Command::Convert(args) => convert::run(&args),
        Command::Dialect(args) => dialect::run(&args),
        Command::Check(args) => check::run(&args),
        Command::Identify(args) => identify::run(&args),
        Command::PlanMeasurement(args) => plan_measurement::run(&args),
        Command::Import(args) => import::run(&args),
        Command::Reproduce(args) => reproduce::run(&args),
        Command::Model(args) => model::run(&args),
        Command::View(args) => view::run(&args),
        Command::Schema(args) => schema::run(&args),
        Command::Explain(args) => explain::run(&args),
        Command::Completions(args) => shell::completions(&args, Cli::command()),
        Command::Man(args) => shell::man(&args, Cli::command()),
    }
}
