//! What acts on the tool at one place of a cut.

use kinetostat::Wrench;
use nalgebra::Vector3;
use serde::Serialize;

/// Part of a direction across the tool axis below which a move has no direction there: within 0.1 degree of the axis.
pub(crate) const ACROSS: f64 = 2e-3;

/// Heading of a direction, seen along z of the part frame, rad; `None` along z.
pub(crate) fn heading(tangent: Option<Vector3<f64>>) -> Option<f64> {
    let t = tangent?;
    (t.xy().norm() > ACROSS).then(|| t.y.atan2(t.x))
}

/// Moves shorter than this, mm, do not turn the load: a tooth's feed is several times as long, and programs from CAM
/// systems have moves of tenths of micrometres in any direction.
pub(crate) const SHORT_MM: f64 = 0.01;

/// A place of the path with the force of the cut.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct CutStation {
    /// Share of the move's length.
    pub share: f64,
    /// Force (N) and moment about the tip (N m) on the tool: x along the feed, z along the part's z, y to the left; axes of
    /// the part where the tool goes within 0.1 degree of its axis.
    pub wrench: Wrench,
    /// Mean torque of the spindle, N m.
    pub torque_n_m: f64,
    /// Length of the edges in contact along the axis, mm, without what the tip leaves below the stock; 0 in air.
    pub depth_mm: f64,
    /// Sum of the arcs in contact at the lowest height, rad: pi in a slot, 0 in air.
    pub arc: f64,
    /// Thickest place of a chip, mm; 0 in air.
    pub chip_mm: f64,
    /// Feed per tooth, mm; 0 in air.
    pub feed_per_tooth_mm: f64,
    /// Speed of the spindle, rpm; 0 in air.
    pub rpm: f64,
}

impl CutStation {
    /// Nothing acts.
    pub(crate) fn air(share: f64) -> Self {
        Self {
            share,
            wrench: Wrench::zero(),
            torque_n_m: 0.0,
            depth_mm: 0.0,
            arc: 0.0,
            chip_mm: 0.0,
            feed_per_tooth_mm: 0.0,
            rpm: 0.0,
        }
    }
}
