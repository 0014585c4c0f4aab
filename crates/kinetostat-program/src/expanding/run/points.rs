//! Settings and switches of a Fanuc control: numbers without a decimal point, which are lengths (calculator-type input) or least
//! increments, and optional block skip with a slash and a number.

use crate::error::ProgramError;
use crate::expanding::options::Dialect;
use crate::expanding::run::runner::Runner;
use crate::expanding::translate::cycle::is_cycle;
use crate::text::lex::{Spanned, Token, tokens_of};

/// Letters of lengths and angles.
const LETTERS: &[u8] = b"XYZABCUVWIJKRQ";

const TEXT: &str = "numbers without a decimal point are read as they stand, X5 as 5 mm (calculator type); a Fanuc control that is set to count least increments takes it for 0.005 mm: give these numbers a point where the control may be set so";

impl Runner<'_> {
    /// `/2`: a switch of the machine of its own, which the flat program has no words for.
    pub fn note_skip_number(&mut self) -> Result<(), ProgramError> {
        let remedy = match self.options.dialect {
            Dialect::Fanuc => {
                let line = self.flat.blocks().max(1);
                self.flat.warn_of_lines(line, "blocks marked with / and a number, behind this line, are taken as run, and their marks are left out: the machine's switches have no effect on them (--block-delete skip leaves the blocks out)");
                return Ok(());
            }
            Dialect::LinuxCnc => "write / alone",
            Dialect::Undecided => "write / alone, or name the dialect (--dialect fanuc)",
        };
        Err(self.refuse(
            "a number behind / names a switch of Fanuc's controllers",
            remedy,
        ))
    }

    /// Counts a line of the program whose words rest on the setting of the control; `before` is the number of flat blocks before it.
    pub fn note_points(&mut self, text: &[u8], before: usize) {
        if self.options.dialect != Dialect::Fanuc || !self.lacks_a_point(text) {
            return;
        }
        let line = (before + 1).min(self.flat.blocks()).max(1);
        self.flat.warn_of_lines(line, TEXT);
    }

    fn lacks_a_point(&self, text: &[u8]) -> bool {
        let mut tokens: Vec<Spanned> = Vec::new();
        tokens_of(text, &mut tokens);
        let codes: Vec<u32> = tokens.iter().filter_map(Spanned::g_code).collect();
        // Arguments of macros are scaled by other rules, and K repeats cycles.
        let repeats = self.cycle.is_some() || codes.iter().copied().any(is_cycle);
        !codes.contains(&650)
            && tokens.iter().any(|one| match &one.token {
                Token::Word {
                    letter,
                    number,
                    value,
                } => {
                    let counts = LETTERS.contains(letter) && !(*letter == b'K' && repeats);
                    counts && *value != 0.0 && !text[number.clone()].contains(&b'.')
                }
                _ => false,
            })
    }
}
