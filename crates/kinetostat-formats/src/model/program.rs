//! A program of any language.

use crate::model::motion::Motion;
use crate::model::site::Declaration;
use crate::text::source::SourceFile;

/// The languages that are read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Language {
    /// ABB RAPID.
    Rapid,
    /// KUKA KRL.
    Krl,
}

/// Something that a person should know of a program that was taken.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Finding {
    /// An index of [`RobotProgram::files`].
    pub file: usize,
    /// Line of the file, counted from 1.
    pub line: usize,
    /// What.
    pub message: String,
}

/// A program as it was read: its files byte for byte, and what moves in them.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct RobotProgram {
    /// What it is written in.
    pub language: Language,
    /// Its files in the order given.
    pub files: Vec<SourceFile>,
    /// Each motion statement once, in the order in which they first run; those that nothing calls at the end.
    pub motions: Vec<Motion>,
    /// In order of files and lines.
    pub findings: Vec<Finding>,
    pub(crate) declarations: Vec<Declaration>,
}
