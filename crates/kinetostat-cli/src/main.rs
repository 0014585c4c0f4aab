//! The kinetostat command: how far a machine bends along a program, and a program that cuts where
//! it should.
//!
//! One folder per command; commands do not know each other. Below them, from the top down, what they share:
//! `program` (a run along a program), `end_condition` (how a tool is held), `job` (the query of such a run), `place`
//! (one place in the workspace), `machine` (what is said of a machine), `options`, `files`, and `ui`, which prints
//! and knows the exit codes. `command_line` stands above all.

mod assemble;
mod check;
mod command_line;
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
mod files;
mod force;
mod import;
mod job;
mod machine;
mod map;
mod model;
mod options;
mod place;
mod program;
mod reproduce;
mod shell;
mod stiffness;
mod ui;

use std::process::ExitCode;

use clap::error::ErrorKind;
use clap::{CommandFactory, Parser};

use crate::command_line::negative_numbers::{no_number, plain_numbers};
use crate::command_line::{Cli, Command};
use crate::files::journal;
use crate::ui::failure::{self, Answer, Code};
use crate::ui::{progress, screen};

fn main() -> ExitCode {
    let words = plain_numbers(std::env::args_os());
    if let Some(what) = no_number(&words) {
        screen::complain(&failure::Failure::input(what));
        return ExitCode::from(Code::WrongInput as u8);
    }
    let cli = match Cli::try_parse_from(words) {
        Ok(cli) => cli,
        Err(error) => {
            screen::complain_of_line(&error);
            // Help and version were requested; everything else is wrong input.
            return match error.kind() {
                ErrorKind::DisplayHelp | ErrorKind::DisplayVersion => ExitCode::SUCCESS,
                _ => ExitCode::from(Code::WrongInput as u8),
            };
        }
    };
    progress::catch_interrupts(journal::remove_temporary);
    match run(cli.command) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            screen::complain(&failure);
            ExitCode::from(failure.code as u8)
        }
    }
}

fn run(command: Command) -> Answer<()> {
    match command {
        Command::Demo(args) => demo::run(&args),
        Command::Compensate(args) => compensate::run(*args),
        Command::Deflect(args) => deflect::run(*args),
        Command::Stiffness(args) => stiffness::run(&args),
        Command::Map(args) => map::run(&args),
        Command::Assemble(args) => assemble::run(&args),
        Command::Curve(args) => curve::run(&args),
        Command::Equilibria(args) => equilibria::run(&args),
        Command::Force(args) => force::run(&args),
        Command::Engagement(args) => engagement::run(&args),
        Command::Expand(args) => expand::run(&args),
        Command::Convert(args) => convert::run(&args),
        Command::Dialect(args) => dialect::run(&args),
        Command::Check(args) => check::run(&args),
        Command::Import(args) => import::run(&args),
        Command::Reproduce(args) => reproduce::run(&args),
        Command::Model(args) => model::run(&args),
        Command::Completions(args) => shell::completions(&args, Cli::command()),
        Command::Man(args) => shell::man(&args, Cli::command()),
    }
}
