//! A program that was run once and written flat.

use crate::text::source::SourceFile;

/// A program without jumps, loops and calls, and where its lines are from.
///
/// ```
/// use kinetostat_formats::{SourceFile, expand_siemens};
///
/// let text = "R1=0\nLOOP1:\nG1 X=R1 F100\nR1=R1+10\nIF R1<=20 GOTOB LOOP1\nM30\n";
/// let flat = expand_siemens(&[SourceFile::new("a.mpf", text)]).unwrap();
/// assert!(flat.changed);
/// assert_eq!(flat.file.bytes(), b"G1 X=0 F100\nG1 X=10 F100\nG1 X=20 F100\nM30\n");
/// assert_eq!(flat.origins[1], (0, 3)); // file and line of the second one
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct FlatText {
    /// The flat program, under the name of the one that was run.
    pub file: SourceFile,
    /// Of each line: the file, counted from 0, and the line there, counted from 1.
    pub origins: Vec<(usize, usize)>,
    /// Whether it is another text than before.
    pub changed: bool,
}
