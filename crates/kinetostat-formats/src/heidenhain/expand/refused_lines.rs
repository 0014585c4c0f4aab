//! The run goes on behind blocks that are refused, to find them all.

use crate::heidenhain::expand::run::{DEEPEST, Fault, Run};
use crate::refused_run::Behind;

impl Run<'_> {
    /// Notes a fault; whether the run goes on.
    pub(crate) fn refuse(&mut self, fault: Fault, behind: Behind) -> bool {
        let mut programs = self.programs.iter();
        let file = programs.position(|program| program.file.name() == fault.file);
        self.faults.add(file.unwrap_or(0), fault, behind)
    }

    /// What stands behind a block that is refused: the same as without it, unless it says what runs or what a parameter is.
    pub(crate) fn behind(&self, at: (usize, usize)) -> Behind {
        if self.is_endless || self.frames.len() >= DEEPEST {
            return Behind::Nothing;
        }
        let program = &self.programs[at.0];
        let words = program.blocks[at.1].words(program.file.bytes());
        let Some(first) = words.first() else {
            return Behind::Same;
        };
        let depends = match first.letters.letters() {
            b"BEGIN" | b"END" | b"LBL" | b"Q" | b"QL" | b"QR" => true,
            b"FN" => matches!(first.whole(), Some(0..=14) | None),
            _ => words
                .iter()
                .any(|word| word.is("M") && matches!(word.whole(), Some(2 | 30))),
        };
        match depends {
            true => Behind::Depends,
            false => Behind::Same,
        }
    }

    /// Goes on: a refused block is written as it stands.
    pub(crate) fn go_on(&mut self, at: (usize, usize), written: usize) -> Result<(), Fault> {
        let program = &self.programs[at.0];
        let block = &program.blocks[at.1];
        let words = block.words(program.file.bytes());
        if let [cycle, define, ..] = words.as_slice()
            && (cycle.is("CYCL") || cycle.is("CYCLE"))
            && define.is("DEF")
        {
            self.cycle_refused = true;
        }
        match self.origins.len() == written {
            true => self.write(program.file.part(&block.text), at),
            false => Ok(()),
        }
    }
}
