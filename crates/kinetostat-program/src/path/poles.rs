//! Poles, near which directions of the tool determine its rotary axes poorly.
//!
//! Two axes turn the tool, one after the other. The area that the two turns span is `n . R(second) z` times one, with `n` the cross
//! product of both axes: it depends on the angle of the second axis alone, as a cosine, and is zero twice in a revolution. There the
//! tool lies along the first axis (the pole), or as far from it as it comes, and many angles give nearly one direction.

use std::f64::consts::{FRAC_PI_2, PI};

use nalgebra::{UnitQuaternion, Vector3};

use crate::number::{larger, smaller};
use crate::path::area_of_turns::ONE_AXIS;
use crate::path::rotary_turn::RotaryTurn;

/// Turns smaller than this are none, rad.
const NO_TURN: f64 = 1e-9;

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
