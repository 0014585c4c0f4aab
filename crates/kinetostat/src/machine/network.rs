//! The unloaded nominal machine, linear: every limb a spring between two platforms, or a constraint
//! in the directions in which it cannot move.
//!
//! With `A_i` the motion of the tip of limb `i` against where its base carries it, `A_i dP = T_to
//! dP_to - B_from dP_from`: `K = sum A_i^T K_i A_i`, and `N_i^T A_i dP = 0` for the wrenches `N_i`
//! that the limb carries without any motion.

use nalgebra::{DMatrix, DVector, Matrix6, Vector3};

use crate::chain::stiffness::{ChainStiffness, DirectionKind, unloaded_stiffness};
use crate::error::Result;
use crate::linalg::sparse::Sparse;
use crate::machine::platform_system::RigidRows;
use crate::machine::posture::Posture;
use crate::model::mechanism::Mechanism;
use crate::spatial::{Pose, Twist, Wrench, shift_matrix};

/// All limbs of a posture, linear.
#[derive(Default)]
pub(crate) struct Network {
    pub limbs: Vec<ChainStiffness>,
    /// `A_i` by the motions of all moving platforms, 6 x 6P each.
    pub motions: Vec<Ends>,
    /// `N_i`, 6 x k each: wrenches on the tip, of size one.
    pub rigid: Vec<DMatrix<f64>>,
    platforms: usize,
}

impl Network {
    pub fn new(posture: &Posture) -> Result<Self> {
        let m = &posture.mechanism;
        let mut network = Self {
            platforms: m.platforms().len(),
            ..Self::default()
        };
        for (i, (limb, joints)) in m.limbs().iter().zip(&posture.limbs).enumerate() {
            let base = posture.platforms[limb.from];
            let k =
                unloaded_stiffness(&limb.nominal, &base, &joints.coordinates, &joints.commands)?;
            let length = limb.nominal.scale().length;
            let normals: Vec<DVector<f64>> = k
                .directions
                .iter()
                .filter(|d| d.kind == DirectionKind::Rigid)
                .map(|d| {
                    // The scaled normal, as a wrench.
                    let t = d.twist.0;
                    let w = |j: usize| if j < 3 { t[j] } else { t[j] * length * length };
                    let wrench = DVector::from_fn(6, |j, _| w(j));
                    let size =
                        (0..6).map(|j| (wrench[j] / if j < 3 { 1.0 } else { length }).powi(2));
                    let size = size.sum::<f64>().sqrt();
                    wrench / size
                })
                .collect();
            network.rigid.push(match normals.is_empty() {
                true => DMatrix::zeros(6, 0),
                false => DMatrix::from_columns(&normals),
            });
            network.limbs.push(k);
            network.motions.push(ends(m, &posture.platforms, i));
        }
        Ok(network)
    }

    pub fn moving(&self) -> usize {
        self.platforms - 1
    }

    /// `K`, 6P x 6P.
    pub fn stiffness(&self) -> Sparse {
        let mut total = Sparse::zeros(6 * self.moving(), 6 * self.moving());
        for (limb, ends) in self.limbs.iter().zip(&self.motions) {
            let k = &limb.cartesian.matrix;
            for (row, by_row) in [&ends.to, &ends.from] {
                for (column, by_column) in [&ends.to, &ends.from] {
                    if *row > 0 && *column > 0 {
                        let block = by_row.transpose() * k * by_column;
                        total.add(6 * (row - 1), 6 * (column - 1), &block);
                    }
                }
            }
        }
        total
    }

    /// `N_i^T A_i` of all limbs, k x 6P.
    pub fn rows(&self) -> RigidRows {
        let mut rows = RigidRows::none(self.moving());
        for (rigid, ends) in self.rigid.iter().zip(&self.motions) {
            let k = rigid.ncols();
            if k == 0 {
                continue;
            }
            let at = rows.grow(ends.to.0 - 1, k);
            for (platform, by) in [&ends.to, &ends.from] {
                if *platform > 0 {
                    rows.matrix
                        .add(at, 6 * (platform - 1), &(rigid.transpose() * by));
                }
            }
        }
        rows
    }

    /// Wrenches of all limbs on their tips for motions of the platforms (base included), with
    /// `errors` of the tips and what the limbs carry rigidly (in the order of
    /// [`Self::rows`]).
    pub fn wrenches(&self, motions: &[Twist], errors: &[Twist], carried: &[f64]) -> Vec<Wrench> {
        let mut at = 0;
        (0..self.limbs.len())
            .map(|i| {
                let strain = self.motions[i].of(motions).0 - errors[i].0;
                let mut wrench = self.limbs[i].cartesian.matrix * strain;
                for column in self.rigid[i].column_iter() {
                    wrench += column.fixed_rows::<6>(0) * carried[at];
                    at += 1;
                }
                Wrench(wrench)
            })
            .collect()
    }
}

/// Motion of a limb's tip by those of its two platforms; platform 0 does not move.
pub(crate) struct Ends {
    pub to: (usize, Matrix6<f64>),
    pub from: (usize, Matrix6<f64>),
}

impl Ends {
    /// `A_i dP` of the motions of all platforms, the base included.
    pub fn of(&self, motions: &[Twist]) -> Twist {
        Twist(self.to.1 * motions[self.to.0].0 + self.from.1 * motions[self.from.0].0)
    }

    /// `A_i`, 6 x 6P.
    pub fn matrix(&self, moving: usize) -> DMatrix<f64> {
        let mut a = DMatrix::zeros(6, 6 * moving);
        for (platform, block) in [&self.to, &self.from] {
            if *platform > 0 {
                let mut view = a.fixed_view_mut::<6, 6>(0, 6 * (platform - 1));
                view += block;
            }
        }
        a
    }
}

/// Ends of a limb while the platforms are in these poses.
pub(crate) fn ends(mechanism: &Mechanism, platforms: &[Pose], limb: usize) -> Ends {
    let l = &mechanism.limbs()[limb];
    let (base, end) = (&platforms[l.from], &platforms[l.to]);
    let arm: Vector3<f64> = end.rotation * l.platform_from_tip.translation.vector;
    let tip = end.translation.vector + arm;
    Ends {
        to: (l.to, shift_matrix(&arm)),
        from: (l.from, -shift_matrix(&(tip - base.translation.vector))),
    }
}
