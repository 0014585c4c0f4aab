//! A piece of another program that belongs to a part of one move of the original.

use kinetostat_program::Piece;

/// A piece of the other program with the move of it that it is a part of.
pub(crate) struct Followed {
    pub(crate) piece: Piece,
    /// Index of the move in the other program, and the share of it at which the piece ends.
    pub(crate) other_end: (usize, f64),
    /// The share of it at which the piece begins.
    pub(crate) other_from: f64,
    /// True if its end is fixed: the load turns there, or it is where a move of the original was found again.
    pub(crate) is_held: bool,
    /// A part of a move that the original makes just so.
    pub(crate) is_same: bool,
}
