//! The last check of a written program, from its bytes: its geometry and feeds, its text, and the field evaluated again in
//! places that the division did not choose.

pub(crate) mod field;
pub(crate) mod moves;
pub(crate) mod text;
pub(crate) mod verify;

use serde::Serialize;

use crate::error::WriteError;
use crate::path::moves::Path;
use crate::text::program::Program;
use crate::writing::accounting::Accounting;
use crate::writing::options::WriteOptions;
use crate::writing::written::Piece;

/// Results of the check of a program that passed.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Verification {
    /// Lines of the output that were read.
    pub lines: usize,
    /// Motions of the output that were read.
    pub moves: usize,
    /// Largest distance of the output's path from the input's, in mm.
    pub largest_distance_mm: f64,
    /// Largest relative difference of the speed along the part from the programmed one, where the feed
    /// was not limited.
    pub largest_speed_error: f64,
    /// Pieces whose feed was limited ([`Piece::feed_limited`]): they are slower along the part.
    pub feed_limited_pieces: usize,
    /// Bytes of the longest line of the output, without its line ending.
    pub longest_line_bytes: usize,
}

/// A written program and what it was made of.
pub(crate) struct Verifier<'a> {
    pub input: &'a Program,
    pub input_path: &'a Path,
    pub output: &'a Program,
    pub pieces: &'a [Piece],
    /// See [`crate::Corrected::rotary_deg`].
    pub rotary_deg: &'a [Vec<f64>],
    pub accounting: &'a Accounting,
    pub writing: &'a WriteOptions,
    pub found: Verification,
}

pub(crate) fn fail(line: usize, output_line: usize, what: String) -> WriteError {
    WriteError::Verification {
        line,
        output_line,
        what,
    }
}
