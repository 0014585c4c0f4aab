//! Lines of a file, their tokens and the FOLDs around them. A statement is a line; comments, blanks and the header lines with `&` are none.
//!
//! The lexer never fails: a byte that begins nothing known is a token of its own, and the parser says what is wrong.

use std::ops::Range;

use winnow::combinator::alt;
use winnow::prelude::*;
use winnow::stream::LocatingSlice;
use winnow::token::{any, one_of, take_till, take_while};

use crate::interpreter::token::{Kind, Line, Token, TokenFile, number_literal};
use crate::model::motion::FrameUse;
use crate::text::source::{SourceFile, beginning};

type Input<'i> = LocatingSlice<&'i [u8]>;
type Nothing = winnow::error::EmptyError;

/// The tokens and lines of a file shorter than 4 GiB.
pub(crate) fn token_file(index: usize, source: &SourceFile) -> TokenFile<'_> {
    let bytes = source.bytes();
    let mut tokens = Vec::with_capacity(bytes.len() / 4);
    let mut lines = Vec::new();
    let mut start = beginning(bytes);
    while start < bytes.len() {
        let length = bytes[start..].iter().position(|byte| *byte == b'\n');
        let end = length.map_or(bytes.len(), |length| start + length);
        if bytes.get(start) != Some(&b'&') {
            let first = tokens.len();
            let comment = tokens_of(&bytes[start..end], start, &mut tokens);
            if tokens.len() > first || comment.as_ref().is_some_and(|at| folds(&bytes[at.clone()]))
            {
                lines.push(Line {
                    tokens: first..tokens.len(),
                    comment,
                });
            }
        }
        start = end + 1;
    }
    TokenFile {
        index,
        source,
        tokens,
        lines,
    }
}

/// Position of the assignment sign `=`: not `==`, `<=`, `>=`.
pub(crate) fn assignment(file: &TokenFile<'_>, tokens: &Range<usize>) -> Option<usize> {
    let at = file.find(tokens.clone(), b'=')?;
    let other = |at: usize| file.is(at, b'=') || file.is(at, b'<') || file.is(at, b'>');
    (at > tokens.start && !other(at - 1) && !(at + 1 < tokens.end && file.is(at + 1, b'=')))
        .then_some(at)
}

/// True if a comment is part of a fold: newer inline forms state their parameters in one.
fn folds(comment: &[u8]) -> bool {
    opens(comment) || closes(comment) || begins(comment, b"PARAMS")
}

fn begins(comment: &[u8], word: &[u8]) -> bool {
    let text = comment
        .strip_prefix(b";")
        .unwrap_or(comment)
        .trim_ascii_start();
    text.get(..word.len())
        .is_some_and(|first| first.eq_ignore_ascii_case(word))
}

/// True if a comment opens a fold.
pub(crate) fn opens(comment: &[u8]) -> bool {
    begins(comment, b"FOLD")
}

/// True if a comment closes a fold.
pub(crate) fn closes(comment: &[u8]) -> bool {
    begins(comment, b"ENDFOLD")
}

/// The tokens of a line, and its comment.
fn tokens_of(line: &[u8], start: usize, tokens: &mut Vec<Token>) -> Option<Range<usize>> {
    let mut input = LocatingSlice::new(line);
    // `token` takes at least one byte and matches every byte, so the loop ends with the line.
    while let Ok((kind, span)) = token.with_span().parse_next(&mut input) {
        let place = start + span.start..start + span.end;
        match kind {
            Some(Kind::Symbol(b';')) => {
                return Some(place.start..start + line.trim_ascii_end().len());
            }
            Some(kind) => tokens.push(Token::new(kind, &place)),
            None => {}
        }
    }
    None
}

/// Reads a token; `None` for blanks.
fn token(input: &mut Input<'_>) -> Result<Option<Kind>, Nothing> {
    let first = *input.first().ok_or(winnow::error::EmptyError)?;
    match first {
        b' ' | b'\t' | b'\r' | 0x0b | 0x0c | 0x1a => any.value(None).parse_next(input),
        b'0'..=b'9' | b'.' => alt((number_literal.value(Kind::Number), symbol))
            .map(Some)
            .parse_next(input),
        b'"' => alt((text.value(Kind::Text), symbol))
            .map(Some)
            .parse_next(input),
        b'\'' => alt((bits.value(Kind::Bits), symbol))
            .map(Some)
            .parse_next(input),
        byte if is_letter(byte) => take_while(1.., is_part)
            .value(Some(Kind::Word))
            .parse_next(input),
        _ => symbol.map(Some).parse_next(input),
    }
}

fn symbol(input: &mut Input<'_>) -> Result<Kind, Nothing> {
    any.map(Kind::Symbol).parse_next(input)
}

/// Letters of Latin-1 and of UTF-8 count: controllers take the first, editors write the second.
fn is_letter(byte: u8) -> bool {
    byte.is_ascii_alphabetic() || matches!(byte, b'_' | b'$') || byte >= 0x80
}

fn is_part(byte: u8) -> bool {
    is_letter(byte) || byte.is_ascii_digit()
}

fn text(input: &mut Input<'_>) -> Result<(), Nothing> {
    (b'"', take_till(0.., b'"'), b'"').void().parse_next(input)
}

fn bits(input: &mut Input<'_>) -> Result<(), Nothing> {
    let digits = take_while(1.., |byte: u8| byte.is_ascii_hexdigit());
    (b'\'', one_of([b'B', b'b', b'H', b'h']), digits, b'\'')
        .void()
        .parse_next(input)
}

// FOLDs: what the pendant shows of the statements in them. They are carried; nothing here trusts their text.

/// Opening line of the surrounding fold, for each line.
pub(crate) fn folds_of(file: &TokenFile<'_>) -> Vec<Option<usize>> {
    let mut open: Vec<usize> = Vec::new();
    let mut around = Vec::with_capacity(file.lines.len());
    for (index, line) in file.lines.iter().enumerate() {
        let comment = line.comment.as_ref().map(|span| file.source.part(span));
        if comment.is_some_and(closes) {
            open.pop();
        }
        around.push(open.last().copied());
        if comment.is_some_and(opens) {
            open.push(index);
        }
    }
    around
}

/// The number behind `Tool[` or `Base[` in the text of a fold.
fn shown(text: &str, array: &str) -> Option<u32> {
    let (_, rest) = text.split_once(array)?;
    rest.split(']').next()?.trim().parse().ok()
}

/// Contradiction between the text of a motion's fold and its statements.
pub(crate) fn contradiction(text: &[u8], tool: &FrameUse, base: &FrameUse) -> Option<String> {
    let text = String::from_utf8_lossy(text).to_uppercase();
    for (frame, array, in_force) in [(tool, "TOOL[", "TOOL_DATA["), (base, "BASE[", "BASE_DATA[")] {
        let in_force = shown(&frame.name, in_force);
        if let (Some(shown), Some(in_force)) = (shown(&text, array), in_force)
            && shown != in_force
        {
            let word = match array {
                "TOOL[" => "Tool",
                _ => "Base",
            };
            return Some(format!(
                "the text of the FOLD says {word}[{shown}], its statements set {}: the statements count",
                frame.name
            ));
        }
    }
    None
}

/// The comment of the line that opens a fold.
pub(crate) fn text_of<'f>(file: &'f TokenFile<'_>, line: usize) -> &'f [u8] {
    let span: Range<usize> = file.lines[line].comment.clone().unwrap_or(0..0);
    file.source.part(&span)
}

/// Limit of the lines of a file that are reported as unpaired folds.
const MOST_TOLD: usize = 100;

/// Lines (counted from 1) of folds that are not opened or not closed, and what is wrong with each: no controller minds, but the
/// pendant shows other folds than are meant.
pub(crate) fn not_paired(file: &TokenFile<'_>) -> Vec<(usize, &'static str)> {
    let mut open = Vec::new();
    let mut found = Vec::new();
    for line in &file.lines {
        let Some(span) = &line.comment else {
            continue;
        };
        let comment = file.source.part(span);
        if opens(comment) {
            open.push(span.start);
        } else if closes(comment) && open.pop().is_none() {
            found.push((span.start, "no FOLD is open that this ENDFOLD could close"));
        }
    }
    found.extend(open.into_iter().map(|at| (at, "this FOLD has no ENDFOLD")));
    found.sort_unstable();
    found.truncate(MOST_TOLD);
    let line_of = |(at, message)| (file.source.line_of(at), message);
    found.into_iter().map(line_of).collect()
}
