//! State of the parser of a file at a line.

use std::ops::Range;

use crate::error::{ProgramError, note};
use crate::interpreter::token::TokenFile;
use crate::interpreter::tree::{DatumNode, Preset, Routine, Statement};
use crate::text::name::Name;

/// The content of a file.
#[derive(Debug, Clone, Default)]
pub(crate) struct Content {
    pub data: Vec<DatumNode>,
    pub presets: Vec<Preset>,
    pub routines: Vec<Routine>,
    /// The name behind DEFDAT.
    pub list: Option<Name>,
}

/// A block that is not closed yet, with the tokens of the line that opens it.
pub(super) enum Block {
    Branches {
        header: Range<usize>,
        is_switch: bool,
        /// Condition of IF; selector of SWITCH, and the values of each CASE.
        conditions: Vec<Range<usize>>,
        is_complete: bool,
        blocks: Vec<Vec<Statement>>,
        now: Vec<Statement>,
    },
    Loop {
        header: Range<usize>,
        word: &'static str,
        block: Vec<Statement>,
    },
    /// SPLINE, or PTP_SPLINE, which is refused as a whole: nothing in it is looked at.
    Spline {
        header: Range<usize>,
        word: &'static str,
        block: Vec<Statement>,
    },
}

impl Block {
    /// The tokens of the line that opens it, with its word and the one that closes it.
    pub fn words(&self) -> (&Range<usize>, &'static str, &'static str) {
        match self {
            Self::Branches {
                header,
                is_switch: true,
                ..
            } => (header, "SWITCH", "ENDSWITCH"),
            Self::Branches { header, .. } => (header, "IF", "ENDIF"),
            Self::Loop { header, word, .. } => (
                header,
                word,
                match *word {
                    "LOOP" => "ENDLOOP",
                    "FOR" => "ENDFOR",
                    "WHILE" => "ENDWHILE",
                    _ => "UNTIL",
                },
            ),
            Self::Spline { header, word, .. } => (header, word, "ENDSPLINE"),
        }
    }
}

/// The joint motions of which one block is.
pub(super) const JOINT_SPLINE: &str = "PTP_SPLINE";

pub(super) struct Parser<'p, 'a> {
    pub file: &'p TokenFile<'a>,
    pub faults: &'p mut Vec<ProgramError>,
    pub content: Content,
    pub routine: Option<Routine>,
    pub blocks: Vec<Block>,
    pub in_list: bool,
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
            Some(Block::Loop { block, .. } | Block::Spline { block, .. }) => block.push(statement),
            None => {
                if let Some(routine) = &mut self.routine {
                    routine.body.push(statement);
                }
            }
        }
    }
}
