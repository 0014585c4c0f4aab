//! The header of a corrected program, in the file's own comment style.

use crate::text::line::LineKind;
use crate::text::program::{COMPENSATED_MARK, HEADER_PREFIX, Program};

/// Bytes of the header: the mark, then the texts, wrapped to `max_line_bytes`.
pub(crate) fn header(program: &Program, texts: &[String], max_line_bytes: usize) -> Vec<u8> {
    let (open, close) = if program.uses_semicolons() {
        ("; ", "")
    } else {
        ("(", ")")
    };
    let room = max_line_bytes - open.len() - close.len();
    let mut bytes = Vec::new();
    let mut write = |text: &str| {
        bytes.extend_from_slice(open.as_bytes());
        bytes.extend_from_slice(text.as_bytes());
        bytes.extend_from_slice(close.as_bytes());
        bytes.extend_from_slice(program.usual_ending());
    };
    write(COMPENSATED_MARK);
    for text in texts.iter().flat_map(|text| text.lines()) {
        let plain = plain(text);
        let mut rest = plain.as_str();
        loop {
            let length = rest.len().min(room - HEADER_PREFIX.len());
            write(&format!("{HEADER_PREFIX}{}", &rest[..length]));
            rest = &rest[length..];
            if rest.is_empty() {
                break;
            }
        }
    }
    bytes
}

/// ASCII without anything that would end a comment.
fn plain(text: &str) -> String {
    text.chars()
        .map(|character| match character {
            '(' => '[',
            ')' => ']',
            ' '..='~' => character,
            _ => '?',
        })
        .collect()
}

/// Number of lines at the top that stay above the header: the tape mark and the program number. Zero for a program
/// that has nothing else.
pub(crate) fn lines_above(program: &Program) -> usize {
    let mut above = 0;
    for line in program.lines() {
        let words = program.words(line);
        let number = line.kind == LineKind::Words && words.len() == 1 && words[0].letter == b'O';
        if !(number || line.kind == LineKind::Tape && above == 0) {
            break;
        }
        above += 1;
    }
    if above < program.lines().len() {
        above
    } else {
        0
    }
}
