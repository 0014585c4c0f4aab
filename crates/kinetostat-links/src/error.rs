//! Errors of a file: place, fault and remedy.

use std::fmt;

/// Result of this crate.
pub type Result<T> = std::result::Result<T, Error>;

/// Subject of an error.
///
/// ```
/// use kinetostat_links::{LinkErrorKind, identify};
/// use nalgebra::vector;
///
/// let error = identify("bar.csv", &[], &vector![0.3, 0.0, 0.0]).unwrap_err(); // m
/// assert_eq!(error.kind, LinkErrorKind::LoadCases);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum LinkErrorKind {
    /// A file that cannot be read, or a line of it that says nothing that belongs there.
    File,
    /// The interfaces of a link do not fit its matrix: nodes without a row, motions that nothing holds.
    Interface,
    /// Load cases of an experiment that do not determine a stiffness.
    LoadCases,
    /// Numbers of a section or of a beam that no beam has.
    Section,
}

/// A file, a line of it where one can be named, what is wrong there, and what to do about it.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub struct Error {
    /// Subject of the error.
    pub kind: LinkErrorKind,
    /// Name of the file, or of the request where no file is meant.
    pub file: String,
    /// Line, from 1; `None` where the whole file or request is meant.
    pub line: Option<usize>,
    /// Fault found.
    pub message: String,
    /// Remedy.
    pub help: String,
}

impl Error {
    /// An error of a whole file or request.
    pub fn new(
        kind: LinkErrorKind,
        file: impl Into<String>,
        message: impl Into<String>,
        help: impl Into<String>,
    ) -> Self {
        Self {
            kind,
            file: file.into(),
            line: None,
            message: message.into(),
            help: help.into(),
        }
    }

    /// Sets the line of the error, from 1.
    #[must_use]
    pub fn at(mut self, line: usize) -> Self {
        self.line = Some(line);
        self
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.file)?;
        if let Some(line) = self.line {
            write!(f, ", line {line}")?;
        }
        write!(f, ": {}; {}", self.message, self.help)
    }
}
