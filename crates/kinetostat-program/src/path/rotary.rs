//! Rotary axes of a machine, and how they turn tool and part while a program runs.
//!
//! A head turns the tool, a table the part. A program whose places are those of the tool's tip in the part (tool centre point control:
//! G43.4, TRAORI, M128) says where the tip goes in the part as it stands on the table; heads and tables turn by their words.

use std::f64::consts::FRAC_PI_2;

use nalgebra::{Isometry3, Translation3, UnitQuaternion, UnitVector3, Vector3};

use crate::number::smaller;

/// Element that a rotary axis turns.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Carries {
    /// A head.
    Tool,
    /// A table.
    Part,
}

/// A rotary axis of a machine, where all of them stand at zero.
#[derive(Debug, Clone, PartialEq)]
pub struct RotaryAxis {
    /// Letter of its word: A, B or C.
    pub letter: char,
    /// Element that it turns.
    pub carries: Carries,
    /// About which its word counts, right-handed: axes of the part as it lies where all axes stand at zero. A table that turns
    /// the part clockwise for positive words, seen against z, has -z here.
    pub direction: UnitVector3<f64>,
    /// A point on it, mm, part frame there. The point of a head does not matter: the tip goes where the program says.
    pub point_mm: Vector3<f64>,
    /// Minimum and maximum angle, deg; `None` for endless rotation.
    pub limits_deg: Option<[f64; 2]>,
}

/// All rotary axes of a machine.
///
/// ```
/// use kinetostat_program::{Carries, RotaryAxes, RotaryAxis};
/// use nalgebra::{Isometry3, Point3, UnitQuaternion, Vector3};
///
/// // A table that turns about z of the part, 100 mm beside the part's origin.
/// let table = RotaryAxis {
///     letter: 'C',
///     carries: Carries::Part,
///     direction: Vector3::z_axis(),
///     point_mm: Vector3::new(100.0, 0.0, 0.0),
///     limits_deg: None,
/// };
/// let axes = RotaryAxes { axes: vec![table], tool_at_zero: UnitQuaternion::identity() };
/// let turned = axes.part(&[90.0]) * Point3::origin();
/// assert!((turned - Point3::new(100.0, -100.0, 0.0)).norm() < 1e-9);
/// // In the part, the tool turns the other way.
/// let tool = axes.tool(&[90.0]) * Vector3::x();
/// assert!((tool + Vector3::y()).norm() < 1e-12);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct RotaryAxes {
    /// Axes from the base outwards: of two heads the one that carries the other first, and of two tables too.
    pub axes: Vec<RotaryAxis>,
    /// Orientation of the tool where all axes stand at zero, part axes from tool axes.
    pub tool_at_zero: UnitQuaternion<f64>,
}

impl RotaryAxes {
    fn turns(
        &self,
        carries: Carries,
        angles_deg: &[f64],
    ) -> impl Iterator<Item = (&RotaryAxis, f64)> {
        let both = self.axes.iter().zip(angles_deg);
        both.filter(move |(axis, _)| axis.carries == carries)
            .map(|(axis, angle)| (axis, angle.to_radians()))
    }

    /// Motion of the part by the tables from its place at zero, in the axes of the part there, mm.
    #[must_use]
    pub fn part(&self, angles_deg: &[f64]) -> Isometry3<f64> {
        let turns = self.turns(Carries::Part, angles_deg);
        turns.fold(Isometry3::identity(), |all, (axis, angle)| {
            let turn = UnitQuaternion::from_axis_angle(&axis.direction, angle);
            let off = axis.point_mm - turn * axis.point_mm;
            all * Isometry3::from_parts(Translation3::from(off), turn)
        })
    }

    /// Orientation of the tool, axes of the part as it stands then from tool axes.
    #[must_use]
    pub fn tool(&self, angles_deg: &[f64]) -> UnitQuaternion<f64> {
        let turns = self.turns(Carries::Tool, angles_deg);
        let head = turns.fold(UnitQuaternion::identity(), |all, (axis, angle)| {
            all * UnitQuaternion::from_axis_angle(&axis.direction, angle)
        });
        self.part(angles_deg).rotation.inverse() * head * self.tool_at_zero
    }

    /// True if there are tables.
    pub(crate) fn turns_part(&self) -> bool {
        self.axes.iter().any(|axis| axis.carries == Carries::Part)
    }
}

impl RotaryAxes {
    /// The axes from the one that turns all others to the one that turns the tool first, with the directions about which the tool turns
    /// in the part: tables turn the part away below it.
    pub(crate) fn in_order_of_turning(&self) -> (Vec<usize>, Vec<UnitVector3<f64>>) {
        let is_table = |index: &usize| self.axes[*index].carries == Carries::Part;
        let tables = (0..self.axes.len()).rev().filter(is_table);
        let heads = (0..self.axes.len()).filter(|index| !is_table(index));
        let order: Vec<usize> = tables.chain(heads).collect();
        let about = |index: &usize| match is_table(index) {
            true => -self.axes[*index].direction,
            false => self.axes[*index].direction,
        };
        let turning = order.iter().map(about).collect();
        (order, turning)
    }
}

/// Axes whose cross product is smaller turn about one direction.
pub(super) const ONE_AXIS: f64 = 1e-6;

/// Distance of a machine from postures in which a rotary axis turns the tool about itself.
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
