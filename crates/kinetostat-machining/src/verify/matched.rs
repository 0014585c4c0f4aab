//! How a program belongs to the original that it is verified against.

use serde::{Deserialize, Serialize};

/// How a program belongs to its original.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Matched {
    /// Largest distance of the program from the original as the model compensates it, mm.
    pub largest_distance_mm: f64,
    /// Line of the program where that is.
    pub largest_distance_line: usize,
    /// Parts of the original that the program does not cut, in their order.
    pub uncut: Vec<Uncut>,
}

/// A part of the original that a program does not cut.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Uncut {
    /// First and last line of it in the original.
    pub lines: [usize; 2],
    /// Its length, mm.
    pub length_mm: f64,
}
