//! A jump of the correction: at a corner the load turns, a cut begins.

use nalgebra::Vector6;
use serde::Serialize;

use crate::path::moves::{MoveKind, Path};

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

impl Turn {
    /// True if the step is at the end of a rapid: the load is there at once, where others are at corners or inside a
    /// cut.
    ///
    /// ```
    /// use kinetostat_program::*;
    ///
    /// let program = Program::read("G21 G90\nG0 X0 Y0 Z0\nG1 X10 F600\nG1 Y10\n")?;
    /// let path = interpret(&program, &ReadOptions::default())?;
    /// let after = |from_move| Turn { from_move, from_share: 1.0, to_share: 0.0, part_from: 0.0, part_to: 1.0 };
    /// assert!(after(0).is_entry(&path) && !after(1).is_entry(&path));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn is_entry(&self, path: &Path) -> bool {
        let before = path.moves.get(self.from_move);
        before.is_some_and(|before| before.kind == MoveKind::Rapid)
    }
}

/// A jump of the correction and the corrections inside it.
#[derive(Debug, Clone)]
pub(crate) struct Jump {
    pub from_move: usize,
    pub from_share: f64,
    pub to_share: f64,
    /// Part of the turn and correction, in order, without the ends.
    pub inner: Vec<(f64, Vector6<f64>)>,
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
