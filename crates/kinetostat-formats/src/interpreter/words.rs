//! Words of a language whose blocks begin and end with words.

use std::ops::Range;

use crate::interpreter::flow::Leave;
use crate::interpreter::lexing::Marks;
use crate::interpreter::token::TokenFile;
use crate::interpreter::tree::RoutineKind;

/// The words of a language.
pub(crate) struct Words {
    pub marks: Marks,
    /// Before a routine, and its kind where it stands in no other and has no parameters.
    pub routines: &'static [(&'static str, RoutineKind)],
    /// Before the first condition of a branch, a further one, and what runs otherwise.
    pub branch: [&'static str; 3],
    /// Before a loop with its condition.
    pub repeat: &'static str,
    /// Word after each block.
    pub end: &'static str,
    /// Byte after a header.
    pub colon: u8,
    /// Before a name that all routines see, and before one of its routine.
    pub scopes: [&'static str; 2],
    /// Before what returns, breaks a loop, goes on with its next pass, and ends the program.
    pub leaves: [&'static str; 4],
    /// Before a statement that is neither a call nor an assignment.
    pub plain: &'static [&'static str],
    /// A statement that does nothing.
    pub nothing: &'static str,
}

impl Words {
    /// Effect of a statement that leaves its block.
    pub(crate) fn leave(&self, file: &TokenFile<'_>, tokens: &Range<usize>) -> Leave {
        let word = file.word(tokens.start);
        let value = tokens.start + 1..tokens.end;
        match self.leaves.iter().position(|own| word == own.as_bytes()) {
            Some(1) => Leave::Breaks,
            Some(2) => Leave::Continues,
            Some(3) => Leave::Ends,
            _ => Leave::Returns((!value.is_empty()).then_some(value)),
        }
    }
}
