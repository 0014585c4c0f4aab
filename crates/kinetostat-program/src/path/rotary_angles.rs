//! At which angles the rotary axes of a machine point its tool in a direction.
//!
//! Two axes are two turns, one after the other: their angles follow from where the cone of the one meets that of the other (the
//! second subproblem of Paden and Kahan; Murray, Li, Sastry, A Mathematical Introduction to Robotic Manipulation, 1994, 3.3).

use nalgebra::{UnitVector3, Vector3};

use crate::path::rotary::{Carries, RotaryAxes};

/// Directions off by less than this are reached: the last digits of written directions.
const REACHED: f64 = 1e-4;

/// Directions as near as this to an axis do not turn about it.
const ALONG: f64 = 1e-7;

impl RotaryAxes {
    /// The angles at which the tool's axis points in a direction, deg, in the order of the axes; of those that do, the nearest to
    /// others: the sum of the turns counts, and an axis that need not turn stays. `direction` is a unit vector from the tip to the
    /// holder, in axes of the part as it stands then; the tool's axis is along z of the part where all axes stand at zero.
    ///
    /// `None` where the axes do not reach it, and of more than two axes.
    ///
    /// ```
    /// use kinetostat_program::{Carries, RotaryAxes, RotaryAxis};
    /// use nalgebra::{UnitQuaternion, Vector3};
    ///
    /// let axis = |letter, direction| RotaryAxis {
    ///     letter,
    ///     carries: Carries::Tool,
    ///     direction,
    ///     point_mm: Vector3::zeros(),
    /// };
    /// // A fork head: B on C.
    /// let axes = RotaryAxes {
    ///     axes: vec![axis('C', Vector3::z_axis()), axis('B', Vector3::y_axis())],
    ///     tool_at_zero: UnitQuaternion::identity(),
    /// };
    /// let down_y = Vector3::new(0.0, 0.5, 0.75_f64.sqrt());
    /// let near = axes.angles_towards(&down_y, &[80.0, 0.0]).unwrap();
    /// assert!((near[0] - 90.0).abs() < 1e-9 && (near[1] - 30.0).abs() < 1e-9);
    /// // The other way to the same direction.
    /// let near = axes.angles_towards(&down_y, &[-80.0, 0.0]).unwrap();
    /// assert!((near[0] + 90.0).abs() < 1e-9 && (near[1] + 30.0).abs() < 1e-9);
    /// // Along z axis C need not turn.
    /// let near = axes.angles_towards(&Vector3::z(), &[33.0, 5.0]).unwrap();
    /// assert!((near[0] - 33.0).abs() < 1e-9 && near[1].abs() < 1e-9);
    /// ```
    #[must_use]
    pub fn angles_towards(&self, direction: &Vector3<f64>, near_deg: &[f64]) -> Option<Vec<f64>> {
        // From the part outwards: tables turn the part away below the tool.
        let tables = (0..self.axes.len()).rev().filter(|i| self.is_table(*i));
        let heads = (0..self.axes.len()).filter(|i| !self.is_table(*i));
        let order: Vec<usize> = tables.chain(heads).collect();
        let turning: Vec<UnitVector3<f64>> = (order.iter())
            .map(|index| match self.is_table(*index) {
                true => -self.axes[*index].direction,
                false => self.axes[*index].direction,
            })
            .collect();
        let near: Vec<f64> = order
            .iter()
            .map(|index| near_deg.get(*index).copied().unwrap_or(0.0))
            .collect();
        let z = Vector3::z();
        let found: Vec<Vec<f64>> = match (turning.as_slice(), near.as_slice()) {
            ([], _) => vec![Vec::new()],
            ([axis], [near]) => vec![vec![turn(axis, &z, direction, *near)]],
            ([first, second], [near_first, near_second]) => {
                let meet = meeting(first, second, direction, &z)?;
                let both = |between: &Vector3<f64>| {
                    let first = turn(first, between, direction, *near_first);
                    vec![first, turn(second, &z, between, *near_second)]
                };
                meet.iter().map(both).collect()
            }
            _ => return None,
        };
        let away = |angles: &Vec<f64>| -> f64 {
            let both = angles.iter().zip(&near);
            both.map(|(angle, near)| (angle - near).abs()).sum()
        };
        let best = found
            .into_iter()
            .min_by(|a, b| away(a).total_cmp(&away(b)))?;
        let mut angles = vec![0.0; self.axes.len()];
        for (index, angle) in order.iter().zip(best) {
            angles[*index] = angle;
        }
        let points = self.tool(&angles) * (self.tool_at_zero.inverse() * z);
        ((points - direction).norm() < REACHED).then_some(angles)
    }

    fn is_table(&self, index: usize) -> bool {
        self.axes[index].carries == Carries::Part
    }
}

/// The angle by which a direction turns about an axis to another one, deg, next to one that is near; that one where it need not.
fn turn(axis: &UnitVector3<f64>, from: &Vector3<f64>, to: &Vector3<f64>, near: f64) -> f64 {
    let across = |v: &Vector3<f64>| v - axis.into_inner() * axis.dot(v);
    let (from, to) = (across(from), across(to));
    if from.norm() < ALONG || to.norm() < ALONG {
        return near;
    }
    let angle = axis.dot(&from.cross(&to)).atan2(from.dot(&to)).to_degrees();
    angle + 360.0 * ((near - angle) / 360.0).round()
}

/// The directions that turn about the first axis to one direction and about the second from another; none where these cones miss
/// each other.
fn meeting(
    first: &UnitVector3<f64>,
    second: &UnitVector3<f64>,
    to: &Vector3<f64>,
    from: &Vector3<f64>,
) -> Option<[Vector3<f64>; 2]> {
    let cosine = first.dot(second);
    let square = 1.0 - cosine * cosine;
    if square < ALONG {
        return None;
    }
    let (along_first, along_second) = (first.dot(to), second.dot(from));
    let x = (along_first - cosine * along_second) / square;
    let y = (along_second - cosine * along_first) / square;
    let flat = first.into_inner() * x + second.into_inner() * y;
    let rest = 1.0 - flat.norm_squared();
    if rest < -REACHED {
        return None;
    }
    let across = first.cross(second) * (rest.max(0.0) / square).sqrt();
    Some([flat + across, flat - across].map(|v| v.normalize()))
}
