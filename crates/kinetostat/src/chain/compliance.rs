//! Compliance of a chain's end: what exists even where the stiffness is infinite in some directions
//! (a planar chain of rigid links in space) and zero in others (passive joints).

use nalgebra::{DMatrix, DVector, Matrix6, Vector6};

use crate::chain::directions::{Direction, DirectionKind};
use crate::linalg::saddle::column_space;
use crate::spatial::{CartesianStiffness, Twist, Wrench};

/// Compliances below this share of the largest, rotations at the natural length, are rounding.
const NO_MOTION: f64 = 1e-12;

/// Smallest stiffness against a force: the force (N) that moves the tool's origin by 1 m in its softest
/// direction while the tool may turn as it likes. The inverse of the largest eigenvalue of the
/// translational block of the compliance [R 3.13]. Zero if a direction is free, negative if some force
/// moves the tool against itself, infinite if no force moves it.
pub(crate) fn stiffness_against_force(
    symmetric: &Matrix6<f64>,
    directions: &[Direction],
    length: f64,
) -> f64 {
    if directions.iter().any(|d| d.kind == DirectionKind::Free) {
        return 0.0;
    }
    let moves = CartesianCompliance::of(symmetric, directions, length).springs;
    let unit = |i: usize| if i < 3 { 1.0 } else { length };
    let most = Matrix6::from_fn(|i, j| moves[(i, j)] * unit(i) * unit(j)).amax();
    let eigenvalues = moves.fixed_view::<3, 3>(0, 0).symmetric_eigenvalues();
    let (least, largest) = (eigenvalues.min(), eigenvalues.max());
    if least < -NO_MOTION * most {
        1.0 / least
    } else if largest > NO_MOTION * most {
        1.0 / largest
    } else {
        f64::INFINITY
    }
}

/// Parts of a rigid direction (m, rad; its longest part is 1 m) up to this are rounding.
const NO_PART: f64 = 1e-6;

impl CartesianStiffness {
    /// The matrix with NaN in the rows and columns of all coordinate axes that a rigid direction has a part in: a motion
    /// along such an axis is impossible, its stiffness infinite. The other entries do not depend on units. `directions` are
    /// those of this stiffness.
    ///
    /// ```
    /// # use kinetostat::nalgebra::Vector3;
    /// # use kinetostat::*;
    /// # let slide = |axis, stiffness| ActuatorSpec::new(MotionKind::Prismatic, axis, stiffness);
    /// # let table = Chain::builder("table").actuator("x", slide(Vector3::x(), 8e7)).build()?; // N/m
    /// # let table = Mechanism::serial(table, Pose::identity(), Vector3::zeros())?;
    /// let stiffness = table.posture(&Pose::identity())?.stiffness()?;
    /// let entries = stiffness.cartesian.finite_entries(&stiffness.directions);
    /// assert!((entries[(0, 0)] / 8e7 - 1.0).abs() < 1e-12);
    /// assert!(entries[(1, 1)].is_nan(), "nothing moves it across");
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn finite_entries(&self, directions: &[Direction]) -> Matrix6<f64> {
        let rigid = directions.iter().filter(|d| d.kind == DirectionKind::Rigid);
        let locked = rigid.fold([false; 6], |locked, d| {
            std::array::from_fn(|k| locked[k] || d.twist.0[k].abs() > NO_PART)
        });
        Matrix6::from_fn(|i, j| match locked[i] || locked[j] {
            true => f64::NAN,
            false => self.matrix[(i, j)],
        })
    }
}

/// `twist = springs * wrench + any combination of free`, for wrenches that do no work on the free
/// directions. Base axes, at the tip.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct CartesianCompliance {
    /// 6 x 6 (m/N, rad/N, rad/(N m)). Unloaded: `J_theta K_theta^-1 J_theta^T`. Zero along rigid
    /// directions.
    pub springs: Matrix6<f64>,
    /// Motions that nothing resists, each with its longest part 1 m (rotations at the natural
    /// length): a basis.
    pub free: Vec<Twist>,
    /// Motions that the chain cannot make: a basis of what is square to all that it can, rotations
    /// measured at the natural length.
    pub rigid: Vec<Twist>,
    /// The natural length, m: what a rotation is multiplied with to be compared with a translation.
    pub length: f64,
}

impl CartesianCompliance {
    /// Wrenches (N, N m; base axes, at the tip) that move nothing, one for each rigid direction: all reactions of the chain
    /// are combinations of them. The longest part, moments by the natural length, is 1 N.
    #[must_use]
    pub fn constraint_wrenches(&self) -> Vec<Wrench> {
        let square = self.length * self.length;
        let wrench = |t: &Twist| Wrench::new(t.linear(), t.angular() * square);
        self.rigid.iter().map(wrench).collect()
    }

    /// Inverts a stiffness (base axes, at the tip) within those of its principal directions that are neither free nor
    /// rigid: with rotations times `length` (m) and `N` an orthonormal basis of them, `C = N (N^T K N)^-1 N^T`. It is
    /// the inverse of `K` if there are no others.
    pub(crate) fn of(stiffness: &Matrix6<f64>, directions: &[Direction], length: f64) -> Self {
        let unit = |i: usize| if i < 3 { 1.0 } else { length };
        let of_kind = |wanted: DirectionKind| -> Vec<Twist> {
            let own = directions.iter().filter(|d| d.kind == wanted);
            own.map(|d| d.twist).collect()
        };
        let held: Vec<DVector<f64>> = [DirectionKind::Finite, DirectionKind::Negative]
            .into_iter()
            .flat_map(of_kind)
            .map(|t| DVector::from_fn(6, |i, _| t.0[i] * unit(i)))
            .collect();
        let mut springs = Matrix6::zeros();
        let rows = crate::chain::graded::root_rows(directions, length);
        let uneven = crate::chain::graded::spread(directions) > 1e8;
        let symmetric = (stiffness - stiffness.transpose()).amax() <= 1e-9 * stiffness.amax();
        if uneven && symmetric {
            // The matrix has lost its soft directions, the list has not.
            for (sign, row) in rows {
                let v = Vector6::from_fn(|i, _| row[i] / unit(i));
                let moves = v / v.norm_squared();
                let moves = Vector6::from_fn(|i, _| moves[i] / unit(i));
                springs += sign * moves * moves.transpose();
            }
        } else if !held.is_empty() {
            let n = column_space(&DMatrix::from_columns(&held));
            let scaled = DMatrix::from_fn(6, 6, |i, j| stiffness[(i, j)] / (unit(i) * unit(j)));
            if let Some(inverse) = (n.transpose() * scaled * &n).try_inverse() {
                let scaled = &n * inverse * n.transpose();
                springs = Matrix6::from_fn(|i, j| scaled[(i, j)] / (unit(i) * unit(j)));
            }
        }
        Self {
            springs,
            free: of_kind(DirectionKind::Free),
            rigid: of_kind(DirectionKind::Rigid),
            length,
        }
    }

    /// Number of directions with finite stiffness.
    #[must_use]
    pub fn rank(&self) -> usize {
        6 - self.free.len() - self.rigid.len()
    }

    /// Small motion (m, rad) under a wrench (N, N m) at the tip, base axes: that of the springs; add
    /// any free motion. `None` if the wrench pushes in a free direction: then there is no
    /// equilibrium.
    #[must_use]
    pub fn twist_under(&self, wrench: &Wrench) -> Option<Twist> {
        let push = wrench.force().norm() + wrench.moment().norm() / self.length;
        let held = self.free.iter().all(|free| {
            let size = free.linear().norm() + free.angular().norm() * self.length;
            free.dot(wrench).abs() <= 1e-9 * size * push
        });
        held.then(|| Twist(self.springs * wrench.0))
    }
}
