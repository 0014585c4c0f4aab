//! A jump of the correction: at a corner the load turns, a cut begins.

use nalgebra::Vector3;
use serde::Serialize;

/// The stretch of a turn that a corner step covers.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Turn {
    /// Move whose load holds before.
    pub from_move: usize,
    /// Share of that move.
    pub from_share: f64,
    /// Share of the step's own move at which its load is taken.
    pub to_share: f64,
    /// Part of the turn that is done before the step, 0 to 1.
    pub part_from: f64,
    /// Part of the turn that is done after the step, 0 to 1.
    pub part_to: f64,
}

/// A jump of the correction and the corrections inside it.
#[derive(Debug, Clone)]
pub(crate) struct Jump {
    pub from_move: usize,
    pub from_share: f64,
    pub to_share: f64,
    /// Part of the turn and correction, in order, without the ends.
    pub inner: Vec<(f64, Vector3<f64>)>,
}

impl Jump {
    pub fn between(&self, part_from: f64, part_to: f64) -> Turn {
        Turn {
            from_move: self.from_move,
            from_share: self.from_share,
            to_share: self.to_share,
            part_from,
            part_to,
        }
    }
}
