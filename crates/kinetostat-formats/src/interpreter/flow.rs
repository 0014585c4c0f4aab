//! Ways on behind a statement.

use std::ops::Range;

use crate::interpreter::value::Datum;
use crate::text::name::Name;

/// Continuation of a run after a statement.
pub(crate) enum Flow {
    Next,
    /// Return to the caller, with the value of a function.
    Returns(Option<Datum>),
    /// At a label of a block around it.
    To(Name, Range<usize>),
    /// Leaves the innermost loop.
    Breaks,
    /// To the next pass of the innermost loop.
    Continues,
    /// Nowhere: the program ends.
    Ends,
}

/// A statement that leaves its block.
pub(crate) enum Leave {
    /// To a label.
    Jump(Name),
    /// From its routine, with the tokens of a value.
    Returns(Option<Range<usize>>),
    /// From the innermost loop.
    Breaks,
    /// To the next pass of the innermost loop.
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
