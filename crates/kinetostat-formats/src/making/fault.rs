//! Errors of making a program, and findings on a made one.

use thiserror::Error;

/// Error that prevents a program from being made of a path: line of the source, reason, remedy.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{}{reason}; {remedy}", place(*line))]
#[non_exhaustive]
pub struct MakeError {
    /// Line of the source, counted from 1; none where it is not about a line.
    pub line: Option<usize>,
    /// Reason for the error.
    pub reason: String,
    /// Remedy for the user.
    pub remedy: String,
    /// The error is in the template, not in the program.
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

/// Difference between a made program and its source, or an assumption.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MakeFinding {
    /// First line of the source that it is about, counted from 1; none where it is about all of it.
    pub line: Option<usize>,
    /// Text of the finding.
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
