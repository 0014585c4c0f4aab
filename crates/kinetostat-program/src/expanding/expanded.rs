//! A program that was run once and written flat.

use crate::path::moves::{Path, Warning};
use crate::text::program::Program;

/// Where a flat block came from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct Origin {
    /// Line of its file, counted from 1.
    pub line: usize,
    /// Index in [`Expanded::files`]: 0 is the program itself.
    pub file: usize,
}

/// A program that was run once and written flat.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Expanded {
    /// Plain blocks.
    pub program: Program,
    /// Where they go.
    pub path: Path,
    /// Of each line of the flat program, where it came from.
    pub origins: Vec<Origin>,
    /// What is to be known about blocks, by their lines in the flat program, beside the warnings of the path.
    pub warnings: Vec<Warning>,
    /// Names of the files that blocks came from; the first is the program and has none.
    pub files: Vec<String>,
}
