//! At which angles the rotary axes of a machine point its tool in a direction.
//!
//! Two axes are two turns, one after the other: their angles follow from where the cone of the one meets that of the other (the
//! second subproblem of Paden and Kahan; Murray, Li, Sastry, A Mathematical Introduction to Robotic Manipulation, 1994, 3.3).

use nalgebra::{UnitVector3, Vector3};

use crate::number::{larger, smaller};
use crate::path::rotary::{RotaryAxes, RotaryAxis};

/// Directions off by less than this are reached: the last digits of written directions.
const REACHED: f64 = 1e-4;

/// Directions as near as this to an axis do not turn about it.
const ALONG: f64 = 1e-7;

/// Ways that differ by less are equal: the last bits of an angle choose nothing, deg.
const SAME_WAY: f64 = 1e-6;

/// An axis stands within its limits up to this, deg.
const AT_LIMIT: f64 = 1e-6;

/// Reason for which rotary axes cannot point the tool in a direction.
#[derive(Debug, Clone, PartialEq)]
pub enum Unreached {
    /// No angles reach the direction.
    Direction,
    /// Angles, deg, in the order of the axes, that reach it outside the limits of an axis; all others do so, too.
    Limits(Vec<f64>),
}

/// Angles that point the tool in a direction.
#[derive(Debug, Clone)]
pub(crate) struct Pointing {
    pub angles_deg: Vec<f64>,
    /// The axes that need not stand so: the tool lies along them.
    pub free: Vec<bool>,
    /// The sum of the turns from the angles that these are near to, deg.
    pub way: f64,
}

impl RotaryAxes {
    /// The angles at which the tool's axis points in a direction, deg, in the order of the axes; of those that do, the nearest to
    /// others: the sum of the turns counts, and an axis that need not turn stays. `direction` is a unit vector from the tip to the
    /// holder, in axes of the part as it stands then; the tool's axis is along z of the part where all axes stand at zero. No
    /// angles are found for more than two axes.
    ///
    /// ```
    /// use kinetostat_program::{Carries, RotaryAxes, RotaryAxis, Unreached};
    /// use nalgebra::{UnitQuaternion, Vector3};
    ///
    /// let axis = |letter, direction| RotaryAxis {
    ///     letter,
    ///     carries: Carries::Tool,
    ///     direction,
    ///     point_mm: Vector3::zeros(),
    ///     limits_deg: None,
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
    /// // An axis with limits takes the way that lies within them.
    /// let mut limited = axes.clone();
    /// limited.axes[1].limits_deg = Some([-100.0, 10.0]);
    /// let other = limited.angles_towards(&down_y, &[80.0, 0.0]).unwrap();
    /// assert!((other[0] - 270.0).abs() < 1e-9 && (other[1] + 30.0).abs() < 1e-9 || (other[0] + 90.0).abs() < 1e-9);
    /// assert!(limited.angle_outside(&other).is_none() && limited.angle_outside(&[0.0, 20.0]).is_some());
    /// limited.axes[1].limits_deg = Some([-10.0, 10.0]);
    /// assert!(limited.words_of_limits(&[90.0, 30.0]).starts_with("axis B would stand at 30.000 deg"));
    /// assert!(matches!(limited.angles_towards(&down_y, &[80.0, 0.0]), Err(Unreached::Limits(_))));
    /// ```
    ///
    /// # Errors
    /// [`Unreached`] where no angles do that, or none within the limits of the axes.
    pub fn angles_towards(
        &self,
        direction: &Vector3<f64>,
        near_deg: &[f64],
    ) -> Result<Vec<f64>, Unreached> {
        let found = self.pointing(direction, near_deg);
        let nearest = |found: Vec<Pointing>| {
            let by_way = |best: Pointing, other: Pointing| match other.way < best.way - SAME_WAY {
                true => other,
                false => best,
            };
            let best = found.into_iter().reduce(by_way);
            best.map(|pointing| pointing.angles_deg)
        };
        let within = found
            .iter()
            .filter_map(|pointing| self.within_limits_of(pointing));
        match (nearest(within.collect()), nearest(found)) {
            (Some(angles), _) => Ok(angles),
            (None, Some(angles)) => Err(Unreached::Limits(angles)),
            (None, None) => Err(Unreached::Direction),
        }
    }

    /// All angles that point the tool in a direction, each as near as possible to others; whatever the limits.
    pub(crate) fn pointing(&self, direction: &Vector3<f64>, near_deg: &[f64]) -> Vec<Pointing> {
        let (order, turning) = self.in_order_of_turning();
        let near = |index: usize| near_deg.get(index).copied().unwrap_or(0.0);
        let z = Vector3::z();
        let turn = |axis: &UnitVector3<f64>,
                    from: &Vector3<f64>,
                    to: &Vector3<f64>,
                    place: usize| { turn(axis, from, to, near(order[place])) };
        let found: Vec<Vec<Turn>> = match turning.as_slice() {
            [] => vec![Vec::new()],
            [axis] => vec![vec![turn(axis, &z, direction, 0)]],
            [first, second] => {
                let both = |between: &Vector3<f64>| {
                    let away = turn(first, between, direction, 0);
                    vec![away, turn(second, &z, between, 1)]
                };
                let meet = meeting(first, second, direction, &z);
                meet.iter().flatten().map(both).collect()
            }
            _ => Vec::new(),
        };
        let placed = found.into_iter().map(|turns| {
            let mut pointing = Pointing {
                angles_deg: vec![0.0; order.len()],
                free: vec![false; order.len()],
                way: 0.0,
            };
            for (index, turn) in order.iter().zip(turns) {
                pointing.angles_deg[*index] = turn.angle_deg;
                pointing.free[*index] = turn.free;
                pointing.way += (turn.angle_deg - near(*index)).abs();
            }
            pointing
        });
        let reaches = |pointing: &Pointing| {
            let points = self.tool(&pointing.angles_deg) * (self.tool_at_zero.inverse() * z);
            (points - direction).norm() < REACHED
        };
        placed.filter(reaches).collect()
    }

    /// Moves the solution into the limits of the axes: by full turns, or freely for an axis that need not turn.
    fn within_limits_of(&self, pointing: &Pointing) -> Option<Pointing> {
        let mut within = pointing.clone();
        for (index, axis) in self.axes.iter().enumerate() {
            let Some([least, largest]) = axis.limits_deg else {
                continue;
            };
            let own = pointing.angles_deg[index];
            let angle = match pointing.free[index] {
                true => larger(least, smaller(largest, own)),
                false if own < least - AT_LIMIT => {
                    own + 360.0 * ((least - AT_LIMIT - own) / 360.0).ceil()
                }
                false if own > largest + AT_LIMIT => {
                    own - 360.0 * ((own - largest - AT_LIMIT) / 360.0).ceil()
                }
                false => own,
            };
            if angle < least - AT_LIMIT || angle > largest + AT_LIMIT {
                return None;
            }
            within.way += (angle - own).abs();
            within.angles_deg[index] = angle;
        }
        Some(within)
    }

    /// The first axis that stands outside its limits, with these.
    #[must_use]
    pub fn angle_outside(&self, angles_deg: &[f64]) -> Option<(&RotaryAxis, f64)> {
        let mut both = self.axes.iter().zip(angles_deg);
        both.find_map(|(axis, angle)| {
            let [least, largest] = axis.limits_deg?;
            let inside = (least - AT_LIMIT..=largest + AT_LIMIT).contains(angle);
            (!inside).then_some((axis, *angle))
        })
    }

    /// Text with all angles and the axis that would leave its limits there.
    #[must_use]
    pub fn words_of_limits(&self, angles_deg: &[f64]) -> String {
        let each = self.axes.iter().zip(angles_deg);
        let stand: Vec<String> = each
            .map(|(axis, angle)| format!("{}{angle:.3}", axis.letter))
            .collect();
        let stand = stand.join(" ");
        match self.angle_outside(angles_deg) {
            Some((axis, angle)) => {
                let [least, largest] = axis.limits_deg.unwrap_or_default();
                format!(
                    "axis {} would stand at {angle:.3} deg, and it reaches {least} to {largest} deg (nearest angles: {stand})",
                    axis.letter
                )
            }
            None => format!("the axes stand within their limits ({stand})"),
        }
    }
}

/// The angle of one axis.
struct Turn {
    angle_deg: f64,
    /// The direction lies along the axis: any angle would do.
    free: bool,
}

/// The angle by which a direction turns about an axis to another one, next to one that is near; that one where it need not.
fn turn(axis: &UnitVector3<f64>, from: &Vector3<f64>, to: &Vector3<f64>, near: f64) -> Turn {
    let across = |v: &Vector3<f64>| v - axis.into_inner() * axis.dot(v);
    let (from, to) = (across(from), across(to));
    if from.norm() < ALONG || to.norm() < ALONG {
        return Turn {
            angle_deg: near,
            free: true,
        };
    }
    let angle = axis.dot(&from.cross(&to)).atan2(from.dot(&to)).to_degrees();
    Turn {
        angle_deg: angle + 360.0 * ((near - angle) / 360.0).round(),
        free: false,
    }
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
