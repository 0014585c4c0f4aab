//! The position offset of G92.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// Change of the position offset by a block.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum OffsetChange {
    /// G92: the place where the tool stands gets these coordinates (in mm).
    Here {
        coordinates_mm: [Option<f64>; 3],
        work_offset_mm: Vector3<f64>,
        /// The axis was unknown: its place is what the word says.
        establishes: [bool; 3],
    },
    /// G92.1
    Clear,
    /// G92.2
    Suspend,
    /// G92.3
    Resume,
}

/// The position offset of one run of a program: the one in the input, or the one in the output.
///
/// The two differ: the controller takes its commanded position as the reference of G92, and in the
/// output that is the corrected one.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct PositionOffset {
    pub active_mm: Vector3<f64>,
    saved_mm: Vector3<f64>,
}

impl PositionOffset {
    /// Applies a change while the tool is at `position_mm`.
    pub fn apply(&mut self, change: &OffsetChange, position_mm: &Vector3<f64>) {
        match change {
            OffsetChange::Here {
                coordinates_mm,
                work_offset_mm,
                ..
            } => {
                for axis in 0..3 {
                    if let Some(coordinate) = coordinates_mm[axis] {
                        self.active_mm[axis] =
                            position_mm[axis] - work_offset_mm[axis] - coordinate;
                    }
                }
                self.saved_mm = self.active_mm;
            }
            OffsetChange::Clear => *self = Self::default(),
            OffsetChange::Suspend => self.active_mm = Vector3::zeros(),
            OffsetChange::Resume => self.active_mm = self.saved_mm,
        }
    }
}
