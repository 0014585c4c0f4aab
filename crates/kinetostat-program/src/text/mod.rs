//! A program as text: bytes, lines, tokens, words.
//!
//! Takes bytes; gives lines and words with their places, or refuses what cannot be followed at all. Knows no meaning of a
//! word.

pub(crate) mod lex;
pub(crate) mod library;
pub(crate) mod program;
pub(crate) mod syntax;

use std::ops::Range;

/// Kind of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum LineKind {
    /// A block of words, or nothing but comments and blanks.
    Words,
    /// A tape mark `%`.
    Tape,
    /// A vendor's M command with arguments of its own; only its N and M words are kept as words.
    Vendor,
    /// Text after the closing tape mark, which no controller runs.
    AfterEnd,
}

#[derive(Debug, Clone)]
pub(crate) struct Line {
    /// First byte, after a byte order mark if there is one.
    pub(crate) start: u32,
    /// End without the line ending.
    pub(crate) end: u32,
    /// End with the line ending.
    pub(crate) next: u32,
    pub(crate) words: Range<u32>,
    pub(crate) kind: LineKind,
    pub(crate) block_delete: bool,
}

/// A letter and its number.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Word {
    /// Upper case.
    pub letter: u8,
    /// First byte of the letter in the file.
    pub start: u32,
    /// First byte of the number in the file.
    pub number: u32,
    /// End of the number in the file.
    pub end: u32,
    pub value: f64,
}

impl Word {
    pub(crate) fn span(&self) -> Range<usize> {
        self.start as usize..self.end as usize
    }

    /// The number of a code in tenths.
    pub(crate) fn tenths(&self) -> u32 {
        tenths(self.value)
    }
}

/// The number of a code in tenths: M5 is 50. Codes that were read have no finer digits.
pub(crate) fn tenths(value: f64) -> u32 {
    (value * 10.0).round() as u32
}

/// Bytes of the first line without its line ending, and that ending: empty at the end of a file that has none there.
pub(crate) fn first_line(rest: &[u8]) -> (usize, &[u8]) {
    let length = memchr::memchr2(b'\n', b'\r', rest);
    let length = length.unwrap_or(rest.len());
    let ending = match &rest[length..] {
        [b'\r', b'\n', ..] => &rest[length..length + 2],
        [] => &[],
        _ => &rest[length..=length],
    };
    (length, ending)
}
