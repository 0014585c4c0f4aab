//! M29: the taps that follow are tied to the spindle (Fanuc).

use crate::text::lex::{Spanned, Token, tokens_of};

/// M29 in force.
#[derive(Debug)]
pub(crate) struct Rigid {
    /// M29 with its S: no motion may stand between it and the tap.
    pub text: String,
    /// True if a tap has written it.
    pub is_written: bool,
}

impl Rigid {
    /// M29 and S of a block, and the rest of it; `None` where it has no M29.
    pub fn of(text: &[u8]) -> Option<(Self, Vec<u8>)> {
        let mut tokens: Vec<Spanned> = Vec::new();
        tokens_of(text, &mut tokens);
        let [mut speed, mut rest] = [Vec::new(), Vec::new()];
        let (mut is_there, mut mark) = (false, "");
        for one in &tokens {
            let piece = &text[one.span.clone()];
            match one.token {
                Token::Word {
                    letter: b'M',
                    value: 29.0,
                    ..
                } => is_there = true,
                // The block may be skipped.
                Token::Other(b'/') => mark = "/",
                Token::Word { letter: b'S', .. } => speed.extend([b" ", piece].concat()),
                _ => rest.extend_from_slice(piece),
            }
        }
        let text = format!("{mark}M29{}", String::from_utf8_lossy(&speed));
        let is_written = false;
        is_there.then_some((Self { text, is_written }, rest))
    }
}
