//! A circle through three places in the written program.

use nalgebra::Vector3;
use serde::Serialize;

use crate::path::curve::Arc;
use crate::writing::written_arc::slipped;

/// A circle of the written program that passes through a place between its ends, or an arc about a stated centre, as it was read
/// again.
///
/// ```
/// use kinetostat_program::{Arc, WrittenCircle};
/// use nalgebra::Vector3;
///
/// let [start, via, end] = [[5.0, 0.0], [0.0, 5.0], [-5.0, 0.0]].map(|[x, y]| Vector3::new(x, y, 2.0));
/// let curve = Arc::through(&start, &via, &end).unwrap();
/// let circle = WrittenCircle { curve, slip: [0.0, 0.0] };
/// assert!((circle.commanded(0.5) - via).norm() < 1e-12);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct WrittenCircle {
    /// Curve, part frame, in mm.
    pub curve: Arc,
    /// Slip, as in [`crate::WrittenArc::slip`].
    pub slip: [f64; 2],
}

impl WrittenCircle {
    /// Commanded tool position when a part (0 to 1) of the piece's stretch of the path is done, mm.
    #[must_use]
    pub fn commanded(&self, part: f64) -> Vector3<f64> {
        self.curve.point(slipped(&self.slip, part))
    }
}
