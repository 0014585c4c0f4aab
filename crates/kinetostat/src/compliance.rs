//! Compliance of a chain's end: what exists even where the stiffness is infinite in some directions
//! (a planar chain of rigid links in space) and zero in others (passive joints).

use nalgebra::Matrix6;

use crate::spatial::{Twist, Wrench};

/// `twist = springs * wrench + any combination of free`, for wrenches that do no work on the free
/// directions. Base axes, at the tip.
#[derive(Clone, Debug, PartialEq)]
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
            let way = free.linear().norm() + free.angular().norm() * self.length;
            free.dot(wrench).abs() <= 1e-9 * way * push
        });
        held.then(|| Twist(self.springs * wrench.0))
    }
}
