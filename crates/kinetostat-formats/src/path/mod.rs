//! The program of a robot as a path that is divided, solved and corrected like one in G-code.
//!
//! [`of_program`] makes the path of a program of the moves of its motions ([`maker`]) unless [`motion_faults`] finds some
//! that cannot stand in one, [`axis_turns`] says how the tool stands where the text states its axis alone, [`turned_by_correction`]
//! refuses corrections by which it would be lost, [`correctable`] writes corrections of the path as pieces of motions and reads them
//! again, and [`read_again`] with [`kept_lines`] checks what was read.

use kinetostat_program::WriteError as PathWriteError;
use thiserror::Error;

use crate::model::motion::Motion;
use crate::model::program::RobotProgram;

pub(crate) mod axis_angles;
pub(crate) mod axis_turns;
pub(crate) mod correctable;
pub(crate) mod header;
pub(crate) mod kept_lines;
pub(crate) mod maker;
pub(crate) mod motion_faults;
pub(crate) mod of_program;
pub(crate) mod path_warnings;
pub(crate) mod read_again;
pub(crate) mod tools;
pub(crate) mod turned_by_correction;

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
