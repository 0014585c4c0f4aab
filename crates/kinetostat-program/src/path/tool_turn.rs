//! The orientation of the tool along a move.

use nalgebra::{Isometry3, UnitQuaternion, UnitVector3, Vector3};

use crate::path::rotary_turn::RotaryTurn;

/// The orientation of the tool at the two ends of a move, part axes from tool axes: what is written in axes of the tool, turned by
/// it, is in axes of the part.
///
/// Between its ends it turns evenly with the share: about one axis and by the shorter way, as controllers do that interpolate
/// quaternions (ABB); or an axis of the tool swivels in a plane while the tool turns about that axis, as KUKA's LIN and CIRC
/// do with the x of the tool; or as the rotary axes of the machine do.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct ToolTurn {
    /// Orientation at the start of the move.
    pub start: UnitQuaternion<f64>,
    /// Orientation at its end.
    pub end: UnitQuaternion<f64>,
    /// Motion of the machine's rotary axes, if the program states their angles.
    pub rotary: Option<RotaryTurn>,
    /// The axis that swivels in a plane, axes of the tool; `None` where the tool turns about one axis.
    pub swivelling: Option<UnitVector3<f64>>,
}

/// Directions whose sine is below this lie in no plane of their own, or in any.
const SAME_DIRECTION: f64 = 1e-9;

impl ToolTurn {
    /// About one axis and by the shorter way.
    #[must_use]
    pub fn shortest(start: UnitQuaternion<f64>, end: UnitQuaternion<f64>) -> Self {
        Self {
            start,
            end,
            rotary: None,
            swivelling: None,
        }
    }

    /// An axis of the tool goes the shorter way in a plane, and the tool turns about it.
    ///
    /// ```
    /// use kinetostat_program::ToolTurn;
    /// use nalgebra::{UnitQuaternion, Vector3};
    ///
    /// let end = UnitQuaternion::from_euler_angles(0.4, 0.0, 0.6); // 0.6 rad about z, before that 0.4 rad about x
    /// let turn = ToolTurn::swivelled(UnitQuaternion::identity(), end, Vector3::x_axis());
    /// // Half of both angles; about one axis it would be something else.
    /// let half = UnitQuaternion::from_euler_angles(0.2, 0.0, 0.3);
    /// assert!(turn.at(0.5).angle_to(&half) < 1e-12);
    /// assert!(ToolTurn::shortest(UnitQuaternion::identity(), end).at(0.5).angle_to(&half) > 1e-2);
    /// ```
    #[must_use]
    pub fn swivelled(
        start: UnitQuaternion<f64>,
        end: UnitQuaternion<f64>,
        axis: UnitVector3<f64>,
    ) -> Self {
        Self {
            swivelling: Some(axis),
            ..Self::shortest(start, end)
        }
    }

    /// Orientation along a motion of rotary axes.
    #[must_use]
    pub fn rotary(turn: RotaryTurn) -> Self {
        let ends = Self::shortest(turn.tool(0.0), turn.tool(1.0));
        Self {
            rotary: Some(turn),
            ..ends
        }
    }

    /// Orientation between two other ends, in the way in which the controller turns the tool here; about one axis if rotary
    /// axes turn it.
    ///
    /// ```
    /// use kinetostat_program::ToolTurn;
    /// use nalgebra::{UnitQuaternion, Vector3};
    ///
    /// let [a, b, c] = [0.0, 0.1, 0.3].map(|angle| UnitQuaternion::from_euler_angles(angle, 0.0, angle));
    /// let turn = ToolTurn::swivelled(a, c, Vector3::x_axis());
    /// assert_eq!(turn.with_ends(a, b), ToolTurn::swivelled(a, b, Vector3::x_axis()));
    /// ```
    #[must_use]
    pub fn with_ends(&self, start: UnitQuaternion<f64>, end: UnitQuaternion<f64>) -> Self {
        Self {
            swivelling: self.swivelling,
            ..Self::shortest(start, end)
        }
    }

    /// Motion of the part by a table at a share of the move from its place at zero, in the axes of the part there, mm; `None`
    /// without a table.
    #[must_use]
    pub fn part(&self, share: f64) -> Option<Isometry3<f64>> {
        self.rotary.as_ref()?.part(share)
    }

    /// The orientation at a share of the move, part axes from tool axes.
    ///
    /// Two ends half a turn apart have no shorter way: it turns about the axis of the rotation vector between them; so it does
    /// where the axis that swivels is turned round.
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
        let share = share.clamp(0.0, 1.0);
        if let Some(swivel) = self.swivelling.and_then(|axis| self.swivel(&axis)) {
            let part = |way: Vector3<f64>| UnitQuaternion::from_scaled_axis(way * share);
            return part(swivel.way) * self.start * part(swivel.turn);
        }
        let way = (self.start.inverse() * self.end).scaled_axis();
        self.start * UnitQuaternion::from_scaled_axis(way * share)
    }

    /// Swivel of an axis of the tool, and rotation of the tool about it; `None` if the axis is reversed: any plane would do.
    fn swivel(&self, axis: &UnitVector3<f64>) -> Option<Swivel> {
        let [from, to] = [self.start, self.end].map(|orientation| orientation * axis.into_inner());
        let across = from.cross(&to);
        let (sine, cosine) = (across.norm(), from.dot(&to));
        let way = match sine > SAME_DIRECTION {
            true => across * (sine.atan2(cosine) / sine),
            false if cosine > 0.0 => across,
            false => return None,
        };
        let swivelled = UnitQuaternion::from_scaled_axis(way) * self.start;
        let rest = (swivelled.inverse() * self.end).scaled_axis();
        let turn = axis.into_inner() * rest.dot(axis);
        Some(Swivel { way, turn })
    }
}

/// Two turns at the same time, rotation vectors in rad.
struct Swivel {
    /// Rotation of the axis, part axes.
    way: Vector3<f64>,
    /// About it, axes of the tool.
    turn: Vector3<f64>,
}
