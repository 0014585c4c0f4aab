//! A program that was run once and written flat.

use crate::path::moves::{Path, Warning};
use crate::text::program::Program;

/// Source of a flat block.
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
    /// Path of the flat program.
    pub path: Path,
    /// Source of each line of the flat program.
    pub origins: Vec<Origin>,
    /// Warnings about blocks, by their lines in the flat program, in addition to the warnings of the path.
    pub warnings: Vec<Warning>,
    /// Names of the files that blocks came from; the first is the program and has none.
    pub files: Vec<String>,
}
