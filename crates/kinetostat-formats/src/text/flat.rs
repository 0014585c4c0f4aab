//! A program run once and written flat, with where each of its lines is from.

use crate::text::finding::Finding;
use crate::text::source::SourceFile;

/// A program that was run once and written flat.
///
/// ```
/// use kinetostat_formats::{ReadOptions, SourceFile, expand_heidenhain};
///
/// let text = "BEGIN PGM A MM\nFN 0: Q1 = +5\nL X+Q1 F200\nEND PGM A MM\n";
/// let flat = expand_heidenhain(vec![SourceFile::new("a.h", text)], &ReadOptions::default()).unwrap();
/// assert_eq!(flat.file.bytes(), b"BEGIN PGM A MM\nL X+5 F200\nEND PGM A MM\n");
/// assert_eq!(flat.origins, [(0, 1), (0, 3), (0, 4)]);
/// assert!(flat.changed);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct FlatText {
    /// The flat program, under the name of the first file.
    pub file: SourceFile,
    /// For every line of it: the file (an index of those given) and its line, counted from 1.
    pub origins: Vec<(usize, usize)>,
    /// True if the program was expanded; otherwise the bytes are those of the first file.
    pub changed: bool,
    /// Assumptions on uncertain source text, by file and line of the program as given.
    pub findings: Vec<Finding>,
}

impl FlatText {
    /// A file, by its index, in which nothing is to be flattened.
    pub(crate) fn unchanged(file: &SourceFile, index: usize) -> Self {
        let count = file.bytes().split_inclusive(|byte| *byte == b'\n').count();
        Self {
            file: file.clone(),
            origins: (1..=count).map(|line| (index, line)).collect(),
            changed: false,
            findings: Vec::new(),
        }
    }
}
