//! Blocks with M70, M71, M72 or M73, and the ends of subprograms that put modes back.

use crate::error::ProgramError;
use crate::expanding::run::Runner;
use crate::expanding::run::modal::{Context, Saved};
use crate::text::lex::{Spanned, Token, tokens_of};
use crate::text::tenths;

/// Remedy for modes that cannot be put back.
const REMEDY: &str = "name it before M70 or M73, or write the modes as words and leave out M72";

/// Functions that LinuxCNC runs before M70 of their block.
const BEFORE: &[u32] = &[30, 40, 50, 60, 190, 610, 620, 630, 640, 650, 660, 670, 680];

/// A block with one of M70 to M73: what runs before it, which it is, what runs behind it.
pub(crate) struct SavingBlock {
    pub before: Vec<u8>,
    pub code: u32,
    pub after: Vec<u8>,
}

impl SavingBlock {
    /// Divides a block; `None` if no such code is in it.
    pub fn of(text: &[u8]) -> Option<Self> {
        if !text.contains(&b'7') {
            return None;
        }
        let mut tokens: Vec<Spanned> = Vec::new();
        tokens_of(text, &mut tokens);
        let (mut before, mut after, mut code) = (Vec::new(), Vec::new(), None);
        for spanned in &tokens {
            let piece = &text[spanned.span.clone()];
            let Token::Word { letter, value, .. } = spanned.token else {
                after.extend_from_slice(piece);
                continue;
            };
            let tenths = tenths(value);
            match letter {
                b'M' if matches!(tenths, 700 | 710 | 720 | 730) => {
                    code = Some(code.map_or(tenths, |first: u32| first.max(tenths)));
                }
                b'N' => {}
                b'F' | b'S' | b'T' => before.extend_from_slice(piece),
                b'M' if BEFORE.contains(&tenths) => before.extend_from_slice(piece),
                _ => after.extend_from_slice(piece),
            }
        }
        let code = code?;
        Some(Self {
            before,
            code,
            after: after.trim_ascii().to_vec(),
        })
    }
}

impl Runner<'_> {
    /// M70 to M73.
    pub fn save_or_restore(&mut self, code: u32) -> Result<(), ProgramError> {
        self.refuse_in_compensation()?;
        match code {
            710 => self.frame_mut().context = None,
            720 => match self.frame().context.clone() {
                Some(context) => self.restore(&context.saved)?,
                None => {
                    return Err(self.refuse(
                        "M72 puts back modes that no M70 or M73 of this subprogram has saved",
                        "write M70 before it, in the same subprogram",
                    ));
                }
            },
            code => {
                let state = self.state();
                let saved = Saved::of(state, self.functions);
                let at_return = code == 730;
                // M73 of a subprogram holds on when M70 saves once more.
                let before = self.frame().context.as_ref();
                let at_return = at_return || before.is_some_and(|before| before.at_return);
                self.frame_mut().context = Some(Context { saved, at_return });
            }
        }
        Ok(())
    }

    /// The end of a subprogram, before its frame is closed.
    pub fn restore_at_return(&mut self) -> Result<(), ProgramError> {
        match self.frame_mut().context.take() {
            Some(context) if context.at_return => {
                self.refuse_in_compensation()?;
                self.restore(&context.saved)
            }
            _ => Ok(()),
        }
    }

    fn refuse_in_compensation(&self) -> Result<(), ProgramError> {
        match self.radius.hides_the_place() {
            true => Err(self.refuse(
                "modes are saved or put back (M70 to M73) while cutter radius compensation is on",
                "write it before G41 and G42, or behind G40 and the move after it",
            )),
            false => Ok(()),
        }
    }

    fn restore(&mut self, saved: &Saved) -> Result<(), ProgramError> {
        let now = self.state_to_save();
        let units = saved.units_word(&now);
        if let Some(word) = units.map_err(|reason| self.refuse(reason, REMEDY))? {
            self.add(word.as_bytes())?;
        }
        let now = self.state_to_save();
        let blocks = saved.blocks(&now);
        for block in blocks.map_err(|reason| self.refuse(reason, REMEDY))? {
            self.add(block.as_bytes())?;
        }
        self.no_feed |= saved.takes_the_feed_away(&now);
        Ok(())
    }

    fn state_to_save(&self) -> Saved {
        Saved::of(self.state(), self.functions)
    }
}
