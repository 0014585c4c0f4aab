//! Why a program that was read has no path of its own.

use thiserror::Error;

/// Why no path can be made of a program that was read.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{file}, line {line}: {reason}; {remedy}")]
#[non_exhaustive]
pub struct PathError {
    /// Name of the file.
    pub file: String,
    /// Line of the motion, counted from 1.
    pub line: usize,
    /// Why.
    pub reason: String,
    /// What the user can do about it.
    pub remedy: String,
}
