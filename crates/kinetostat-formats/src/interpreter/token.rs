//! Tokens of a file and their places.

use std::ops::Range;

use winnow::ascii::{digit0, digit1};
use winnow::combinator::{alt, opt};
use winnow::error::EmptyError;
use winnow::prelude::*;
use winnow::stream::LocatingSlice;
use winnow::token::one_of;

use crate::text::Name;
use crate::text::source::SourceFile;

/// Kinds of tokens.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// An identifier or a keyword.
    Word,
    /// Digits with point and exponent, without sign.
    Number,
    /// Digits of base 2 or 16: `'B0110'`, `'H1F'`.
    Bits,
    /// `"..."`.
    Text,
    /// `"...` that its line does not close.
    OpenText,
    /// `:=`.
    Assign,
    /// Any other byte.
    Symbol(u8),
}

/// A token and its bytes in the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Token {
    pub kind: Kind,
    start: u32,
    end: u32,
}

impl Token {
    /// A token at these bytes of a file that is shorter than 4 GiB.
    pub(crate) fn new(kind: Kind, bytes: &Range<usize>) -> Self {
        Self {
            kind,
            start: bytes.start as u32,
            end: bytes.end as u32,
        }
    }

    /// Byte range in the file.
    pub(crate) fn bytes(&self) -> Range<usize> {
        self.start as usize..self.end as usize
    }
}

/// Places of the words among tokens.
pub(crate) fn words_of(tokens: &[Token]) -> Vec<Range<usize>> {
    let words = tokens.iter().filter(|token| token.kind == Kind::Word);
    words.map(Token::bytes).collect()
}

/// A line of a language in which a statement is a line.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Line {
    pub tokens: Range<usize>,
    /// Bytes of the comment that ends it.
    pub comment: Option<Range<usize>>,
}

/// A file and its tokens.
pub(crate) struct TokenFile<'a> {
    pub index: usize,
    pub source: &'a SourceFile,
    pub tokens: Vec<Token>,
    /// Lines with tokens; empty for languages whose statements end with a mark.
    pub lines: Vec<Line>,
}

impl TokenFile<'_> {
    /// The bytes of a token; none behind the last.
    pub(crate) fn word(&self, at: usize) -> &[u8] {
        let token = self.tokens.get(at);
        token.map_or(&[], |token| self.source.part(&token.bytes()))
    }

    /// The identifier that a token is.
    pub(crate) fn name(&self, at: usize) -> Option<Name> {
        let is_word = self.tokens.get(at)?.kind == Kind::Word;
        is_word.then(|| Name::of(self.word(at)))?
    }

    /// The number of digits of base 2 or 16.
    pub(crate) fn bits(&self, at: usize) -> Option<f64> {
        let text = std::str::from_utf8(self.word(at)).ok()?;
        let base = match text.as_bytes().get(1)? {
            b'B' | b'b' => 2,
            _ => 16,
        };
        let digits = text.get(2..text.len() - 1)?;
        u32::from_str_radix(digits, base).ok().map(f64::from)
    }

    /// The parts between the commas that stand in no bracket.
    pub(crate) fn split(&self, tokens: &Range<usize>) -> impl Iterator<Item = Range<usize>> + '_ {
        let (mut start, upto) = (tokens.start, tokens.end);
        std::iter::from_fn(move || {
            let end = match start < upto {
                true => self.find(start..upto, b',').unwrap_or(upto),
                false => return None,
            };
            let part = start..end;
            start = end + 1;
            Some(part)
        })
    }

    /// The place of a range of tokens in the file.
    pub(crate) fn span(&self, tokens: &Range<usize>) -> Range<usize> {
        let place = |at: usize| self.tokens.get(at).map(Token::bytes);
        let first = place(tokens.start).or_else(|| self.tokens.last().map(Token::bytes));
        let start = first.map_or(0, |place| place.start);
        let last = tokens.end.checked_sub(1).and_then(place);
        start..last.map_or(start, |place| place.end).max(start)
    }

    /// Tokens as they are written.
    pub(crate) fn text(&self, tokens: &Range<usize>) -> String {
        String::from_utf8_lossy(self.source.part(&self.span(tokens))).into_owned()
    }

    /// The tokens of the value behind the sign of an assignment, without a mark that ends the statement.
    pub(crate) fn value_behind(&self, assign: usize, tokens: &Range<usize>) -> Range<usize> {
        let is_ended = tokens.end > assign + 1 && self.is(tokens.end - 1, b';');
        assign + 1..tokens.end - usize::from(is_ended)
    }

    /// The line of a token, counted from 1.
    pub(crate) fn line_of(&self, at: usize) -> usize {
        self.source.line_of(self.span(&(at..at + 1)).start)
    }

    /// True if a token is this byte.
    pub(crate) fn is(&self, at: usize, symbol: u8) -> bool {
        let token = self.tokens.get(at);
        token.is_some_and(|token| token.kind == Kind::Symbol(symbol))
    }

    /// True for a name that is no part of another one, no option, and not that of a call or an element.
    pub(crate) fn is_alone(&self, at: usize) -> bool {
        let before = at.checked_sub(1);
        let is_part = before.is_some_and(|at| b".\\#".iter().any(|sign| self.is(at, *sign)));
        let next = self.tokens.get(at + 1).map(|token| token.kind);
        let opens = [b'.', b'(', b'['].map(Kind::Symbol);
        !is_part && next.is_none_or(|next| next != Kind::Assign && !opens.contains(&next))
    }

    /// True if a token is this word, given in capitals.
    pub(crate) fn is_word(&self, at: usize, capitals: &str) -> bool {
        let token = self.tokens.get(at);
        token.is_some_and(|token| token.kind == Kind::Word)
            && self.word(at).eq_ignore_ascii_case(capitals.as_bytes())
    }

    /// The first token of these that is this byte and stands in no bracket.
    pub(crate) fn find(&self, tokens: Range<usize>, symbol: u8) -> Option<usize> {
        let mut open = 0_usize;
        for at in tokens {
            match self.tokens.get(at)?.kind {
                Kind::Symbol(found) if found == symbol && open == 0 => return Some(at),
                Kind::Symbol(b'(' | b'[' | b'{') => open += 1,
                Kind::Symbol(b')' | b']' | b'}') => open = open.saturating_sub(1),
                _ => {}
            }
        }
        None
    }
}

/// A number without a sign, as RAPID and KRL write it.
#[inline]
pub(crate) fn number_literal(input: &mut LocatingSlice<&[u8]>) -> Result<(), EmptyError> {
    let mantissa = alt(((digit1, opt((b'.', digit0))).void(), (b'.', digit1).void()));
    let exponent = (one_of([b'e', b'E']), opt(one_of([b'+', b'-'])), digit1);
    (mantissa, opt(exponent)).void().parse_next(input)
}
