//! Position of a path within a longer one.

use std::ops::Range;

/// Position of a path within a longer one.
#[derive(Debug, Clone, PartialEq)]
pub struct PathPart {
    /// Indices of the moves that are its own: the others say how these begin and end (directions, corners, the way on which a
    /// load comes), and belong to the parts beside it.
    pub moves: Range<usize>,
    /// Moves of the whole path before the first of all of these.
    pub moves_before: usize,
    /// Nothing of the program comes before its own moves.
    pub begins: bool,
    /// Length of the path before its own moves, mm, of all moves from known places.
    pub before_mm: f64,
    /// Length of all that the whole program cuts, mm.
    pub whole_feed_mm: f64,
    /// Arcs at feed in the whole program.
    pub whole_feed_arcs: usize,
}
