//! The blocks of a file: a line each, or several where `~` ends one; their numbers.

use std::ops::Range;

use crate::heidenhain::words::{Word, words_of};
use crate::text::source::beginning;

/// Reason for the refusal of a continuation line of a cycle.
pub(crate) const STRAY: &str =
    "the line before goes on here (`~`), and this is no parameter of its cycle";
/// Remedy of a stray continuation line.
pub(crate) const STRAY_REMEDY: &str = "take the `~` at the end of the line before away";

/// A block.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Block {
    /// From the beginning of its first line behind its last line end.
    pub lines: Range<usize>,
    pub number: Option<Range<usize>>,
    /// Text after the block number and the skip sign.
    pub text: Range<usize>,
    /// `/`: skipped where the machine's operator wants it.
    pub skipped: bool,
}

impl Block {
    /// Returns text on a continuation line of a cycle that is no parameter of it (`Q200=+2`).
    pub(crate) fn no_parameter(&self, bytes: &[u8]) -> Option<Range<usize>> {
        let mut at = self.text.start;
        while at < self.text.end {
            at = next_line(bytes, at);
            let line = at..next_line(bytes, at).min(self.text.end);
            let rest = bytes.get(line.clone())?;
            let blanks = rest.len() - rest.trim_ascii_start().len();
            let first = rest.get(blanks);
            if first.is_some_and(|byte| !matches!(byte, b'Q' | b'q' | b';' | b'*' | b'~')) {
                return Some(line.start + blanks..line.end);
            }
        }
        None
    }

    /// Words of the block; a comment has no words.
    pub(crate) fn words(&self, bytes: &[u8]) -> Vec<Word> {
        words_of(bytes, &self.text)
    }
}

/// The blocks of a file in their order, empty lines among them.
pub(crate) fn blocks_of(bytes: &[u8]) -> Vec<Block> {
    let mut blocks = Vec::with_capacity(bytes.len() / 24);
    let mut at = 0;
    while at < bytes.len() {
        let first = at;
        loop {
            let from = at;
            at = next_line(bytes, at);
            let goes_on = bytes[from..at].trim_ascii_end().ends_with(b"~");
            if !goes_on || at >= bytes.len() {
                break;
            }
        }
        blocks.push(block(bytes, first..at));
    }
    blocks
}

fn next_line(bytes: &[u8], at: usize) -> usize {
    let end = bytes[at..].iter().position(|byte| *byte == b'\n');
    end.map_or(bytes.len(), |end| at + end + 1)
}

fn block(bytes: &[u8], lines: Range<usize>) -> Block {
    let blanks = |from: usize| {
        let blanks = bytes[from..lines.end]
            .iter()
            .take_while(|byte| matches!(byte, b' ' | b'\t'));
        from + blanks.count()
    };
    let mark = match lines.start {
        0 => beginning(&bytes[lines.clone()]),
        _ => 0,
    };
    let mut at = blanks(lines.start + mark);
    let mut skipped = false;
    let mut number = None;
    // The sign stands before the number or behind it.
    for _ in 0..2 {
        if bytes.get(at) == Some(&b'/') {
            skipped = true;
            at = blanks(at + 1);
        }
        if number.is_some() {
            break;
        }
        let digits = bytes[at..lines.end]
            .iter()
            .take_while(|byte| byte.is_ascii_digit())
            .count();
        let behind = bytes.get(at + digits);
        if digits == 0 || behind.is_some_and(|byte| matches!(byte, b'.' | b',')) {
            break;
        }
        number = Some(at..at + digits);
        at = blanks(at + digits);
    }
    let text = at..at + bytes[at..lines.end].trim_ascii_end().len();
    Block {
        lines,
        number,
        text,
        skipped,
    }
}
