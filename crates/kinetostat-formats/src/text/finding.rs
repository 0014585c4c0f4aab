//! Findings on a program.

/// Something that a person should know of a program that was taken.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Finding {
    /// An index of [`RobotProgram::files`](crate::RobotProgram::files).
    pub file: usize,
    /// Line of the file, counted from 1.
    pub line: usize,
    /// Text of the finding.
    pub message: String,
}
