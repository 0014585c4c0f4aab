//! Tokens of program text between the marks of XML.

use std::ops::Range;

use crate::interpreter::lexing::{equals, number};
use crate::interpreter::token::{Kind, Token};

/// Bytes of entities and what they stand for, where the text is not in CDATA.
const ENTITIES: [(&[u8], u8); 5] = [
    (b"&lt;", b'<'),
    (b"&gt;", b'>'),
    (b"&amp;", b'&'),
    (b"&quot;", b'"'),
    (b"&apos;", b'\''),
];

/// Adds the tokens of program text; `is_escaped` where `<` and its kin stand as entities. A byte that begins nothing known is a token of
/// its own, and the parser says what is wrong.
pub(super) fn add_tokens(
    bytes: &[u8],
    span: &Range<usize>,
    is_escaped: bool,
    tokens: &mut Vec<Token>,
) {
    let mut at = span.start;
    while at < span.end {
        let rest = &bytes[at..span.end];
        let entity = ENTITIES
            .iter()
            .find(|(text, _)| is_escaped && rest.starts_with(text));
        let (first, width) = entity.map_or((rest[0], 1), |(text, byte)| (*byte, text.len()));
        let count = |is: fn(&u8) -> bool| rest.iter().take_while(|byte| is(byte)).count();
        let (kind, length) = match first {
            b' ' | b'\t' | b'\r' | b'\n' => {
                at += 1;
                continue;
            }
            b'/' if rest.starts_with(b"//") => {
                at += count(|byte| *byte != b'\n');
                continue;
            }
            b'"' => text(rest, &rest[..width]),
            b'0'..=b'9' => (Kind::Number, number(rest)),
            b'.' if rest.get(1).is_some_and(u8::is_ascii_digit) => (Kind::Number, number(rest)),
            _ if is_letter(first) => (Kind::Word, word(rest)),
            b'=' => (equals(tokens, at, rest), 1),
            byte => (Kind::Symbol(byte), width),
        };
        tokens.push(Token::new(kind, &(at..at + length)));
        at += length;
    }
}

fn is_letter(byte: u8) -> bool {
    byte.is_ascii_alphabetic() || byte == b'_' || byte >= 0x80
}

fn is_part(byte: &u8) -> bool {
    is_letter(*byte) || byte.is_ascii_digit()
}

/// An identifier; that of a library's program has a colon.
fn word(rest: &[u8]) -> usize {
    let mut end = 0;
    loop {
        end += rest[end..].iter().take_while(|byte| is_part(byte)).count();
        match rest.get(end..) {
            Some([b':', next, ..]) if is_letter(*next) => end += 1,
            _ => return end,
        }
    }
}

/// Reads a text up to its closing mark on the line.
fn text(rest: &[u8], mark: &[u8]) -> (Kind, usize) {
    let line = rest.iter().take_while(|byte| **byte != b'\n').count();
    let mut at = mark.len();
    while at < line {
        if rest[at..line].starts_with(mark) {
            return (Kind::Text, at + mark.len());
        }
        at += if rest[at] == b'\\' { 2 } else { 1 };
    }
    (Kind::OpenText, line)
}
