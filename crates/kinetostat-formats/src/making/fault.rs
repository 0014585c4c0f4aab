//! What is wrong with a program that is to be made, and what a person should know of one that was.

use thiserror::Error;

/// Why no program is made of a path: which line of the source, why, and what to do.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{}{reason}; {remedy}", place(*line))]
#[non_exhaustive]
pub struct MakeError {
    /// Line of the source, counted from 1; none where it is not about a line.
    pub line: Option<usize>,
    /// Why.
    pub reason: String,
    /// What the user can do about it.
    pub remedy: String,
    /// It is about what the template states, not about the program.
    pub is_of_template: bool,
}

fn place(line: Option<usize>) -> String {
    line.map_or_else(String::new, |line| format!("line {line}: "))
}

impl MakeError {
    pub(crate) fn at(line: usize, reason: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self {
            line: Some(line),
            ..Self::of(reason, remedy)
        }
    }

    pub(crate) fn of(reason: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self {
            line: None,
            reason: reason.into(),
            remedy: remedy.into(),
            is_of_template: false,
        }
    }

    pub(crate) fn of_template(reason: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self {
            is_of_template: true,
            ..Self::of(reason, remedy)
        }
    }
}

/// What is otherwise in a made program than in its source, or was taken for granted.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MakeFinding {
    /// First line of the source that it is about, counted from 1; none where it is about all of it.
    pub line: Option<usize>,
    /// What.
    pub message: String,
}

impl MakeFinding {
    pub(crate) fn of(line: impl Into<Option<usize>>, message: impl Into<String>) -> Self {
        Self {
            line: line.into(),
            message: message.into(),
        }
    }
}
