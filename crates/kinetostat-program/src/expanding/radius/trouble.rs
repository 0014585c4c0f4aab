//! Errors of a compensated block.

use crate::error::ProgramError;
use crate::expanding::translate::wrong::Wrong;

/// Reason for which a block is refused.
pub(crate) enum Trouble {
    /// Reading a block found it.
    Block(ProgramError),
    /// The compensation found it: of the line that runs.
    Line(Wrong),
}

impl From<ProgramError> for Trouble {
    fn from(error: ProgramError) -> Self {
        Self::Block(error)
    }
}

impl From<Wrong> for Trouble {
    fn from(wrong: Wrong) -> Self {
        Self::Line(wrong)
    }
}
