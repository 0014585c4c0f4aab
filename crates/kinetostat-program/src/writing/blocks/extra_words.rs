//! Words of axes other than X, Y and Z: each piece gets its share.

use crate::error::WriteError;
use crate::number;
use crate::path::moves::{ExtraAxis, ExtraMode, Move};
use crate::writing::blocks::block_text::{BlockText, number_span};
use crate::writing::output_state::OutputMove;
use crate::writing::rotary_words::{EXTRA_DECIMALS, TurnedAxes};

/// Shares out the words of a block.
pub(crate) struct ExtraWords<'a> {
    pub text: BlockText<'a>,
    pub motion: &'a Move,
}

impl ExtraWords<'_> {
    /// The words of a piece of a divided block, but for those of rotary axes whose angles are corrected.
    pub fn shares(
        &self,
        turned: &TurnedAxes<'_>,
        (steps, index): (&[OutputMove], usize),
    ) -> Result<Vec<(u8, String)>, WriteError> {
        let mut words = Vec::new();
        for extra in &self.motion.extra {
            // Also the words that are not written tell whether they can be shared out.
            let number = self.share(extra, &steps[index])?;
            if !turned.has_word(extra.letter, steps) {
                words.push((extra.letter as u8, number));
            }
        }
        Ok(words)
    }

    /// The share of a word in a piece.
    fn share(&self, extra: &ExtraAxis, step: &OutputMove) -> Result<String, WriteError> {
        let refuse = |reason: &str| WriteError::ExtraAxis {
            line: self.motion.line,
            letter: extra.letter,
            reason: reason.to_owned(),
        };
        let original = self.text.word(extra.letter as u8).map_or(&b""[..], |word| {
            &self.text.program.bytes()[number_span(word)]
        });
        let decimals = number::decimals_of(original).clamp(EXTRA_DECIMALS, 9);
        Ok(match (extra.mode, extra.start) {
            (ExtraMode::Disputed, _) => {
                return Err(refuse(
                    "M82/M83 and the later G90/G91 disagree whether it is absolute, and so do firmwares; write M82 or M83 again after G90 or G91",
                ));
            }
            (ExtraMode::Absolute, None) => {
                return Err(refuse(
                    "the program has not stated where the axis is before; write a block with its place, or G92, before",
                ));
            }
            (ExtraMode::Absolute, Some(_)) if step.share_to >= 1.0 => {
                String::from_utf8_lossy(original).into_owned()
            }
            (ExtraMode::Absolute, Some(start)) => {
                number::fixed(start + (extra.word - start) * step.share_to, decimals)
            }
            (ExtraMode::Incremental, _) => {
                // Whole units of the last decimal, so that the pieces add up to the word.
                let unit = 10_f64.powi(decimals as i32);
                let reached = |share: f64| (extra.word * unit * share).round();
                let units = reached(step.share_to) - reached(step.share_from);
                number::fixed(units / unit, decimals)
            }
        })
    }
}
