//! What the parser of a file knows at a line.

use std::ops::Range;

use crate::error::{ProgramError, note};
use crate::krl::lex::TokenFile;
use crate::krl::tree::{Content, Routine, Statement};

/// A block that is not closed yet.
pub(super) enum Block {
    Branches {
        header: usize,
        is_switch: bool,
        complete: bool,
        blocks: Vec<Vec<Statement>>,
        now: Vec<Statement>,
    },
    Loop {
        header: usize,
        word: &'static str,
        block: Vec<Statement>,
    },
}

pub(super) struct Parser<'p, 'a> {
    pub file: &'p TokenFile<'a>,
    pub faults: &'p mut Vec<ProgramError>,
    pub content: Content,
    pub routine: Option<Routine>,
    pub blocks: Vec<Block>,
    pub in_list: bool,
    pub in_spline: bool,
    /// Blocks were not nested as they must be: one fault for a routine is enough.
    pub lost: bool,
    pub outside: bool,
}

impl Parser<'_, '_> {
    pub(super) fn fault(&mut self, tokens: &Range<usize>, reason: impl Into<String>, remedy: &str) {
        let span = self.file.span(tokens);
        let source = self.file.source;
        note(self.faults, || {
            ProgramError::at(source, span, reason, remedy)
        });
    }

    pub(super) fn push(&mut self, statement: Statement) {
        match self.blocks.last_mut() {
            Some(Block::Branches { now, .. }) => now.push(statement),
            Some(Block::Loop { block, .. }) => block.push(statement),
            None => {
                if let Some(routine) = &mut self.routine {
                    routine.body.push(statement);
                }
            }
        }
    }
}
