//! The words of an instruction.

use std::ops::Range;

use crate::ls::lines::number_of;

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Kind {
    /// Letters and `_`; digits behind them are a number of their own (`CNT100`).
    Letters,
    Number(f64),
    /// `[...]`, as a whole.
    Bracket,
    /// Any other byte.
    Symbol(u8),
}

/// A word and its bytes in the file.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Word {
    pub kind: Kind,
    pub span: Range<usize>,
}

/// The words of a part of a file.
pub(crate) fn words_of(bytes: &[u8], part: &Range<usize>) -> Vec<Word> {
    let mut words = Vec::with_capacity(12);
    let mut at = part.start;
    let mut begins_line = false;
    while at < part.end {
        let byte = bytes[at];
        let run = |from: usize, is: fn(&u8) -> bool| {
            let end = bytes[from..part.end].iter().position(|byte| !is(byte));
            end.map_or(part.end, |end| from + end)
        };
        let (kind, end) = match byte {
            b'\n' => {
                begins_line = true;
                at += 1;
                continue;
            }
            b' ' | b'\t' | b'\r' => {
                at += 1;
                continue;
            }
            // The colon with which a further line of an instruction begins.
            b':' if begins_line => {
                begins_line = false;
                at += 1;
                continue;
            }
            b'0'..=b'9' | b'.' => {
                let end = run(at, |byte| byte.is_ascii_digit() || *byte == b'.');
                match number_of(&bytes[at..end]) {
                    Some(value) => (Kind::Number(value), end),
                    None => (Kind::Symbol(byte), at + 1),
                }
            }
            b'[' => (Kind::Bracket, bracket_end(bytes, at, part.end)),
            byte if is_letter(&byte) => (Kind::Letters, run(at, is_letter)),
            _ => (Kind::Symbol(byte), at + 1),
        };
        begins_line = false;
        words.push(Word {
            kind,
            span: at..end,
        });
        at = end;
    }
    words
}

fn is_letter(byte: &u8) -> bool {
    byte.is_ascii_alphabetic() || matches!(byte, b'_' | b'$') || *byte >= 0x80
}

/// Position after the closing bracket that matches the one at a place.
fn bracket_end(bytes: &[u8], at: usize, end: usize) -> usize {
    let mut open = 0_usize;
    for (index, byte) in bytes[at..end].iter().enumerate() {
        match byte {
            b'[' => open += 1,
            b']' => open -= 1,
            _ => {}
        }
        if open == 0 {
            return at + index + 1;
        }
    }
    end
}

/// The number in `[12]` or `[12:name]`, and its bytes.
pub(crate) fn index_of(bytes: &[u8], bracket: &Range<usize>) -> Option<(u32, Range<usize>)> {
    let inside = bytes.get(bracket.start + 1..bracket.end.checked_sub(1)?)?;
    let blanks = inside.len() - inside.trim_ascii_start().len();
    let rest = &inside[blanks..];
    let digits = rest.iter().take_while(|byte| byte.is_ascii_digit()).count();
    let behind = rest[digits..].trim_ascii_start();
    if !matches!(behind.first(), None | Some(b':')) {
        return None;
    }
    let number: u32 = std::str::from_utf8(&rest[..digits]).ok()?.parse().ok()?;
    let start = bracket.start + 1 + blanks;
    Some((number, start..start + digits))
}
