//! The corrected curve of a move, from what its division found out about the correction.

use nalgebra::Vector3;

use crate::path::moves::Move;
use crate::writing::departure::polynomial;
use crate::writing::merge::Accepted;

/// Path and correction of one move; between two stretches the correction may jump.
#[derive(Clone, Copy)]
pub(crate) struct CorrectedCurve<'a> {
    pub motion: &'a Move,
    /// The correction on the whole move, by share.
    pub stretches: &'a [Accepted],
}

impl CorrectedCurve<'_> {
    /// Where the tool is to go at a share of the move that is no end of it, in mm.
    pub fn point(&self, share: f64) -> Vector3<f64> {
        let next = self
            .stretches
            .partition_point(|stretch| stretch.share <= share);
        let correction = next.checked_sub(1).map_or_else(Vector3::zeros, |index| {
            let stretch = &self.stretches[index];
            let end = self.stretches.get(next).map_or(1.0, |next| next.share);
            let part = (share - stretch.share) / (end - stretch.share);
            polynomial(&stretch.values, part.clamp(0.0, 1.0))
                .fixed_rows::<3>(0)
                .into_owned()
        });
        self.motion.point(share) + correction
    }
}
