//! Text after the closing tape mark `%`: comments that no controller runs, or blocks that some do.
//!
//! A `%` ends a program for controllers that read to it (LinuxCNC, Fanuc), others pass over it. A block
//! behind it may therefore be run, and then it must be corrected like any other: it is refused.

use std::ops::Range;

use crate::text::lex::{Spanned, Token, tokens_of};

/// Letters whose words move an axis, and G.
const ACTING: &[u8] = b"GXYZABCUVWEIJKR";

/// M codes that call other blocks or go back to them.
const CALLS: [f64; 3] = [97.0, 98.0, 99.0];

/// The first word of a line after the end with which a controller that runs on would move or change how
/// it moves; none in a text for people, which does not begin with a word.
pub(crate) fn acting_word(line: &[u8], tokens: &mut Vec<Spanned>) -> Option<Range<usize>> {
    tokens.clear();
    tokens_of(line, tokens);
    let mut significant = tokens
        .iter()
        .filter(|spanned| {
            !matches!(
                spanned.token,
                Token::Blank | Token::Semicolon | Token::Parenthesis { .. }
            )
        })
        .skip_while(|spanned| spanned.token == Token::Other(b'/'))
        .peekable();
    if !matches!(significant.peek()?.token, Token::Word { .. }) {
        return None;
    }
    significant
        .find(|spanned| match spanned.token {
            Token::Word { letter, value, .. } => {
                ACTING.contains(&letter) || letter == b'M' && CALLS.contains(&value)
            }
            _ => false,
        })
        .map(|spanned| spanned.span.clone())
}
