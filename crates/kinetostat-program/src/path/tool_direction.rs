//! The rule from a direction of the tool to the angles of rotary axes.
//!
//! Takes a direction in the part, gives the angles nearest to others at which the tool lies along it. The turn about the tool is
//! free. If two axes turn the tool about nearly the same direction (the pole: the tool lies along an axis) the direction is not
//! followed across it, and the angles stay. The closed form of [`crate::path::rotary_angles`] finds all angles of a direction
//! that a program states; this rule serves corrections: small turns from the present angles, of any number of axes, and
//! rotations that they cannot make are left.

use nalgebra::{DMatrix, DVector, Vector3};

use crate::path::rotary::RotaryAxes;

/// Change of an angle over which directions are compared, rad: the difference is central.
const STEP: f64 = 1e-4;

/// The tool turns by less than this share of an angle where it is near the pole: 2 degrees beside it.
const POLE: f64 = 0.035;

/// And by less than this where it is at the pole: 1 degree.
const AT_POLE: f64 = 0.5 * POLE;

/// Steps of Newton's iteration.
const STEPS: usize = 30;

/// Largest change of an angle in one step, rad.
const STRIDE: f64 = 0.5;

/// Directions that differ by less are the same, rad.
const SAME: f64 = 1e-12;

/// Angles of rotary axes for a direction of the tool.
#[derive(Debug, Clone, PartialEq)]
pub struct Directed {
    /// Angles of the axes, in their order, deg.
    pub angles_deg: Vec<f64>,
    /// Angle between the tool and the direction that is left, rad.
    pub left_rad: f64,
    /// The tool lies near an axis there: a turn of the tool across it asks for large turns of the axes, and is not made.
    pub at_pole: bool,
}

impl RotaryAxes {
    /// Direction of the tool, from its tip to its holder, axes of the part as it stands then: `tool_axis` in axes of the tool.
    #[must_use]
    pub fn tool_direction_at(&self, angles_deg: &[f64], tool_axis: &Vector3<f64>) -> Vector3<f64> {
        self.tool(angles_deg) * tool_axis
    }

    /// Rotations of the axes, in rad, that turn the tool from its direction by a small vector across it, and whether it is near
    /// the pole. Least squares: rotations that the axes cannot make are left out, and so are those that need large angles.
    #[must_use]
    pub fn turns_for(
        &self,
        angles_deg: &[f64],
        tool_axis: &Vector3<f64>,
        across: &Vector3<f64>,
    ) -> (Vec<f64>, bool) {
        let slopes = self.slopes(angles_deg, tool_axis);
        let along = slopes.tr_mul(across);
        let mut turns = DVector::zeros(slopes.ncols());
        let (mut free, needed) = (0, 2.min(slopes.ncols()));
        for (size, direction) in principal(&slopes) {
            free += usize::from(size > POLE);
            if size > AT_POLE {
                turns += &direction * (direction.dot(&along) / (size * size));
            }
        }
        (turns.iter().copied().collect(), free < needed)
    }

    /// Rotations reduced by those that turn the axes near the pole: all of it 2 degrees beside it, nothing at 1 degree and nearer,
    /// so that they begin gradually.
    #[must_use]
    pub fn gradual_turns(
        &self,
        angles_deg: &[f64],
        tool_axis: &Vector3<f64>,
        turns: &[f64],
    ) -> Vec<f64> {
        let mut kept = DVector::from_column_slice(turns);
        for (size, direction) in principal(&self.slopes(angles_deg, tool_axis)) {
            let part = ((size - AT_POLE) / (POLE - AT_POLE)).clamp(0.0, 1.0);
            kept -= &direction * (direction.dot(&kept) * (1.0 - part));
        }
        kept.iter().copied().collect()
    }

    /// Jacobian of the tool's direction, one column for each angle.
    fn slopes(&self, angles_deg: &[f64], tool_axis: &Vector3<f64>) -> DMatrix<f64> {
        let mut slopes = DMatrix::zeros(3, angles_deg.len());
        let mut angles = angles_deg.to_vec();
        for index in 0..angles.len() {
            let own = angles[index];
            angles[index] = own + STEP.to_degrees();
            let above = self.tool_direction_at(&angles, tool_axis);
            angles[index] = own - STEP.to_degrees();
            let below = self.tool_direction_at(&angles, tool_axis);
            angles[index] = own;
            slopes.set_column(index, &((above - below) / (2.0 * STEP)));
        }
        slopes
    }

    /// The angles nearest to others at which the tool lies along a direction in the part; `tool_axis` is its own, from its tip to its
    /// holder, in axes of the tool.
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
    /// let z = Vector3::z();
    /// // Rz(90) Rx(30) z, by hand.
    /// let wanted = Vector3::new(0.5, 0.0, 0.75_f64.sqrt());
    /// let found = fork.angles_near(&wanted, &z, &[80.0, 20.0]);
    /// assert!((found.angles_deg[0] - 90.0).abs() < 1e-9 && (found.angles_deg[1] - 30.0).abs() < 1e-9);
    /// assert!(found.left_rad < 1e-11 && !found.at_pole);
    /// assert!((fork.tool_direction_at(&found.angles_deg, &z) - wanted).norm() < 1e-11);
    /// // Upright, C turns nothing: a tilt to the side that A cannot give is left.
    /// let beside = fork.angles_near(&Vector3::new(1e-3, 0.0, 1.0), &z, &[0.0, 0.0]);
    /// assert!(beside.at_pole && beside.angles_deg[0].abs() < 1e-9);
    /// assert!((beside.left_rad - 1e-3).abs() < 1e-6);
    /// // How A and C must turn for a small turn of the tool towards x.
    /// let (turns, _) = fork.turns_for(&[90.0, 30.0], &z, &Vector3::new(0.0, 1e-3, 0.0));
    /// assert!((turns[0] - 2e-3).abs() < 1e-9 && turns[1].abs() < 1e-9);
    /// // 1.5 degrees beside the pole half of the turn of C is made.
    /// let half = fork.gradual_turns(&[0.0, 1.5], &z, &[1.0, 0.0])[0];
    /// assert!((half - 0.5).abs() < 0.01, "{half}");
    /// ```
    #[must_use]
    pub fn angles_near(
        &self,
        direction: &Vector3<f64>,
        tool_axis: &Vector3<f64>,
        near_deg: &[f64],
    ) -> Directed {
        let mut angles_deg = near_deg.to_vec();
        let wanted = direction.try_normalize(0.0).unwrap_or_else(Vector3::z);
        let mut at_pole = false;
        for _ in 0..STEPS {
            let now = self.tool_direction_at(&angles_deg, tool_axis);
            let across = turn_between(&now, &wanted).cross(&now);
            if across.norm() < SAME {
                break;
            }
            let (turns, pole) = self.turns_for(&angles_deg, tool_axis, &across);
            at_pole = pole;
            let largest = turns.iter().fold(0.0, |most, turn: &f64| {
                crate::number::larger(most, turn.abs())
            });
            if largest < SAME {
                break;
            }
            let part = crate::number::smaller(1.0, STRIDE / largest);
            for (angle, turn) in angles_deg.iter_mut().zip(&turns) {
                *angle += (turn * part).to_degrees();
            }
        }
        let reached = self.tool_direction_at(&angles_deg, tool_axis);
        Directed {
            left_rad: reached.cross(&wanted).norm().atan2(reached.dot(&wanted)),
            angles_deg,
            at_pole,
        }
    }
}

/// Rotation vector of the smallest turn from one direction to another; half a turn has none of its own.
fn turn_between(from: &Vector3<f64>, to: &Vector3<f64>) -> Vector3<f64> {
    let about = from.cross(to);
    let (sine, cosine) = (about.norm(), from.dot(to));
    match about.try_normalize(0.0) {
        Some(axis) => axis * sine.atan2(cosine),
        None if cosine > 0.0 => Vector3::zeros(),
        None => {
            let any = from.cross(&Vector3::new(0.31, -0.52, 0.79)).normalize();
            any * std::f64::consts::PI
        }
    }
}

/// Sweeps of Jacobi's rotations: of so few angles five are enough.
const SWEEPS: usize = 30;

/// Combinations of angles that turn the tool in directions across each other, with how far: singular values and right singular
/// vectors of the slopes, from the eigenvectors of their normal matrix by Jacobi's rotations.
fn principal(slopes: &DMatrix<f64>) -> Vec<(f64, DVector<f64>)> {
    let count = slopes.ncols();
    let mut normal = slopes.tr_mul(slopes);
    let mut vectors = DMatrix::identity(count, count);
    let pairs = || (0..count).flat_map(|p| (p + 1..count).map(move |q| (p, q)));
    for _ in 0..SWEEPS {
        for (p, q) in pairs() {
            let beside: f64 = normal[(p, q)];
            if beside.abs() < f64::MIN_POSITIVE {
                continue;
            }
            let half = (normal[(q, q)] - normal[(p, p)]) / (2.0 * beside);
            let tangent = half.signum() / (half.abs() + half.hypot(1.0));
            let cosine = 1.0 / tangent.hypot(1.0);
            let mut turn = DMatrix::identity(count, count);
            (turn[(p, p)], turn[(q, q)]) = (cosine, cosine);
            (turn[(p, q)], turn[(q, p)]) = (tangent * cosine, -tangent * cosine);
            normal = turn.transpose() * normal * &turn;
            vectors *= &turn;
        }
    }
    let each = (0..count).map(|k| {
        let size = crate::number::larger(normal[(k, k)], 0.0).sqrt();
        (size, vectors.column(k).into_owned())
    });
    each.collect()
}
