//! Errors of the path of a program that was read, and of a corrected one.

use kinetostat_program::WriteError as PathWriteError;
use thiserror::Error;

use crate::model::motion::Motion;
use crate::model::program::RobotProgram;

/// Error that prevents a path from being made of a program that was read.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{file}, line {line}: {reason}; {remedy}")]
#[non_exhaustive]
pub struct PathError {
    /// Name of the file.
    pub file: String,
    /// Line of the motion, counted from 1.
    pub line: usize,
    /// Reason for the error.
    pub reason: String,
    /// Remedy for the user.
    pub remedy: String,
}

/// A fault of a motion.
pub(crate) fn fault_at(
    program: &RobotProgram,
    motion: &Motion,
    reason: String,
    remedy: &str,
) -> PathError {
    PathError {
        file: program.files[motion.file].name().to_owned(),
        line: motion.line,
        reason,
        remedy: remedy.to_owned(),
    }
}

/// A promise that a written program breaks.
pub(crate) fn broken(line: usize, output_line: usize, what: String) -> PathWriteError {
    PathWriteError::Verification {
        line,
        output_line,
        what,
    }
}
