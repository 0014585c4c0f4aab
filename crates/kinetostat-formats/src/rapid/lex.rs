//! Tokens of a file with their places (blanks, comments and the header `%%%` are none), and their expressions.
//!
//! The lexer never fails: a byte that begins nothing known is a token of its own, and the parser says what is wrong.

use std::ops::Range;

use winnow::combinator::{alt, opt};
use winnow::prelude::*;
use winnow::stream::LocatingSlice;
use winnow::token::{any, take_till, take_while};

use crate::interpreter::expression::{Argument, Expression, Operator};
use crate::interpreter::reading::{self, Grammar};
use crate::interpreter::token::{Kind, Token, TokenFile, number_literal};
use crate::text::Name;
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
        b'0'..=b'9' | b'.' => alt((number_literal.value(Kind::Number), symbol))
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

/// Source: ABB, Technical reference manual - RAPID kernel, Priority between operators.
pub(super) const GRAMMAR: Grammar = Grammar {
    operators: &[
        ("OR", Operator::Or, 0),
        ("XOR", Operator::Xor, 0),
        ("AND", Operator::And, 1),
        ("<>", Operator::Unequal, 2),
        ("<=", Operator::LessOrEqual, 2),
        (">=", Operator::GreaterOrEqual, 2),
        ("<", Operator::Less, 2),
        (">", Operator::Greater, 2),
        ("=", Operator::Equal, 2),
        ("+", Operator::Plus, 3),
        ("-", Operator::Minus, 3),
        ("DIV", Operator::WholeQuotient, 4),
        ("MOD", Operator::Remainder, 4),
        ("*", Operator::Times, 4),
        ("/", Operator::Over, 4),
    ],
    not: 1,
    sign: 5,
    index: [b'{', b'}'],
    list: Some([b'[', b']']),
    has_members: false,
    names_arguments: false,
    counts_from_one: true,
    truths: ["FALSE", "TRUE"],
    aggregate: None,
    separates_comparisons: false,
};

/// The expression that tokens are.
pub(crate) fn expression_of(file: &TokenFile<'_>, tokens: Range<usize>) -> Expression {
    reading::expression_of(&GRAMMAR, file, tokens)
}

/// The arguments of a call between two tokens.
pub(crate) fn arguments_of(file: &TokenFile<'_>, tokens: Range<usize>) -> Vec<Argument> {
    reading::arguments_of(&GRAMMAR, file, tokens)
}

/// The arguments of one instruction.
pub(crate) struct Arguments {
    /// Arguments without a backslash.
    pub ordered: Vec<Expression>,
    /// Optional arguments, with a backslash.
    pub options: Vec<(Name, Option<Expression>)>,
}

impl Arguments {
    /// Arguments in the tokens after an instruction's name.
    pub(crate) fn of(file: &TokenFile<'_>, tokens: Range<usize>) -> Self {
        let mut all = Self {
            ordered: Vec::with_capacity(6),
            options: Vec::new(),
        };
        for Argument { option, value } in arguments_of(file, tokens) {
            match (option, value) {
                (Some(name), value) => all.options.push((name, value)),
                (None, Some(value)) => all.ordered.push(value),
                (None, None) => {}
            }
        }
        all
    }

    /// An option by its name in capitals; what it is given, if anything.
    pub(crate) fn option(&self, capitals: &str) -> Option<Option<&Expression>> {
        let found = self.options.iter().find(|(name, _)| name.is(capitals));
        found.map(|(_, value)| value.as_ref())
    }
}
