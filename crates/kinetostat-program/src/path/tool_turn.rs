//! The orientation of the tool along a move, the motion of a machine's rotary axes in it, and the poles near which directions of the
//! tool determine that poorly.

use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::Arc;

use nalgebra::{Isometry3, UnitQuaternion, UnitVector3, Vector3};

use crate::number::{larger, smaller};
use crate::path::great_circle::GreatCircle;
use crate::path::rotary::{ONE_AXIS, RotaryAxes};

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

/// Motion of the rotary axes in a move: each turns linearly with the share, or all of them lead the tool's axis on a great
/// circle.
#[derive(Debug, Clone, PartialEq)]
pub struct RotaryTurn {
    /// The axes.
    pub axes: Arc<RotaryAxes>,
    /// Angles at the start of the move, in the order of the axes, deg.
    pub start_deg: Vec<f64>,
    /// Angles at the end of the move.
    pub end_deg: Vec<f64>,
    /// Origin of the program's words (`G10 L2`).
    pub origin_deg: Vec<f64>,
    /// Great circle of the tool's axis in the part; `None` if each axis turns linearly with the share.
    pub great_circle: Option<GreatCircle>,
    /// Kind of the program's words: angles or a direction.
    pub stated: StatedBy,
}

/// Kind of words by which a program states the angles of rotary axes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum StatedBy {
    /// Words of the axes.
    #[default]
    Angles,
    /// Direction of the tool (G43.5 I J K, A3 B3 C3, six numbers of a GOTO).
    Direction,
}

impl RotaryTurn {
    /// Angles of the axes at a share of the move, deg.
    #[must_use]
    pub fn angles_deg(&self, share: f64) -> Vec<f64> {
        if let Some(circle) = &self.great_circle
            && share > 0.0
            && share < 1.0
        {
            return circle.angles_at(&self.axes, share);
        }
        let both = self.start_deg.iter().zip(&self.end_deg);
        both.map(|(start, end)| start + (end - start) * share.clamp(0.0, 1.0))
            .collect()
    }

    /// Travel of each axis, back and forth, deg.
    #[must_use]
    pub fn ways_deg(&self) -> Vec<f64> {
        if let Some(circle) = &self.great_circle {
            return circle.way_deg();
        }
        let both = self.start_deg.iter().zip(&self.end_deg);
        both.map(|(start, end)| (end - start).abs()).collect()
    }

    /// Orientation of the tool at a share of the move, part axes from tool axes.
    #[must_use]
    pub fn tool(&self, share: f64) -> UnitQuaternion<f64> {
        self.axes.tool(&self.angles_deg(share))
    }

    /// Motion of the part at a share of the move from its place at zero; `None` on a machine without tables.
    ///
    /// ```
    /// use kinetostat_program::{Carries, RotaryAxes, RotaryAxis, RotaryTurn, StatedBy};
    /// use nalgebra::{UnitQuaternion, Vector3};
    ///
    /// let head = RotaryAxis {
    ///     letter: 'A',
    ///     carries: Carries::Tool,
    ///     direction: Vector3::x_axis(),
    ///     point_mm: Vector3::zeros(),
    ///     limits_deg: None,
    /// };
    /// let axes = RotaryAxes { axes: vec![head], tool_at_zero: UnitQuaternion::identity() };
    /// let turn = RotaryTurn {
    ///     axes: axes.into(),
    ///     start_deg: vec![0.0],
    ///     end_deg: vec![30.0],
    ///     origin_deg: vec![0.0],
    ///     great_circle: None,
    ///     stated: StatedBy::Angles,
    /// };
    /// assert!(turn.part(0.5).is_none());
    /// assert_eq!((turn.angles_deg(0.5), turn.ways_deg()), (vec![15.0], vec![30.0]));
    /// assert!((turn.tool(1.0).angle().to_degrees() - 30.0).abs() < 1e-12);
    /// ```
    #[must_use]
    pub fn part(&self, share: f64) -> Option<Isometry3<f64>> {
        self.axes
            .turns_part()
            .then(|| self.axes.part(&self.angles_deg(share)))
    }
}

/// Turns smaller than this are none, rad.
const NO_TURN: f64 = 1e-9;

/// Poles, near which directions of the tool determine its rotary axes poorly.
///
/// Two axes turn the tool, one after the other. The area that the two turns span is `n . R(second) z` times one, with `n` the cross
/// product of both axes: it depends on the angle of the second axis alone, as a cosine, and is zero twice in a revolution. There the
/// tool lies along the first axis (the pole), or as far from it as it comes, and many angles give nearly one direction.
impl RotaryTurn {
    /// The shares of a move of evenly turning axes between which the second axis stands nearer than `near_rad` (less by the sine of the
    /// angle between both axes) to an angle at which directions say little, two for each pole. Empty if it stands there all along.
    ///
    /// ```
    /// use kinetostat_program::{Carries, RotaryAxes, RotaryAxis, RotaryTurn, StatedBy};
    /// use nalgebra::{UnitQuaternion, Vector3};
    ///
    /// let head = |letter, direction| RotaryAxis {
    ///     letter,
    ///     carries: Carries::Tool,
    ///     direction,
    ///     point_mm: Vector3::zeros(),
    ///     limits_deg: None,
    /// };
    /// let axes = vec![head('C', Vector3::z_axis()), head('A', Vector3::x_axis())];
    /// let turn = RotaryTurn {
    ///     axes: RotaryAxes { axes, tool_at_zero: UnitQuaternion::identity() }.into(),
    ///     start_deg: vec![0.0, 20.0],
    ///     end_deg: vec![90.0, -20.0],
    ///     origin_deg: vec![0.0; 2],
    ///     great_circle: None,
    ///     stated: StatedBy::Direction,
    /// };
    /// // Halfway the tool is upright, along C: within a degree of that from 19 of 40 degrees to 21.
    /// let [from, to] = turn.shares_near_poles(1_f64.to_radians())[0];
    /// assert!((from - 19.0 / 40.0).abs() < 1e-12 && (to - 21.0 / 40.0).abs() < 1e-12);
    /// ```
    #[must_use]
    pub fn shares_near_poles(&self, near_rad: f64) -> Vec<[f64; 2]> {
        let (order, turning) = self.axes.in_order_of_turning();
        let ([_, second], [first_axis, second_axis]) = (order.as_slice(), turning.as_slice())
        else {
            return Vec::new();
        };
        let across = first_axis.cross(second_axis);
        let from = self.start_deg[*second].to_radians();
        let way = self.end_deg[*second].to_radians() - from;
        if across.norm() < ONE_AXIS || way.abs() < NO_TURN {
            return Vec::new();
        }
        let area = |angle: f64| {
            let turn = UnitQuaternion::from_axis_angle(second_axis, angle);
            across.dot(&(turn * Vector3::z()))
        };
        let [at_zero, at_quarter] = [area(0.0), area(FRAC_PI_2)];
        if at_zero.hypot(at_quarter) < ONE_AXIS {
            return Vec::new();
        }
        let first_pole = at_quarter.atan2(at_zero) + FRAC_PI_2;
        let near = near_rad / across.norm();
        let (least, largest) = (smaller(from, from + way), larger(from, from + way));
        let mut number = ((least - near - first_pole) / PI).ceil();
        let mut shares = Vec::new();
        while first_pole + number * PI < largest + near {
            let pole = first_pole + number * PI;
            let ends = [pole - near, pole + near].map(|angle| (angle - from) / way);
            let [a, b] = ends.map(|share| share.clamp(0.0, 1.0));
            shares.push([smaller(a, b), larger(a, b)]);
            number += 1.0;
        }
        shares.sort_by(|a, b| a[0].total_cmp(&b[0]));
        shares.retain(|[from, to]| from < to && to - from < 1.0);
        shares
    }
}
