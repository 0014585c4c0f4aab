//! Common data of the sections of a paper.

use crate::number::{self, Rounding};
use crate::paper::block::Block;
use crate::paper::language::Language;
use crate::paper::question::Paper;
use crate::paper::words::table::{Words, fill};
use crate::run::Shown;
use crate::text::clean;

/// Maximum number of warnings and features shown; more are in the result file.
pub(super) const MOST: usize = 100;

/// Common data of all sections.
pub(super) struct Of<'a> {
    pub(super) paper: &'a Paper<'a>,
    pub(super) result: &'a Shown<'a>,
    pub(super) words: &'static Words,
    pub(super) language: Language,
}

impl Of<'_> {
    /// A figure of the report in this language.
    pub(super) fn figure(&self, text: &str) -> String {
        self.language.figure(text, &self.words.figures)
    }

    /// A number with so many significant digits and its unit.
    pub(super) fn significant(&self, value: f64, digits: usize, unit: &str) -> String {
        let text = number::significant(value, digits, Rounding::Nearest);
        self.figure(&number::with_unit(&text, unit))
    }

    /// A largest length.
    pub(super) fn length(&self, mm: f64) -> String {
        let text = kinetostat_machining::number::largest_length(mm);
        self.figure(&number::typeset(&text))
    }

    /// Text of others, harmless; a word for its absence.
    pub(super) fn text(&self, text: &str) -> String {
        let text = clean(text);
        match text.trim().is_empty() {
            true => self.words.not_stated.to_owned(),
            false => text,
        }
    }

    /// True if there is a second program: written, or verified.
    pub(super) fn has_after(&self) -> bool {
        self.result.run_inputs.compensated || self.paper.verified.is_some()
    }
}

/// Note on the number of entries that are not shown.
pub(super) fn more(words: &str, all: usize) -> Option<Block> {
    let more = all.checked_sub(MOST).filter(|more| *more > 0)?;
    let count = number::count(more);
    Some(Block::Note(fill(words, &[("count", count.as_str())])))
}
