//! G65: a subprogram with values of its own (Fanuc).
//!
//! The letters of its block are numbers there: A is #1, B #2, C #3, I J K #4 to #6, D to F #7 to #9, H #11, M #13, Q to Z #17 to
//! #26 (Fanuc, Operator's Manual B-63534EN, section 15.4, argument specification I). Letters that are not there are vacant.

use crate::error::ProgramError;
use crate::expanding::Dialect;
use crate::expanding::expression::Parameter;
use crate::expanding::run::Runner;
use crate::expanding::run::frame::{Frame, Locals, Opened};
use crate::text::lex::{Spanned, Token, tokens_of};

/// Maximum repeats of a call.
const MOST_REPEATS: f64 = 1e6;

/// The number that a letter is.
fn number_of(letter: u8) -> Option<u32> {
    Some(match letter {
        b'A'..=b'C' => u32::from(letter - b'A') + 1,
        b'I'..=b'K' => u32::from(letter - b'I') + 4,
        b'D'..=b'F' => u32::from(letter - b'D') + 7,
        b'H' => 11,
        b'M' => 13,
        b'Q'..=b'Z' => u32::from(letter - b'Q') + 17,
        _ => return None,
    })
}

impl Runner<'_> {
    /// A block with G65, G66 or G67; false where it is another.
    pub fn macro_call(&mut self, text: &[u8]) -> Result<bool, ProgramError> {
        if !text.contains(&b'6') {
            return Ok(false);
        }
        let mut tokens: Vec<Spanned> = Vec::new();
        tokens_of(text, &mut tokens);
        let words: Vec<(u8, f64)> = tokens
            .iter()
            .filter_map(|one| match one.token {
                Token::Word { letter, value, .. } => Some((letter, value)),
                _ => None,
            })
            .collect();
        if words.contains(&(b'G', 66.0)) {
            return Err(self.refuse(
                "G66 calls a subprogram behind every move that follows: it is not followed",
                "write G65 into each of these blocks",
            ));
        }
        if words.contains(&(b'G', 67.0))
            && words.iter().all(|(letter, _)| b"GN".contains(letter))
            && words.len() <= 2
        {
            // No G66 is in force.
            return Ok(true);
        }
        if !words.contains(&(b'G', 65.0)) {
            return Ok(false);
        }
        if self.options.dialect == Dialect::LinuxCnc {
            return Err(self.refuse(
                "LinuxCNC has no G65",
                "write an O word with call, or name the dialect (--dialect fanuc)",
            ));
        }
        let (mut arguments, mut called, mut times) = (Locals::new(Dialect::Fanuc), None, 1.0);
        for (letter, value) in words {
            match (letter, number_of(letter)) {
                (b'N', _) => {}
                (b'G', _) if value == 65.0 => {}
                (b'P', _) => called = Some(value),
                (b'L', _) => times = value,
                (letter, Some(number)) if arguments.is_vacant(number) => {
                    debug_assert!(letter.is_ascii_uppercase());
                    arguments.set(number, value);
                }
                (letter, Some(_)) => {
                    return Err(self.refuse(
                        &format!(
                            "{} comes twice beside G65: argument specification II counts I, J and K on",
                            char::from(letter)
                        ),
                        "give each letter once, or set the parameters before M98",
                    ));
                }
                (letter, None) => {
                    return Err(self.refuse(
                        &format!("{} is no argument of G65", char::from(letter)),
                        "write it in a block of its own",
                    ));
                }
            }
        }
        let Some(number) = called.filter(|p| p.fract() == 0.0 && (0.0..1e9).contains(p)) else {
            return Err(self.refuse(
                "G65 calls no subprogram",
                "write its number as P, as in G65 P9010",
            ));
        };
        if times.fract() != 0.0 || !(0.0..MOST_REPEATS).contains(&times) {
            return Err(self.refuse(
                "G65 is repeated a whole number of times (L), fewer than 1000000",
                "correct L",
            ));
        }
        if times >= 1.0 {
            let Some((file, line)) = self.find_or_keep(number as u32, text)? else {
                return Ok(true);
            };
            self.open(Frame {
                numbered: arguments,
                arguments: Some(arguments),
                ..Frame::new(file, line, Opened::Repeated(times as u32 - 1))
            })?;
        }
        Ok(true)
    }

    /// `#1 = #0`, or another one that has no value.
    pub fn vacate(&mut self, to: &Parameter) -> Result<(), ProgramError> {
        match self.number_of(to)? {
            Some(number) if self.frame().numbered.has(number) => {
                self.frame_mut().numbered.vacate(number);
                Ok(())
            }
            Some(number @ 34..=999) => {
                self.shared.numbered.remove(&number);
                Ok(())
            }
            _ => Err(self.refuse(
                "this parameter cannot be emptied",
                "use #1 to #33 or #100 to #999",
            )),
        }
    }
}
