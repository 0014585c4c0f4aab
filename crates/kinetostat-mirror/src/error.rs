//! Errors of measured points, a path or a state.

use kinetostat_program::NoFeedMove;

/// Error and remedy, with file and line where there are any.
///
/// ```
/// use kinetostat_mirror::MeasuredPoints;
///
/// let error = MeasuredPoints::read("trial1.csv", "x,y,z\n1,2,3\n").unwrap_err();
/// assert!(error.to_string().starts_with("trial1.csv:1: column `x` states no unit"));
/// ```
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{}{message}", place(.file, .line))]
#[non_exhaustive]
pub struct MirrorError {
    /// File, where the fault stands in one.
    pub file: Option<String>,
    /// Line of the file, from 1.
    pub line: Option<usize>,
    /// Error and remedy.
    pub message: String,
}

impl MirrorError {
    pub(crate) fn new(message: impl Into<String>) -> Self {
        Self {
            file: None,
            line: None,
            message: message.into(),
        }
    }

    pub(crate) fn at(mut self, file: &str, line: usize) -> Self {
        self.file = Some(file.to_owned());
        self.line = Some(line);
        self
    }
}

fn place(file: &Option<String>, line: &Option<usize>) -> String {
    match (file, line) {
        (Some(file), Some(line)) => format!("{file}:{line}: "),
        (Some(file), None) => format!("{file}: "),
        _ => String::new(),
    }
}

impl From<NoFeedMove> for MirrorError {
    fn from(none: NoFeedMove) -> Self {
        Self::new(none.to_string())
    }
}
