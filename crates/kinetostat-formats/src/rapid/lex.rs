//! Tokens of a file with their places; blanks, comments and the header `%%%` are none.
//!
//! The lexer never fails: a byte that begins nothing known is a token of its own, and the parser says what is wrong.

use winnow::ascii::{digit0, digit1};
use winnow::combinator::{alt, opt};
use winnow::prelude::*;
use winnow::stream::LocatingSlice;
use winnow::token::{any, one_of, take_till, take_while};

use crate::interpreter::token::{Kind, Token};
use crate::text::source::BYTE_ORDER_MARK;

type Input<'i> = LocatingSlice<&'i [u8]>;
type Nothing = winnow::error::EmptyError;

/// End-of-file byte of old editors.
const END_OF_FILE: u8 = 0x1a;

/// The tokens of a file shorter than 4 GiB.
pub(crate) fn tokens_of(bytes: &[u8]) -> Vec<Token> {
    let mut tokens = Vec::with_capacity(bytes.len() / 3);
    let mut input = LocatingSlice::new(bytes);
    // Byte order mark that editors write before UTF-8.
    let _: Result<_, Nothing> = opt(BYTE_ORDER_MARK).parse_next(&mut input);
    // `token` takes at least one byte and matches every byte, so the loop ends with the file.
    while let Ok((kind, span)) = token.with_span().parse_next(&mut input) {
        if let Some(kind) = kind {
            tokens.push(Token::new(kind, &span));
        }
    }
    tokens
}

/// A line of RAPID up to its comment.
pub(crate) fn code_of(line: &str) -> &str {
    let mut in_text = false;
    let begins = |(_, letter): &(usize, char)| {
        in_text ^= *letter == '"';
        !in_text && *letter == '!'
    };
    let at = line.char_indices().find(begins);
    &line[..at.map_or(line.len(), |(at, _)| at)]
}

/// `%%%`, version and language, `%%%`: controllers write it before a module.
fn header(input: &mut Input<'_>) -> Result<(), Nothing> {
    ("%%%", take_till(0.., b'%'), "%%%")
        .void()
        .parse_next(input)
}

/// Reads a token; `None` for blanks and comments.
fn token(input: &mut Input<'_>) -> Result<Option<Kind>, Nothing> {
    let first = *input.first().ok_or(winnow::error::EmptyError)?;
    match first {
        b' ' | b'\t' | b'\r' | b'\n' | 0x0b | 0x0c | END_OF_FILE => blank(input).map(|()| None),
        b'!' => take_till(0.., b'\n').value(None).parse_next(input),
        b'0'..=b'9' | b'.' => alt((number.value(Kind::Number), symbol))
            .map(Some)
            .parse_next(input),
        // Each module has its own header where the files of a program are read as one.
        b'%' => alt((header.value(None), symbol.map(Some))).parse_next(input),
        b'"' => text.map(Some).parse_next(input),
        b':' => alt((":=".value(Kind::Assign), symbol))
            .map(Some)
            .parse_next(input),
        byte if is_letter(byte) => take_while(1.., is_part)
            .value(Some(Kind::Word))
            .parse_next(input),
        _ => symbol.map(Some).parse_next(input),
    }
}

fn blank(input: &mut Input<'_>) -> Result<(), Nothing> {
    take_while(1.., |byte: u8| {
        byte.is_ascii_whitespace() || matches!(byte, 0x0b | END_OF_FILE)
    })
    .void()
    .parse_next(input)
}

fn symbol(input: &mut Input<'_>) -> Result<Kind, Nothing> {
    any.map(Kind::Symbol).parse_next(input)
}

/// Letters of Latin-1 and of UTF-8 count: controllers take the first, editors write the second.
fn is_letter(byte: u8) -> bool {
    byte.is_ascii_alphabetic() || byte == b'_' || byte >= 0x80
}

fn is_part(byte: u8) -> bool {
    is_letter(byte) || byte.is_ascii_digit()
}

fn number(input: &mut Input<'_>) -> Result<(), Nothing> {
    let mantissa = alt(((digit1, opt((b'.', digit0))).void(), (b'.', digit1).void()));
    let exponent = (one_of([b'e', b'E']), opt(one_of([b'+', b'-'])), digit1);
    (mantissa, opt(exponent)).void().parse_next(input)
}

/// A quote inside is written twice.
fn text(input: &mut Input<'_>) -> Result<Kind, Nothing> {
    any.void().parse_next(input)?;
    loop {
        take_till(0.., [b'"', b'\n']).void().parse_next(input)?;
        match opt(b'"').parse_next(input)? {
            None => return Ok(Kind::OpenText),
            Some(_) if opt(b'"').parse_next(input)?.is_none() => return Ok(Kind::Text),
            Some(_) => {}
        }
    }
}
