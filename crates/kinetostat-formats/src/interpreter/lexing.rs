//! Tokens of a language in which a statement is a line, with their places; blanks and comments have no token; words that begin and end blocks.
//!
//! A line that ends outside brackets is a token: it ends the statement.

use std::ops::Range;

use crate::interpreter::token::{Kind, Token, TokenFile};
use crate::interpreter::tree::{Leave, RoutineKind};
use crate::text::source::beginning;

/// Marks of a language.
pub(crate) struct Marks {
    /// Byte before a comment that ends with its line.
    pub comment: u8,
    /// Byte before a line that does not belong to the program.
    pub aside: u8,
}

/// The tokens of a file shorter than 4 GiB.
pub(crate) fn tokens_of(marks: &Marks, bytes: &[u8]) -> Vec<Token> {
    let mut tokens: Vec<Token> = Vec::with_capacity(bytes.len() / 3);
    let mut at = beginning(bytes);
    let (mut open, mut begins_line) = (0_usize, true);
    while let Some(first) = bytes.get(at) {
        let rest = &bytes[at..];
        let run =
            |is_part: &dyn Fn(u8) -> bool| rest.iter().take_while(|byte| is_part(**byte)).count();
        let line = || run(&|byte| byte != b'\n');
        let (kind, length) = match first {
            b'\n' => ((open == 0).then_some(Kind::Symbol(b'\n')), 1),
            mark if *mark == marks.comment => (None, line()),
            mark if *mark == marks.aside && begins_line => (None, line()),
            byte if byte.is_ascii_whitespace() || *byte == 0x1a => (None, 1),
            b'0'..=b'9' | b'.' => match number(rest) {
                0 => (Some(Kind::Symbol(*first)), 1),
                length => (Some(Kind::Number), length),
            },
            b'"' => match rest[1..line()].iter().position(|byte| *byte == b'"') {
                Some(close) => (Some(Kind::Text), close + 2),
                None => (Some(Kind::OpenText), line()),
            },
            byte if is_part(*byte) => (Some(Kind::Word), run(&is_part)),
            b'=' => (Some(equals(&tokens, at, rest)), 1),
            byte => (Some(Kind::Symbol(*byte)), 1),
        };
        match first {
            b'(' | b'[' | b'{' => open += 1,
            b')' | b']' | b'}' => open = open.saturating_sub(1),
            _ => {}
        }
        begins_line = *first == b'\n' || begins_line && kind.is_none();
        if let Some(kind) = kind {
            tokens.push(Token::new(kind, &(at..at + length)));
        }
        at += length.max(1);
    }
    tokens
}

fn is_part(byte: u8) -> bool {
    byte.is_ascii_alphanumeric() || byte == b'_' || byte >= 0x80
}

/// The token of `=`: a part of `==`, `<=`, `>=` or `!=`, or an assignment.
pub(crate) fn equals(tokens: &[Token], at: usize, rest: &[u8]) -> Kind {
    let before = tokens.last().filter(|token| token.bytes().end == at);
    let compares =
        before.is_some_and(|token| matches!(token.kind, Kind::Symbol(b'=' | b'<' | b'>' | b'!')));
    match compares || rest.get(1) == Some(&b'=') {
        true => Kind::Symbol(b'='),
        false => Kind::Assign,
    }
}

/// Bytes of the number that begins here; 0 where none does.
pub(crate) fn number(text: &[u8]) -> usize {
    let digits = |from: usize| {
        text[from..]
            .iter()
            .take_while(|byte| byte.is_ascii_digit())
            .count()
    };
    let whole = digits(0);
    let fraction = match text.get(whole) {
        Some(b'.') => 1 + digits(whole + 1),
        _ => 0,
    };
    if whole + fraction < 2 && whole == 0 {
        return 0;
    }
    let mantissa = whole + fraction;
    let sign = usize::from(matches!(text.get(mantissa + 1), Some(b'+' | b'-')));
    match (text.get(mantissa), text.get(mantissa + 1 + sign)) {
        (Some(b'e' | b'E'), Some(b'0'..=b'9')) => mantissa + 1 + sign + digits(mantissa + 1 + sign),
        _ => mantissa,
    }
}

/// The words of a language.
pub(crate) struct Words {
    pub marks: Marks,
    /// Word before a routine, and its kind if it is not nested and has no parameters.
    pub routines: &'static [(&'static str, RoutineKind)],
    /// Words before the first condition of a branch, a further one, and the alternative.
    pub branch: [&'static str; 3],
    /// Word before a loop with its condition.
    pub repeat: &'static str,
    /// Word after each block.
    pub end: &'static str,
    /// Byte after a header.
    pub colon: u8,
    /// Words before a global name, and before one of its routine.
    pub scopes: [&'static str; 2],
    /// Words of return, loop exit, next pass, and program end.
    pub leaves: [&'static str; 4],
    /// Words before a statement that is neither a call nor an assignment.
    pub plain: &'static [&'static str],
    /// A statement that does nothing.
    pub nothing: &'static str,
}

impl Words {
    /// Effect of a statement that leaves its block.
    pub(crate) fn leave(&self, file: &TokenFile<'_>, tokens: &Range<usize>) -> Leave {
        let word = file.word(tokens.start);
        let value = tokens.start + 1..tokens.end;
        match self.leaves.iter().position(|own| word == own.as_bytes()) {
            Some(1) => Leave::Breaks,
            Some(2) => Leave::Continues,
            Some(3) => Leave::Ends,
            _ => Leave::Returns((!value.is_empty()).then_some(value)),
        }
    }
}
