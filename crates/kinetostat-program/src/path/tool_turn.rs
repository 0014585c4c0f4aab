//! The orientation of the tool along a move.

use nalgebra::UnitQuaternion;

/// The orientation of the tool at the two ends of a move, part axes from tool axes: what is written in axes of the tool, turned by
/// it, is in axes of the part.
///
/// Between its ends it turns about one axis, evenly with the share and by the shorter way, as robot controllers do that
/// interpolate quaternions (ABB, FANUC, KUKA with `#VAR`).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ToolTurn {
    /// At the start of the move.
    pub start: UnitQuaternion<f64>,
    /// At its end.
    pub end: UnitQuaternion<f64>,
}

impl ToolTurn {
    /// The orientation at a share of the move, part axes from tool axes.
    ///
    /// Two ends half a turn apart have no shorter way: it turns about the axis of the rotation vector between them.
    ///
    /// ```
    /// use kinetostat_program::ToolTurn;
    /// use nalgebra::{UnitQuaternion, Vector3};
    ///
    /// let about_x = |degrees: f64| UnitQuaternion::from_euler_angles(degrees.to_radians(), 0.0, 0.0);
    /// let turn = ToolTurn { start: about_x(170.0), end: about_x(-170.0) };
    /// assert!(turn.at(0.25).angle_to(&about_x(175.0)) < 1e-12); // through 180 degrees, not through 0
    /// ```
    #[must_use]
    pub fn at(&self, share: f64) -> UnitQuaternion<f64> {
        let way = (self.start.inverse() * self.end).scaled_axis();
        self.start * UnitQuaternion::from_scaled_axis(way * share.clamp(0.0, 1.0))
    }
}
