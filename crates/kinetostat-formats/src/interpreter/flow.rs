//! Ways on behind a statement.

use std::ops::Range;

use crate::interpreter::value::Datum;
use crate::text::name::Name;

/// Continuation of a run after a statement.
pub(crate) enum Flow {
    Next,
    /// Return to the caller, with the value of a function.
    Returns(Option<Datum>),
    /// Jump to a label of an enclosing block.
    To(Name, Range<usize>),
    /// Leaves the innermost loop.
    Breaks,
    /// Next pass of the innermost loop.
    Continues,
    /// End of the program.
    Ends,
}

/// A statement that leaves its block.
pub(crate) enum Leave {
    /// Jump to a label.
    Jump(Name),
    /// Return from the routine, with the tokens of a value.
    Returns(Option<Range<usize>>),
    /// Exit from the innermost loop.
    Breaks,
    /// Next pass of the innermost loop.
    Continues,
    /// The program ends.
    Ends,
}

/// A loop that counts, by tokens.
pub(crate) struct Counting {
    pub variable: Range<usize>,
    pub from: Range<usize>,
    pub to: Range<usize>,
    pub step: Option<Range<usize>>,
}
