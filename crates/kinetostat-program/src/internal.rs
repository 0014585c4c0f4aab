//! Internals for this crate's own tests, in `tests/program/internal`. They are no part of the interface and may change
//! without notice.

use std::ops::Range;

use crate::text::lex::{Token, tokens_of};

pub use crate::number::{at_most, feed, fixed};
pub use crate::writing::departure::{Values, departure, parabola, polynomial, remainder};
pub use crate::writing::piece_account::least_percent;

/// The bytes of a token, and letter and number where it is a word.
pub type Stretch = (Range<usize>, Option<(char, f64)>);

/// The tokens of a line, given without its line ending, in their order.
#[must_use]
pub fn tokens(line: &[u8]) -> Vec<Stretch> {
    let mut tokens = Vec::new();
    tokens_of(line, &mut tokens);
    let tokens = tokens.into_iter().map(|token| {
        let word = match token.token {
            Token::Word { letter, value, .. } => Some((char::from(letter), value)),
            _ => None,
        };
        (token.span, word)
    });
    tokens.collect()
}
