//! Distance of a machine from postures in which a rotary axis turns the tool about itself.

use std::f64::consts::FRAC_PI_2;

use nalgebra::{UnitQuaternion, Vector3};

use crate::number::smaller;
use crate::path::rotary::RotaryAxes;

/// Axes whose cross product is smaller turn about one direction.
pub(super) const ONE_AXIS: f64 = 1e-6;

impl RotaryAxes {
    /// The area that the turns of the tool by both axes span, 1 where they turn it across each other: the tool turns by no less than it
    /// times the turn of an axis. Zero at a pole; infinite where there are not two axes.
    pub(crate) fn area_of_turns(&self, angles_deg: &[f64]) -> f64 {
        self.areas_of_turns(angles_deg)
            .map_or(f64::INFINITY, |[area, _]| area)
    }

    /// Angle of the second of two axes to the nearest singular one, rad, where the tool lies along the first axis (the pole), or as far
    /// from it as it comes. `None` if there are not two different axes.
    ///
    /// ```
    /// use kinetostat_program::{Carries, RotaryAxes, RotaryAxis};
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
    /// let fork = RotaryAxes { axes, tool_at_zero: UnitQuaternion::identity() };
    /// assert!((fork.from_pole_rad(&[70.0, -3.0]).unwrap() - 3_f64.to_radians()).abs() < 1e-12);
    /// ```
    #[must_use]
    pub fn from_pole_rad(&self, angles_deg: &[f64]) -> Option<f64> {
        let [area, most] = self.areas_of_turns(angles_deg)?;
        (most > ONE_AXIS).then(|| smaller(area / most, 1.0).asin())
    }

    /// The area at these angles, and the largest of all.
    fn areas_of_turns(&self, angles_deg: &[f64]) -> Option<[f64; 2]> {
        let (order, turning) = self.in_order_of_turning();
        let ([_, second], [first_axis, second_axis]) = (order.as_slice(), turning.as_slice())
        else {
            return None;
        };
        let across = first_axis.cross(second_axis);
        let area = |angle: f64| {
            let turn = UnitQuaternion::from_axis_angle(second_axis, angle);
            across.dot(&(turn * Vector3::z()))
        };
        let now = area(angles_deg.get(*second)?.to_radians());
        Some([now.abs(), area(0.0).hypot(area(FRAC_PI_2))])
    }
}
