//! Commands of the command line, run inside the interpreter.

use std::ffi::OsString;
use std::sync::Arc;

use clap::builder::ValueParser;
use kinetostat_machining::Watch;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use serde_json::{Value, json};

use crate::stiffness::json_of;
use crate::work::{Course, Manner, away};

/// The course of a call for a command, which keeps it.
struct Shared(Arc<Course>);

impl Watch for Shared {
    fn stage(&self, name: &str, total: usize) {
        self.0.stage(name, total);
    }
    fn advance(&self, done: usize) {
        self.0.advance(done);
    }
    fn cancelled(&self) -> bool {
        self.0.cancelled()
    }
}

/// Runs a command: exit code, standard output (bytes), standard error (text).
#[pyfunction]
#[pyo3(signature = (words, progress=None))]
pub fn run_command<'py>(
    py: Python<'py>,
    words: Vec<OsString>,
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<(u8, Bound<'py, PyBytes>, String)> {
    let manner = Manner {
        threads: None,
        progress,
    };
    let done = away(py, &manner, move |course| {
        kinetostat_cli::run_inside(words, Arc::new(Shared(course.clone())))
    })?;
    let err = String::from_utf8_lossy(&done.err).into_owned();
    Ok((done.code, PyBytes::new(py, &done.out), err))
}

/// Runs a command as a process does, with the streams and signals of the process; gives its exit code.
#[pyfunction]
pub fn run_as_process(py: Python<'_>, words: Vec<OsString>) -> u8 {
    py.detach(|| kinetostat_cli::run_as_process(words.into_iter()))
}

/// All commands with their options, as JSON.
#[pyfunction]
pub fn command_tree() -> PyResult<String> {
    let mut root = kinetostat_cli::command();
    root.build();
    json_of(&described(&root))
}

fn described(command: &clap::Command) -> Value {
    let arguments: Vec<Value> = (command.get_arguments())
        .filter(|a| !matches!(a.get_id().as_str(), "help" | "version"))
        .map(argument)
        .collect();
    let commands: Vec<Value> = (command.get_subcommands())
        .filter(|c| c.get_name() != "help")
        .map(described)
        .collect();
    json!({
        "name": command.get_name(),
        "about": command.get_about().map(ToString::to_string),
        "long_about": command.get_long_about().map(ToString::to_string),
        "arguments": arguments,
        "commands": commands,
    })
}

fn argument(argument: &clap::Arg) -> Value {
    let count = argument.get_num_args().unwrap_or_default();
    let names = argument.get_value_names().unwrap_or_default();
    let values: Vec<String> = (argument.get_possible_values().iter())
        .map(|value| value.get_name().to_owned())
        .collect();
    let parser = argument.get_value_parser().type_id();
    let number = ValueParser::from(|text: &str| text.parse::<f64>()).type_id();
    let whole = ValueParser::from(|text: &str| text.parse::<usize>()).type_id();
    let kind = match parser {
        parser if parser == ValueParser::path_buf().type_id() => "path",
        parser if parser == number => "float",
        parser if parser == whole => "int",
        _ => "str",
    };
    json!({
        "name": argument.get_long().unwrap_or_else(|| argument.get_id().as_str()),
        "positional": argument.is_positional(),
        "required": argument.is_required_set(),
        "hidden": argument.is_hide_set(),
        "takes_values": argument.get_action().takes_values(),
        "repeats": matches!(argument.get_action(), clap::ArgAction::Append),
        "fewest": count.min_values(),
        "most": count.max_values(),
        "value_names": names.iter().map(|n| n.as_str()).collect::<Vec<_>>(),
        "values": values,
        "type": kind,
        "help": argument.get_help().map(ToString::to_string),
    })
}
