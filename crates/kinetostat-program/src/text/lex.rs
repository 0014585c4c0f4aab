//! The tokens of one line: words, comments, blanks, and whatever else stands there.
//!
//! The lexer never fails: a byte that begins nothing known becomes [`Token::Other`], and
//! [`crate::text::program`] decides with the whole line in view whether that is a harmless vendor word or
//! a reason to refuse. Spans are byte ranges within the line, so that nothing is ever lost.

use std::ops::Range;

use winnow::ascii::{digit0, digit1};
use winnow::combinator::{alt, opt, peek};
use winnow::prelude::*;
use winnow::stream::LocatingSlice;
use winnow::token::{any, one_of, take, take_till, take_while};

use crate::text::tenths;

type Input<'i> = LocatingSlice<&'i [u8]>;

/// One token of a line.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Token {
    /// Spaces and tabs.
    Blank,
    /// `( ... )`, or `( ...` up to the end of the line when nothing closes it.
    Parenthesis { closed: bool },
    /// `; ...` up to the end of the line.
    Semicolon,
    /// `" ... "`, an argument of some vendors' commands.
    Quoted,
    /// A letter with its number.
    Word {
        letter: u8,
        number: Range<usize>,
        value: f64,
    },
    /// A letter that no number follows.
    Letter(u8),
    /// A byte that begins none of the above.
    Other(u8),
}

/// A token and the bytes of the line it covers.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Spanned {
    pub token: Token,
    pub span: Range<usize>,
}

impl Spanned {
    /// The number of a G word in tenths: G43.1 is 431. `None` for every other token.
    pub(crate) fn g_code(&self) -> Option<u32> {
        match self.token {
            Token::Word {
                letter: b'G',
                value,
                ..
            } => Some(tenths(value)),
            _ => None,
        }
    }
}

/// Appends the tokens of `line` (without its line ending) to `tokens`.
pub(crate) fn tokens_of(line: &[u8], tokens: &mut Vec<Spanned>) {
    let mut input = LocatingSlice::new(line);
    // `token` takes at least one byte and matches every byte, so the loop ends with the line.
    while let Ok((token, span)) = token.with_span().parse_next(&mut input) {
        tokens.push(Spanned { token, span });
    }
}

fn token(input: &mut Input<'_>) -> Result<Token, winnow::error::EmptyError> {
    alt((
        blank.value(Token::Blank),
        word,
        letter.map(|letter| Token::Letter(letter.to_ascii_uppercase())),
        comment,
        (b';', take_till(0.., |_: u8| false)).value(Token::Semicolon),
        (b'"', take_till(0.., b'"'), b'"').value(Token::Quoted),
        any.map(Token::Other),
    ))
    .parse_next(input)
}

/// `( ... )`; one with others in it goes on to its own end, where what stands between cannot be read as words.
fn comment(input: &mut Input<'_>) -> Result<Token, winnow::error::EmptyError> {
    (peek(b'('), take_while_comment)
        .map(|(_, text)| Token::Parenthesis {
            closed: text.last() == Some(&b')'),
        })
        .parse_next(input)
}

fn take_while_comment<'i>(input: &mut Input<'i>) -> Result<&'i [u8], winnow::error::EmptyError> {
    let length = comment_length(input);
    take(length).parse_next(input)
}

/// Bytes of a comment from its `(` on: up to the first `)`, or to the end of the line.
///
/// `(hole at (0, 69) )` ends where its brackets do: a control that ends it at the first `)` stops at the last one. Between the two there
/// must be no digit, variable or expression outside inner brackets, which such a control would run, but behind a word that none has.
pub(crate) fn comment_length(text: &[u8]) -> usize {
    let first = text.iter().position(|byte| *byte == b')');
    let Some(first) = first.map(|at| at + 1) else {
        return text.len();
    };
    let opened = text[..first].iter().filter(|byte| **byte == b'(').count();
    let mut depth = opened - 1;
    let is_said = begins_with_a_word(&text[first..]);
    for (at, byte) in text.iter().enumerate().skip(first) {
        match byte {
            _ if depth == 0 => return at,
            b'(' => depth += 1,
            b')' => depth -= 1,
            b'0'..=b'9' | b'#' | b'[' | b'<' | b'%' | b';' if depth == 1 && !is_said => {
                return first;
            }
            _ => {}
        }
    }
    match depth {
        0 => text.len(),
        _ => first,
    }
}

/// True for two letters and more that are no statement of a macro: every control stops there.
fn begins_with_a_word(text: &[u8]) -> bool {
    let text = text.trim_ascii_start();
    let letters = text.iter().take_while(|byte| byte.is_ascii_alphabetic());
    let word = text[..letters.count()].to_ascii_uppercase();
    const MACROS: [&[u8]; 8] = [
        b"IF", b"GOTO", b"WHILE", b"DO", b"END", b"THEN", b"DPRNT", b"BPRNT",
    ];
    word.len() > 1 && !MACROS.contains(&word.as_slice())
}

/// True if a comment of the line goes on behind its first `)`.
pub(crate) fn has_comment_within(line: &[u8]) -> bool {
    if line.iter().filter(|byte| **byte == b')').count() < 2 {
        return false;
    }
    let mut tokens: Vec<Spanned> = Vec::new();
    tokens_of(line, &mut tokens);
    tokens.iter().any(|one| {
        let closings = || line[one.span.clone()].iter().filter(|byte| **byte == b')');
        matches!(one.token, Token::Parenthesis { .. }) && closings().count() > 1
    })
}

fn blank<'i>(input: &mut Input<'i>) -> Result<&'i [u8], winnow::error::EmptyError> {
    take_while(1.., (b' ', b'\t')).parse_next(input)
}

fn letter(input: &mut Input<'_>) -> Result<u8, winnow::error::EmptyError> {
    one_of(|byte: u8| byte.is_ascii_alphabetic()).parse_next(input)
}

/// A letter and its number; blanks between the two are allowed, as controllers do.
fn word(input: &mut Input<'_>) -> Result<Token, winnow::error::EmptyError> {
    (letter, opt(blank), number.with_span())
        .map(|(letter, _, (value, number))| Token::Word {
            letter: letter.to_ascii_uppercase(),
            number,
            value,
        })
        .parse_next(input)
}

/// A fixed-point number: sign, digits, point; no exponent.
fn number(input: &mut Input<'_>) -> Result<f64, winnow::error::EmptyError> {
    (
        opt(one_of([b'+', b'-'])),
        alt(((digit1, opt((b'.', digit0))).void(), (b'.', digit1).void())),
    )
        .take()
        .verify_map(|digits: &[u8]| std::str::from_utf8(digits).ok()?.parse().ok())
        .parse_next(input)
}
