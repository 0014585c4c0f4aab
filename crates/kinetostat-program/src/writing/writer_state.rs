//! State of a writer between two parts of a program.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::path::position_offset::PositionOffset;
use crate::writing::output_state::OutputState;

/// State of a writer between two parts of a program: the second one is written from it and its own lines.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct WriterState {
    pub(crate) output: OutputState,
    /// Last rotation of the tool, rad.
    pub(crate) tilt: Vector3<f64>,
    /// Line of the output that is written next.
    pub(crate) output_line: usize,
    /// Pieces that were written so far.
    pub(crate) pieces: usize,
    pub(crate) input_offset: PositionOffset,
    pub(crate) input_position: Vector3<f64>,
    /// A correction was written so far.
    pub(crate) corrected: bool,
    /// The largest so far: by so much may an axis be off that a block does not name.
    pub(crate) largest_correction_mm: f64,
}
