//! The kinetostat command: how far a machine bends along a program, and a program that cuts where
//! it should.
//!
//! One module per command (`demo`, `compensate`, `deflect`, `stiffness`, `map`, `curve`,
//! `equilibria`, `check`, `models`, `shell`);
//! `job` and `setting` turn files and options into a question, `along` runs it, `output` puts files
//! in place, `screen` prints, `failure` knows the exit codes.

mod along;
mod args;
mod assemble;
mod assemble_along;
mod assemble_answer;
mod assemble_args;
mod assemble_question;
mod assemble_table;
mod check;
mod check_assumptions;
mod check_frames;
mod check_home;
mod check_job;
mod check_limbs;
mod check_pose;
mod check_pose_file;
mod check_pose_fit;
mod check_reach;
mod check_reach_commands;
mod check_words;
mod compare;
mod compare_fit;
mod compensate;
mod compensate_map;
mod curve;
mod curve_answer;
mod curve_args;
mod curve_chain;
mod curve_csv;
mod curve_machine;
mod curve_plot;
mod curve_question;
mod curve_table;
mod curve_turns;
mod curve_work;
mod deflect;
mod demo;
mod diagnose;
mod draw;
mod equilibria;
mod equilibria_answer;
mod equilibria_machine;
mod equilibria_table;
mod failure;
mod faults;
mod free_machine;
mod import;
mod import_link;
mod import_link_args;
mod input;
mod job;
mod joints;
mod journal;
mod limit_options;
mod machine;
mod map;
mod map_answer;
mod map_args;
mod map_table;
mod models;
mod orientation;
mod origin;
mod output;
mod overcome;
mod place;
mod points_csv;
mod progress;
mod reproduce;
mod screen;
mod setting;
mod shell;
mod stiffness;
mod summary;

use std::process::ExitCode;

use clap::Parser;
use clap::error::ErrorKind;

use crate::args::{Cli, Command, no_number, plain_numbers};
use crate::failure::{Answer, Code};

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
            // Help and version were asked for; everything else is wrong input.
            return match error.kind() {
                ErrorKind::DisplayHelp | ErrorKind::DisplayVersion => ExitCode::SUCCESS,
                _ => ExitCode::from(Code::WrongInput as u8),
            };
        }
    };
    progress::catch_interrupts();
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
        Command::Check(args) => check::run(&args),
        Command::Import(args) => import::run(&args),
        Command::Reproduce(args) => reproduce::run(&args),
        Command::Model(args) => models::run(&args),
        Command::Completions(args) => shell::completions(&args),
        Command::Man(args) => shell::man(&args),
    }
}
