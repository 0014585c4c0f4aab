//! The stiffness of a chain, three ways: block inverse [R 3.7, 4.27], closed form [R 3.10, 4.28]
//! and recursion over passive joints [R 3.11, 3.16], with the conditions of each.
//!
//! [`crate::unloaded_stiffness`] and [`crate::Equilibrium`] need none of these conditions: they
//! solve the bordered system [R 4.26]. The forms here are for those who check, teach or simplify.

use nalgebra::{DMatrix, Matrix6, Vector6};

use crate::linalg::complement::complement;
use crate::linalg::saddle::{RANK_TOLERANCE, Saddle, column_space};
use crate::reference::chain_blocks::{Applied, ChainBlocks, Inapplicable, regular_inverse};
use crate::reference::passive_rules::eliminated;

impl std::fmt::Display for Inapplicable {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::SpringsDoNotReach(rank) => write!(
                f,
                "the springs alone move the end in {rank} of 6 directions, so the stiffness without passive joints is infinite in others"
            ),
            Self::RedundantPassiveJoints(names) => {
                write!(f, "passive joints are redundant: {}", names.join(", "))
            }
            Self::SpringsAreSpent => write!(f, "the load cancels the stiffness of the springs"),
            Self::PassiveJointsUndecided(names) => write!(
                f,
                "passive joints can move while the end is held: {}",
                names.join(", ")
            ),
            Self::NotAnOrder(count) => write!(
                f,
                "the order must name each of the {count} passive joints at most once"
            ),
            Self::Loaded => write!(
                f,
                "the form holds for the unloaded chain, this one is loaded"
            ),
        }
    }
}

/// A loaded stiffness by [R 4.28-4.30], base axes, at the tip.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct LoadedClosedForm {
    /// `K_C` [R 4.28].
    pub cartesian: Matrix6<f64>,
    /// `K_Cq`, n_q x 6 [R 4.29].
    pub passive: DMatrix<f64>,
    /// `K_Ctheta`, n_theta x 6 [R 4.30].
    pub springs: DMatrix<f64>,
}

/// A stiffness by recursion over passive joints.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Recursion {
    /// `K_C` with the joints of the order freed.
    pub matrix: Matrix6<f64>,
    /// Pivot `mu = J^T K J` of every step (N/m or N m/rad).
    pub pivots: Vec<f64>,
    /// Names of joints that changed nothing, because what they free was free already.
    pub skipped: Vec<String>,
}

impl ChainBlocks {
    /// Upper left 6 x 6 block of the inverse of
    /// `[J_theta k J_theta^T, J_q + J_theta k H_thetaq; J_q^T + H_qtheta k J_theta^T, H_qq + H_qtheta k H_thetaq]`
    /// [R 4.27], which is [R 3.7] for the unloaded chain. Redundant joints and rigid directions get
    /// the least-norm answer, zero along what the chain cannot do.
    ///
    /// # Errors
    /// [`Inapplicable::SpringsAreSpent`].
    pub fn block_inverse(&self) -> Applied<Matrix6<f64>> {
        let (k, n) = (self.spring_compliance()?, self.joints.len());
        let (right, left) = self.couplings(&k);
        let mut a = DMatrix::zeros(6 + n, 6 + n);
        a.view_mut((0, 0), (6, 6))
            .copy_from(&(&self.j_theta * &k * self.j_theta.transpose()));
        a.view_mut((0, 6), (6, n)).copy_from(&right);
        a.view_mut((6, 0), (n, 6)).copy_from(&left);
        a.view_mut((6, 6), (n, n))
            .copy_from(&(&self.h_qq + &self.h_qt * &k * &self.h_tq));
        let ones = vec![1.0; 6 + n];
        let mut b = DMatrix::identity(6 + n, 6);
        Saddle::new(a, &ones, &ones).solve(&mut b);
        Ok(self.physical_stiffness(&b.rows(0, 6).into_owned()))
    }

    /// `J_q + J_theta k H_thetaq` and `J_q^T + H_qtheta k J_theta^T`: transposes of each other only
    /// if `H` is symmetric.
    fn couplings(&self, k: &DMatrix<f64>) -> (DMatrix<f64>, DMatrix<f64>) {
        (
            &self.j_q + &self.j_theta * k * &self.h_tq,
            self.j_q.transpose() + &self.h_qt * k * self.j_theta.transpose(),
        )
    }

    /// `K_C0 - K_C0 J_q (J_q^T K_C0 J_q)^-1 J_q^T K_C0` of the unloaded chain [R 3.10].
    ///
    /// # Errors
    /// [`Inapplicable`]: loaded chain, springs that do not reach, redundant passive joints.
    pub fn closed_form(&self) -> Applied<Matrix6<f64>> {
        let locked = self.unloaded_and_locked()?;
        let redundant = || Inapplicable::RedundantPassiveJoints(self.movable(&self.j_q));
        let inner = regular_inverse(&(self.j_q.transpose() * &locked * &self.j_q));
        let inner = inner.ok_or_else(redundant)?;
        let push = &locked * &self.j_q;
        Ok(self.physical_stiffness(&(&locked - &push * inner * push.transpose())))
    }

    fn unloaded_and_locked(&self) -> Applied<DMatrix<f64>> {
        if self.loaded {
            return Err(Inapplicable::Loaded);
        }
        self.locked(&self.spring_compliance()?)
    }

    /// Names of the passive joints that take part in motions which `matrix` takes to zero.
    fn movable(&self, matrix: &DMatrix<f64>) -> Vec<String> {
        let null = complement(&column_space(&matrix.transpose()));
        (0..self.joints.len())
            .filter(|&i| null.row(i).iter().any(|x| x.abs() > 0.1))
            .map(|i| self.joints[i].clone())
            .collect()
    }

    /// Frees one passive joint after the other in the given order (indices into
    /// [`Self::passive_joints`]), starting from the chain with all of them locked [R 3.11, 3.16].
    /// Any order of all joints gives the same; a shorter list leaves the others locked.
    ///
    /// # Errors
    /// [`Inapplicable`]: loaded chain, springs that do not reach, not an order.
    pub fn recursion(&self, order: &[usize]) -> Applied<Recursion> {
        let count = self.joints.len();
        let wrong = |(k, i): (usize, &usize)| *i >= count || order[..k].contains(i);
        if order.iter().enumerate().any(wrong) {
            return Err(Inapplicable::NotAnOrder(count));
        }
        let locked = self.unloaded_and_locked()?;
        let most = locked.amax();
        let mut k = Matrix6::from_fn(|i, j| locked[(i, j)]);
        let (mut pivots, mut skipped) = (Vec::new(), Vec::new());
        for &i in order {
            let column = Vector6::from_fn(|row, _| self.j_q[(row, i)]);
            let step = eliminated(&k, &column);
            let unit = self.scales[1][i];
            pivots.push(step.pivot / (unit * unit));
            let rounding = RANK_TOLERANCE * most * column.norm_squared();
            if step.already_free || step.pivot.abs() <= rounding {
                skipped.push(self.joints[i].clone());
            } else {
                k = step.matrix;
            }
        }
        let scaled = DMatrix::from_fn(6, 6, |i, j| k[(i, j)]);
        Ok(Recursion {
            matrix: self.physical_stiffness(&scaled),
            pivots,
            skipped,
        })
    }

    /// The loaded closed form [R 4.28-4.30]; `H` need not be symmetric. For the unloaded chain it
    /// is [R 3.10].
    ///
    /// # Errors
    /// [`Inapplicable`]: `K_theta - H_thetatheta`, `J_theta k J_theta^T` or the bracket of
    /// [R 4.29] cannot be inverted.
    pub fn loaded_closed_form(&self) -> Applied<LoadedClosedForm> {
        let k = self.spring_compliance()?;
        let locked = self.locked(&k)?;
        let (right, left) = self.couplings(&k);
        let push = &left * &locked;
        let bracket = &self.h_qq + &self.h_qt * &k * &self.h_tq - &push * &right;
        let undecided = || Inapplicable::PassiveJointsUndecided(self.movable(&bracket));
        let passive = -regular_inverse(&bracket).ok_or_else(undecided)? * push;
        let cartesian = &locked - &locked * right * &passive;
        let springs = &k * self.j_theta.transpose() * &cartesian + &k * &self.h_tq * &passive;
        Ok(LoadedClosedForm {
            cartesian: self.physical_stiffness(&cartesian),
            passive: self.physical(1, &passive),
            springs: self.physical(2, &springs),
        })
    }
}
