//! State of the walk over a program, and its error reports.

use std::collections::BTreeSet;
use std::ops::Range;

use crate::apt::places::Frames;
use crate::error::{ProgramError, note};
use crate::heidenhain::reading::found::Found;
use crate::heidenhain::reading::rounded::{Line, Pending};
use crate::heidenhain::state::State;
use crate::options::ReadOptions;
use crate::text::finding::Finding;
use crate::text::source::SourceFile;

/// The walk over one file.
pub(crate) struct Reader<'r> {
    pub found: &'r mut Found,
    pub options: &'r ReadOptions,
    pub frames: &'r Frames,
    /// All files of the program.
    pub files: &'r [SourceFile],
    pub file: &'r SourceFile,
    pub index: usize,
    pub unit_mm: f64,
    pub state: State,
    pub pole_from: Option<usize>,
    /// See [`crate::heidenhain::reading::found::PoleThere`].
    pub poles: [usize; 2],
    /// The file may hold rounded corners; the straight block just before; a corner that waits for its second line.
    pub has_corners: bool,
    pub line: Option<Line>,
    pub corner: Option<Pending>,
    /// Words that were remarked on.
    pub remarked: BTreeSet<String>,
}

/// Remedy of repeated or parametric blocks.
pub(crate) const EXPAND: &str = "write the program flat first (--expand)";

pub(crate) const TILTED: &str = "it tilts the plane in which the places are";

pub(crate) const TILTED_REMEDY: &str = "let the CAM system write the places in the axes of the part, with LN blocks (TX, TY, TZ) where the tool leans, or give each plane as a program of its own";

pub(crate) const BUILDERS: &str =
    "is the machine builder's: taken as one that does not move the tool";

pub(crate) const BY_PARAMETER: &str = "a Q parameter says its value";

impl Reader<'_> {
    pub(crate) fn fault(&mut self, span: &Range<usize>, reason: impl Into<String>, remedy: &str) {
        let file = self.file;
        note(&mut self.found.faults, || {
            ProgramError::at(file, span.clone(), reason, remedy)
        });
    }

    /// Remarks once on a word that is taken in some way.
    pub(crate) fn remark(&mut self, span: &Range<usize>, word: &str, taken: &str) {
        if self.remarked.insert(word.to_owned()) {
            self.finding(span, format!("{word} {taken}"));
        }
    }

    pub(crate) fn finding(&mut self, span: &Range<usize>, message: String) {
        self.found.findings.push(Finding {
            file: self.index,
            line: self.file.line_of(span.start),
            message,
        });
    }
}
