//! The orientation of the tool along a move.

use nalgebra::{Isometry3, UnitQuaternion};

use crate::path::rotary::RotaryTurn;

/// The orientation of the tool at the two ends of a move, part axes from tool axes: what is written in axes of the tool, turned by
/// it, is in axes of the part.
///
/// Between its ends it turns about one axis, evenly with the share and by the shorter way, as robot controllers do that
/// interpolate quaternions (ABB, FANUC, KUKA with `#VAR`); or as the rotary axes of the machine do.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct ToolTurn {
    /// At the start of the move.
    pub start: UnitQuaternion<f64>,
    /// At its end.
    pub end: UnitQuaternion<f64>,
    /// What the rotary axes of the machine do, where the program states their angles.
    pub rotary: Option<RotaryTurn>,
}

impl ToolTurn {
    /// About one axis and by the shorter way.
    #[must_use]
    pub fn shortest(start: UnitQuaternion<f64>, end: UnitQuaternion<f64>) -> Self {
        Self {
            start,
            end,
            rotary: None,
        }
    }

    /// As rotary axes turn.
    #[must_use]
    pub fn rotary(turn: RotaryTurn) -> Self {
        Self {
            start: turn.tool(0.0),
            end: turn.tool(1.0),
            rotary: Some(turn),
        }
    }

    /// How far a table has turned the part at a share of the move from where it lies at zero, in the axes of the part there, mm;
    /// `None` without a table.
    #[must_use]
    pub fn part(&self, share: f64) -> Option<Isometry3<f64>> {
        self.rotary.as_ref()?.part(share)
    }

    /// The orientation at a share of the move, part axes from tool axes.
    ///
    /// Two ends half a turn apart have no shorter way: it turns about the axis of the rotation vector between them.
    ///
    /// ```
    /// use kinetostat_program::ToolTurn;
    /// use nalgebra::{UnitQuaternion, Vector3};
    ///
    /// let about_x = |degrees: f64| UnitQuaternion::from_euler_angles(degrees.to_radians(), 0.0, 0.0);
    /// let turn = ToolTurn::shortest(about_x(170.0), about_x(-170.0));
    /// assert!(turn.at(0.25).angle_to(&about_x(175.0)) < 1e-12); // through 180 degrees, not through 0
    /// ```
    #[must_use]
    pub fn at(&self, share: f64) -> UnitQuaternion<f64> {
        if let Some(rotary) = &self.rotary {
            return rotary.tool(share);
        }
        let way = (self.start.inverse() * self.end).scaled_axis();
        self.start * UnitQuaternion::from_scaled_axis(way * share.clamp(0.0, 1.0))
    }
}
