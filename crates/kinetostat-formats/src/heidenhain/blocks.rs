//! The blocks of a file: a line each, or several where `~` ends one; their numbers; the name and the unit in the first and the last one.

use std::ops::Range;

use crate::error::ProgramError;
use crate::heidenhain::words::{Word, words_of};
use crate::text::source::{Edits, SourceFile, beginning, next_line};

/// Reason for the refusal of a continuation line of a cycle.
pub(crate) const STRAY: &str =
    "the line before goes on here (`~`), and this is no parameter of its cycle";
/// Remedy of a stray continuation line.
pub(crate) const STRAY_REMEDY: &str = "take the `~` at the end of the line before away";

/// A block.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Block {
    /// Whole lines of the block, with the last line end.
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

// Block numbers: a control shows and loads blocks that are numbered one after another.

/// A program whose numbered blocks are numbered one after another from its first number. Blanks behind a number give way
/// where it becomes longer.
pub(crate) fn numbered_again(bytes: &[u8]) -> Option<Vec<u8>> {
    let mut edits = Edits::default();
    let mut last: Option<u64> = None;
    for block in blocks_of(bytes) {
        let Some(place) = block.number else {
            continue;
        };
        let digits = &bytes[place.clone()];
        let Ok(stated) = String::from_utf8_lossy(digits).parse::<u64>() else {
            continue;
        };
        let number = last.map_or(stated, |last| last.saturating_add(1));
        last = Some(number);
        if number == stated {
            continue;
        }
        let text = number.to_string();
        let blanks = bytes[place.end..block.lines.end]
            .iter()
            .take_while(|byte| **byte == b' ')
            .count();
        let longer = text.len().saturating_sub(digits.len());
        let taken = longer.min(blanks.saturating_sub(1));
        edits.replace(place.start..place.end + taken, text);
    }
    edits.applied_to(bytes)
}

/// True if the first block has a number: then all blocks have one.
pub(crate) fn is_numbered(bytes: &[u8]) -> bool {
    let mut blocks = blocks_of(bytes).into_iter();
    let begins = |words: &[Word]| words.first().is_some_and(|word| word.is("BEGIN"));
    blocks.any(|block| block.number.is_some() && begins(&block.words(bytes)))
}

/// Name and unit (MM or INCH) of BEGIN PGM and END PGM; empty if missing.
fn stated(file: &SourceFile, block: &Block) -> [String; 2] {
    let mut parts = file.part(&block.text).split(|byte| *byte == b';');
    let text = String::from_utf8_lossy(parts.next().unwrap_or_default()).to_uppercase();
    let mut words: Vec<&str> = text.split_whitespace().skip(2).collect();
    let unit = words.pop_if(|word| *word == "MM" || *word == "INCH");
    [words.join(" "), unit.unwrap_or_default().to_owned()]
}

/// An END PGM that is that of another program.
pub(crate) struct OtherEnd {
    pub fault: ProgramError,
    /// The unit differs, not only the name.
    pub has_other_unit: bool,
}

/// The END PGM of a program that states another name or unit than its BEGIN PGM, if it does.
///
/// The control writes both from one name and one unit: HEIDENHAIN, TNC 640, user's manual, Klartext programming, "Creating and
/// writing programs".
pub(crate) fn other_end(file: &SourceFile, blocks: &[Block], begin: usize) -> Option<OtherEnd> {
    let is_end = |block: &&Block| {
        let words = block.words(file.bytes());
        words.first().is_some_and(|word| word.is("END"))
    };
    let end = blocks.get(begin..)?.iter().find(is_end)?;
    let (first, last) = (stated(file, &blocks[begin]), stated(file, end));
    let differs = |part: &usize| {
        let both = [&first[*part], &last[*part]];
        first[*part] != last[*part] && both.iter().all(|text| !text.is_empty())
    };
    // The unit counts most.
    let part = [1, 0].into_iter().find(differs)?;
    let line = file.line_of(blocks[begin].text.start);
    let reason = format!(
        "the program ends as {} and begins as {} in line {line}",
        last[part], first[part]
    );
    let remedy =
        "give one whole program, with one name and one unit in its first and its last block";
    Some(OtherEnd {
        fault: ProgramError::at(file, end.text.clone(), reason, remedy),
        has_other_unit: part == 1,
    })
}
