//! Blocks with M98 or M99: the call or the return, and the words beside it.
//!
//! Fanuc runs the words beside M98 and M99, and then calls or returns. LinuxCNC reads the block for its number alone.

use crate::error::ProgramError;
use crate::expanding::options::Dialect;
use crate::expanding::run::runner::Runner;
use crate::text::lex::{Spanned, Token, tokens_of};

/// Kind of the jump.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Jump {
    /// M98.
    Away,
    /// M99.
    Back,
}

/// A block with M98 or M99.
#[derive(Debug)]
pub(crate) struct CallBlock {
    pub jump: Jump,
    /// P.
    pub number: Option<f64>,
    /// L.
    pub times: Option<f64>,
    /// The block without them, its N word and / in front.
    pub rest: Vec<u8>,
    /// True if the rest has words with an effect.
    pub does_more: bool,
    /// A word that cannot stand here.
    unclear: Option<&'static str>,
}

impl CallBlock {
    /// Returns `None` if the block has neither code; M beside G65 is an argument.
    pub fn of(text: &[u8]) -> Option<Self> {
        if !text.contains(&b'9') {
            return None;
        }
        let mut tokens: Vec<Spanned> = Vec::new();
        tokens_of(text, &mut tokens);
        let has = |wanted: u8, number: f64| {
            tokens.iter().any(|one| {
                matches!(one.token, Token::Word { letter, value, .. } if letter == wanted && value == number)
            })
        };
        // The return goes before, as it does on the controllers.
        let jump = match (has(b'G', 65.0), has(b'M', 99.0), has(b'M', 98.0)) {
            (true, ..) | (false, false, false) => return None,
            (false, true, _) => Jump::Back,
            (false, false, true) => Jump::Away,
        };
        let mut block = Self {
            jump,
            number: None,
            times: None,
            rest: Vec::new(),
            does_more: false,
            unclear: None,
        };
        let mut codes = 0;
        for one in &tokens {
            match one.token {
                Token::Word {
                    letter: b'M',
                    value: 98.0 | 99.0,
                    ..
                } => {
                    codes += 1;
                    continue;
                }
                Token::Word {
                    letter: b'P',
                    value,
                    ..
                } if block.number.is_none() => {
                    block.number = Some(value);
                    continue;
                }
                Token::Word {
                    letter: b'L',
                    value,
                    ..
                } if block.times.is_none() => {
                    block.times = Some(value);
                    continue;
                }
                Token::Word {
                    letter: b'P' | b'L',
                    ..
                } => block.unclear = Some("P or L stands twice beside M98 or M99"),
                Token::Word {
                    letter: b'Q' | b'H',
                    ..
                } => {
                    block.unclear =
                        Some("Q or H beside M98 or M99 is a block to begin at to some controllers");
                    block.does_more = true;
                }
                Token::Word { letter: b'N', .. } => {}
                Token::Word { .. } | Token::Letter(_) => block.does_more = true,
                _ => {}
            }
            block.rest.extend_from_slice(&text[one.span.clone()]);
        }
        if codes > 1 {
            block.unclear = Some("M98 and M99 stand twice or together");
        }
        if jump == Jump::Back && block.times.is_some() {
            block.unclear =
                Some("L beside M99 sets how often the subprogram is run again on some controllers");
        }
        block.rest = block.rest.trim_ascii_end().to_vec();
        Some(block)
    }
}

impl Runner<'_> {
    /// Refuses words beside M98 and M99 whose meaning is not certain.
    pub fn check_beside_call(&self, block: &CallBlock) -> Result<(), ProgramError> {
        if let Some(what) = block.unclear {
            return Err(self.refuse(what, "write M98 or M99 into a block of its own"));
        }
        let remedy = match (block.does_more, self.options.dialect) {
            (false, _) | (true, Dialect::Fanuc) => return Ok(()),
            (true, Dialect::LinuxCnc) => "write them in a block of their own before it",
            (true, Dialect::Undecided) => {
                "write them in a block of their own before it, or name the dialect (--dialect fanuc)"
            }
        };
        Err(self.refuse(
            "words beside M98 or M99: Fanuc runs them first, LinuxCNC does not run them",
            remedy,
        ))
    }
}
