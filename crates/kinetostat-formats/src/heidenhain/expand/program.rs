//! A file of a program: its blocks, its labels, whether anything of it is to be flattened.

use crate::error::ProgramError;
use crate::heidenhain::blocks::{Block, blocks_of};
use crate::heidenhain::called::is_called;
use crate::heidenhain::flow::{Labels, NAME_IT, label_twice, labels_of, order, step_of};
use crate::heidenhain::words::{Value, Word};
use crate::model::slash_blocks::SlashBlocks;
use crate::text::source::SourceFile;

/// A file of the program.
pub(crate) struct Program<'f> {
    pub file: &'f SourceFile,
    pub blocks: Vec<Block>,
    pub labels: Labels,
    /// Blocks that state a label a second time, each behind that of before.
    pub twice: Vec<[usize; 2]>,
    /// The block BEGIN PGM.
    pub begin: Option<usize>,
}

impl<'f> Program<'f> {
    pub(crate) fn of(file: &'f SourceFile) -> Self {
        let blocks = blocks_of(file.bytes());
        let (labels, twice) = labels_of(file.bytes(), &blocks);
        let begins = |block: &Block| {
            let letter = file.bytes().get(block.text.start);
            letter.is_some_and(|letter| letter.eq_ignore_ascii_case(&b'B'))
                && block
                    .words(file.bytes())
                    .first()
                    .is_some_and(|word| word.is("BEGIN"))
        };
        let begin = blocks.iter().position(begins);
        Self {
            file,
            blocks,
            labels,
            twice,
            begin,
        }
    }

    pub(crate) fn unit_mm(&self) -> f64 {
        let words = self
            .begin
            .map(|at| self.blocks[at].words(self.file.bytes()));
        match words.is_some_and(|words| words.iter().any(|word| word.is("INCH"))) {
            true => 25.4,
            false => 1.0,
        }
    }

    /// True if CALL PGM calls the program by this name.
    pub(crate) fn is_named(&self, name: &str) -> bool {
        is_called(self.file, name)
    }

    /// Errors of labels that are defined twice.
    pub(crate) fn equal_labels(&self) -> impl Iterator<Item = ProgramError> + '_ {
        let fault = |[first, index]: &[usize; 2]| {
            let text = self.blocks[*index].text.clone();
            let line = self.file.line_of(self.blocks[*first].text.start);
            ProgramError::at(self.file, text, label_twice(line), NAME_IT)
        };
        self.twice.iter().map(fault)
    }

    /// True if the program needs to be expanded.
    pub(crate) fn needs(&self, slash: SlashBlocks) -> bool {
        let bytes = self.file.bytes();
        let Some(begin) = self.begin else {
            return false;
        };
        let mut calls = false;
        for block in &self.blocks[begin..] {
            let words = block.words(bytes);
            let Some(first) = words.first() else {
                continue;
            };
            let assigns = matches!(first.letters.letters(), b"Q" | b"QL" | b"QR" | b"QS");
            match first.letters.letters() {
                b"CALL" if words.len() == 2 && words[1].is("LBL") => calls = true,
                b"CALL" => return true,
                b"FN" if matches!(first.whole(), Some(9..=12)) => return true,
                b"FN" => continue,
                b"CYCL" | b"CYCLE" if words.get(1).is_some_and(|word| word.is("CALL")) => {
                    return true;
                }
                _ if assigns => continue,
                _ => {}
            }
            let needs = |word: &Word| {
                matches!(word.value, Value::Parameter { .. })
                    || (word.is("M") && matches!(word.whole(), Some(89 | 99)))
            };
            if words.iter().any(needs) {
                return true;
            }
        }
        calls
            && order(begin, self.blocks.len(), &self.labels, |at| {
                step_of(bytes, &self.blocks[at], slash)
            })
            .is_err()
    }
}
