//! Poses, twists, wrenches and 6 x 6 stiffness matrices at a stated point, in stated axes.
//!
//! Conventions, everywhere in this crate: SI units (m, rad, N, N m); linear part first; axes of
//! the base unless a name says otherwise; rotations live on SO(3) and are compared by their
//! rotation vector, never by Euler angles. A [`Wrench`] is what the environment applies to the
//! body, so that `wrench = stiffness * twist` for a small motion.

use std::iter::Sum;
use std::ops::{Add, AddAssign, Mul, Neg, Sub, SubAssign};

use nalgebra::{Isometry3, Matrix3, Matrix6, Rotation3, UnitQuaternion, Vector3, Vector6};
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

pub use directions::Directions;

mod directions;

/// Position (m) and orientation of one frame in another; `base_from_tip` maps tip coordinates to
/// base coordinates.
pub type Pose = Isometry3<f64>;

/// Cross-product matrix: `hat(a) * b = a x b`.
#[must_use]
pub fn hat(a: &Vector3<f64>) -> Matrix3<f64> {
    a.cross_matrix()
}

/// Small motion of a body, `[dp; dpsi]`: linear part (m) of the reference point and spatial
/// rotation vector (rad), both in base axes.
///
/// # Examples
///
/// ```
/// # use kinetostat::nalgebra::vector;
/// # use kinetostat::*;
/// let motion = Twist::new(vector![1e-3, -2e-3, 5e-4], vector![0.01, 0.02, -0.03]); // m, rad
/// let load = Wrench::new(vector![120.0, -40.0, 75.0], vector![3.0, -1.5, 2.0]); // N, N m
/// let work = motion.dot(&load); // J
/// let by_hand = motion.linear().dot(&load.force()) + motion.angular().dot(&load.moment());
/// assert!((work - by_hand).abs() < 1e-15);
/// // Work asks neither at which point nor in which axes motion and load are written down.
/// let arm = vector![0.2, -0.1, 0.4]; // m
/// assert!((motion.shifted(&arm).dot(&load.shifted(&arm)) - work).abs() < 1e-15);
/// let turn = nalgebra::Rotation3::from_euler_angles(0.3, -0.7, 1.1);
/// assert!((motion.rotated(&turn).dot(&load.rotated(&turn)) - work).abs() < 1e-15);
/// // A turn about z moves a point on the x axis along y, by the arm times the angle.
/// let turned = Twist::new(vector![0.0, 0.0, 0.0], vector![0.0, 0.0, 0.01]);
/// assert_eq!(turned.shifted(&vector![0.5, 0.0, 0.0]).linear(), vector![0.0, 0.005, 0.0]);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Twist(#[cfg_attr(feature = "schema", schemars(with = "[f64; 6]"))] pub Vector6<f64>);

/// Load on a body, `[f; m]`: force (N) and moment (N m) about the reference point, both in base
/// axes, applied by the environment to the body.
///
/// # Examples
///
/// ```
/// # use kinetostat::nalgebra::vector;
/// # use kinetostat::*;
/// let cut = Wrench::new(vector![0.0, -200.0, 50.0], vector![0.0, 0.0, 0.0]); // N, N m, at the tool's point
/// let tool = vector![0.3, 0.1, -0.2]; // m, from the flange
/// let on_flange = cut.shifted(&-tool);
/// assert_eq!(on_flange.force(), cut.force());
/// assert_eq!(on_flange.moment(), vector![-35.0, -15.0, -60.0], "arm times force");
/// assert_eq!(on_flange - on_flange, Wrench::zero());
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct Wrench(pub Vector6<f64>);

macro_rules! six_vector {
    ($name:ident, $linear:ident, $angular:ident) => {
        impl $name {
            /// Creates it from the linear and the angular part.
            #[must_use]
            pub fn new($linear: Vector3<f64>, $angular: Vector3<f64>) -> Self {
                let mut vector = Vector6::zeros();
                vector.fixed_rows_mut::<3>(0).copy_from(&$linear);
                vector.fixed_rows_mut::<3>(3).copy_from(&$angular);
                Self(vector)
            }

            /// All components zero.
            #[must_use]
            pub fn zero() -> Self {
                Self(Vector6::zeros())
            }

            /// First three components.
            #[must_use]
            pub fn $linear(&self) -> Vector3<f64> {
                self.0.fixed_rows::<3>(0).into_owned()
            }

            /// Last three components.
            #[must_use]
            pub fn $angular(&self) -> Vector3<f64> {
                self.0.fixed_rows::<3>(3).into_owned()
            }

            /// Expresses the quantity in axes turned by `rotation` (`new = rotation * old`).
            #[must_use]
            pub fn rotated(&self, rotation: &Rotation3<f64>) -> Self {
                Self::new(rotation * self.$linear(), rotation * self.$angular())
            }
        }
    };
}
six_vector!(Twist, linear, angular);
six_vector!(Wrench, force, moment);

impl Twist {
    /// Motion of the point that lies at `arm` (m) from the present reference point.
    #[must_use]
    pub fn shifted(&self, arm: &Vector3<f64>) -> Self {
        Self::new(self.linear() + self.angular().cross(arm), self.angular())
    }

    /// Work (J) done by a wrench at the same reference point.
    #[must_use]
    pub fn dot(&self, wrench: &Wrench) -> f64 {
        self.0.dot(&wrench.0)
    }
}

impl Wrench {
    /// Expresses the load about the point that lies at `arm` (m) from the present reference point.
    #[must_use]
    pub fn shifted(&self, arm: &Vector3<f64>) -> Self {
        Self::new(self.force(), self.moment() - arm.cross(&self.force()))
    }
}

/// `T = [I, -hat(arm); 0, I]`, 6 x 6: twist of the reference point -> twist of the point at `arm`.
/// Its transpose takes a wrench at that point back to the reference point.
#[must_use]
pub fn shift_matrix(arm: &Vector3<f64>) -> Matrix6<f64> {
    let mut shift = Matrix6::identity();
    shift.fixed_view_mut::<3, 3>(0, 3).copy_from(&(-hat(arm)));
    shift
}

/// `blkdiag(rotation, rotation)`, 6 x 6.
#[must_use]
pub fn turn_matrix(rotation: &Rotation3<f64>) -> Matrix6<f64> {
    let mut turn = Matrix6::zeros();
    turn.fixed_view_mut::<3, 3>(0, 0)
        .copy_from(rotation.matrix());
    turn.fixed_view_mut::<3, 3>(3, 3)
        .copy_from(rotation.matrix());
    turn
}

/// `blkdiag(0, block)`, 6 x 6: a matrix that acts on rotations only.
#[must_use]
pub(crate) fn rotational(block: &Matrix3<f64>) -> Matrix6<f64> {
    let mut matrix = Matrix6::zeros();
    matrix.fixed_view_mut::<3, 3>(3, 3).copy_from(block);
    matrix
}

/// Motion that takes `actual` to `target`: `[p* - p; log(R* R^T)]`, base axes, at the frame's
/// origin. The linearised closure `J dx = pose_residual` is exact to first order; Euler angles
/// are never subtracted.
#[must_use]
pub fn pose_residual(target: &Pose, actual: &Pose) -> Twist {
    Twist::new(
        target.translation.vector - actual.translation.vector,
        (target.rotation * actual.rotation.inverse()).scaled_axis(),
    )
}

/// `pose` moved by a twist at its own origin: translated by the linear part, turned by the
/// exponential of the angular part (base axes).
#[must_use]
pub fn moved(pose: &Pose, twist: &Twist) -> Pose {
    Pose::from_parts(
        (pose.translation.vector + twist.linear()).into(),
        UnitQuaternion::from_scaled_axis(twist.angular()) * pose.rotation,
    )
}

/// Stiffness of a platform or a chain's end: 6 x 6, `wrench = matrix * twist`, blocks N/m, N/rad,
/// N m/m, N m/rad, base axes, at the stated point.
///
/// Under a load with a moment `m` it is not symmetric: `K - K^T = blkdiag(0, -hat(m))` exactly,
/// unless dead moments act on inner nodes or loads are not conservative.
/// [`Self::symmetric`] is the Hessian of the stored energy in exponential coordinates.
///
/// # Examples
///
/// ```
/// # use kinetostat::nalgebra::vector;
/// # use kinetostat::*;
/// let bar = BeamSection::tube(2.1e11, 8.1e10, 0.04, 0.0); // Pa, m
/// let (length, arm) = (0.5, vector![0.2, 0.0, 0.0]); // m: a rigid tool sits on the end of the bar
/// let end = CartesianStiffness { matrix: bar.cantilever(length)? };
/// let tool = end.shifted(&-arm, &Wrench::zero());
/// // The bar bends under the force and under its moment: ((L + a)^3 - a^3) / 3 E I.
/// let bending = ((length + arm.x).powi(3) - arm.x.powi(3)) / (3.0 * 2.1e11 * bar.second_moment_z);
/// let compliance = tool.compliance().expect("a clamped bar holds its end");
/// assert!((compliance[(1, 1)] / bending - 1.0).abs() < 1e-9);
/// // A round bar is as stiff in axes turned about it.
/// let turn = nalgebra::Rotation3::from_axis_angle(&nalgebra::Vector3::x_axis(), 0.7);
/// assert!((tool.rotated(&turn).matrix - tool.matrix).amax() < 1e-12 * tool.matrix.amax());
/// // Under a force on the end its moment about the tool's point is what makes the matrix lopsided.
/// let load = Wrench::new(vector![300.0, -500.0, 200.0], vector![0.0, 0.0, 0.0]); // N, N m
/// let loaded = end.shifted(&-arm, &load);
/// let lopsided = (loaded.matrix - loaded.matrix.transpose()).fixed_view::<3, 3>(3, 3).into_owned();
/// let moment = load.shifted(&arm).moment(); // about the tool's point
/// assert!((lopsided + spatial::hat(&moment)).amax() < 1e-6);
/// assert!((loaded.symmetric() - loaded.symmetric().transpose()).amax() == 0.0);
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct CartesianStiffness {
    /// The matrix as it is (N/m, N/rad, N m/m, N m/rad).
    pub matrix: Matrix6<f64>,
}

impl CartesianStiffness {
    /// The symmetric part: Hessian of the stored energy in exponential coordinates about the
    /// present pose.
    #[must_use]
    pub fn symmetric(&self) -> Matrix6<f64> {
        0.5 * (self.matrix + self.matrix.transpose())
    }

    /// Stiffness of the same body at the reference point from which this matrix's point lies at
    /// `arm`, while `wrench` acts there: `T^T K T + blkdiag(0, hat(f) hat(arm))`. The second term
    /// survives whenever a force acts (missing in [R 5.28], see the errata).
    #[must_use]
    pub fn shifted(&self, arm: &Vector3<f64>, wrench: &Wrench) -> Self {
        let shift = shift_matrix(arm);
        let geometric = rotational(&(hat(&wrench.force()) * hat(arm)));
        Self {
            matrix: shift.transpose() * self.matrix * shift + geometric,
        }
    }

    /// Expresses the stiffness in axes turned by `rotation`.
    #[must_use]
    pub fn rotated(&self, rotation: &Rotation3<f64>) -> Self {
        let turn = turn_matrix(rotation);
        Self {
            matrix: turn * self.matrix * turn.transpose(),
        }
    }

    /// `K^-1`, or `None` where the matrix is singular (free directions exist).
    #[must_use]
    pub fn compliance(&self) -> Option<Matrix6<f64>> {
        let inverse = self.matrix.try_inverse()?;
        inverse.iter().all(|x| x.is_finite()).then_some(inverse)
    }
}

/// The pose at a share of the screw motion that leads from one pose to another.
pub(crate) fn on_screw(from: &Pose, to: &Pose, share: f64) -> Pose {
    let relative = from.inverse() * to;
    let turn = relative.rotation.scaled_axis();
    // The place reached on a screw of rotation `w` and speed `u` in the moving frame is `V(w) u`.
    let reach = |w: &Vector3<f64>| {
        let (angle, hat) = (w.norm(), hat(w));
        let (first, second) = if angle < 1e-4 {
            (
                0.5 - angle * angle / 24.0,
                1.0 / 6.0 - angle * angle / 120.0,
            )
        } else {
            let square = angle * angle;
            (
                (1.0 - angle.cos()) / square,
                (angle - angle.sin()) / (square * angle),
            )
        };
        Matrix3::identity() + hat * first + hat * hat * second
    };
    let place = relative.translation.vector;
    let speed = reach(&turn)
        .try_inverse()
        .map_or(place, |inverse| inverse * place);
    let part = turn * share;
    let there = reach(&part) * (speed * share);
    from * Pose::from_parts(there.into(), UnitQuaternion::from_scaled_axis(part))
}

/// Translation along, or rotation about, an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum MotionKind {
    /// Translation, m.
    Prismatic,
    /// Rotation, rad.
    Revolute,
}

/// `d log(E exp(hat(w)))/dw` at `w = 0`, for `log E = e`.
pub(crate) fn rotation_rate(e: &Vector3<f64>) -> Matrix3<f64> {
    let angle = e.norm();
    let second = if angle < 1e-4 {
        1.0 / 12.0
    } else {
        1.0 / (angle * angle) - 1.0 / (2.0 * angle * (0.5 * angle).tan())
    };
    Matrix3::identity() + 0.5 * hat(e) + second * hat(e) * hat(e)
}

macro_rules! linear_space {
    ($name:ident) => {
        impl Add for $name {
            type Output = Self;
            fn add(self, other: Self) -> Self {
                Self(self.0 + other.0)
            }
        }

        impl AddAssign for $name {
            fn add_assign(&mut self, other: Self) {
                self.0 += other.0;
            }
        }

        impl Sub for $name {
            type Output = Self;
            fn sub(self, other: Self) -> Self {
                Self(self.0 - other.0)
            }
        }

        impl SubAssign for $name {
            fn sub_assign(&mut self, other: Self) {
                self.0 -= other.0;
            }
        }

        impl Neg for $name {
            type Output = Self;
            fn neg(self) -> Self {
                Self(-self.0)
            }
        }

        impl Mul<f64> for $name {
            type Output = Self;
            fn mul(self, factor: f64) -> Self {
                Self(self.0 * factor)
            }
        }

        impl Mul<$name> for f64 {
            type Output = $name;
            fn mul(self, vector: $name) -> $name {
                vector * self
            }
        }

        impl Sum for $name {
            fn sum<I: Iterator<Item = Self>>(iter: I) -> Self {
                iter.fold(Self::zero(), Add::add)
            }
        }
    };
}

linear_space!(Twist);
linear_space!(Wrench);

impl Mul<Twist> for CartesianStiffness {
    type Output = Wrench;
    /// The wrench that a small motion meets.
    fn mul(self, twist: Twist) -> Wrench {
        Wrench(self.matrix * twist.0)
    }
}
