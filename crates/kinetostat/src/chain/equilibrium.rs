//! Equilibrium of one chain: for a prescribed end pose, a prescribed end wrench, or per direction
//! a mixture of both [R 4.12-4.16].
//!
//! ```text
//! J_q^T F + sum J_q,j^T G_j = 0,   J_theta^T F + sum J_theta,j^T G_j = K_theta (theta - theta0),
//! pose(x) = (p*, R*)
//! ```
//!
//! The iteration starts with the report's own step (loads lagged, `H = 0`), goes on with exact
//! Newton on the bordered system under step control, and falls back on growing the load from an
//! unloaded posture. A failure says up to which share of the load it came.
//!
//! Long chains are solved by sweeps along them (`chain/sweep`), with cost and memory that grow with the
//! number of coordinates; what a sweep cannot do falls back on dense matrices.

use nalgebra::DMatrix;

use crate::chain::residual::{FoundBy, Residual, ResidualNorms};
use crate::chain::scaling::{LEAST_LOAD, natural};
use crate::chain::stability::{ShapeStability, shape_stability, swept_stability};
use crate::chain::stiffness::{ChainStiffness, chain_stiffness, swept_stiffness};
use crate::model::chain::Chain;
use crate::spatial::{Pose, Wrench};

pub(crate) use crate::chain::scaling::{disparate, scales_of};
pub(crate) use crate::chain::system::{System, rounding};

/// A chain in equilibrium.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Equilibrium {
    /// Coordinates, m or rad, in the chain's order.
    pub coordinates: Vec<f64>,
    /// Wrench on the end, about its origin, base axes (N, N m).
    pub wrench: Wrench,
    /// Pose of the end, base from tip.
    pub tip: Pose,
    /// Poses of all nodes, base from node, in the chain's order; the last one is that of the end.
    pub nodes: Vec<Pose>,
    /// Torque of every coordinate's spring, N or N m (zero for passive joints).
    pub spring_torques: Vec<f64>,
    /// Energy stored in the springs, J.
    pub energy: f64,
    /// All loads have a potential; if not, statements about energy do not hold.
    pub conservative: bool,
    /// Tangent stiffness at the end, with what is free, rigid, negative and redundant.
    pub stiffness: ChainStiffness,
    /// Stability of the chain's shape while its end is held.
    pub stability: ShapeStability,
    /// Residual of the conditions of equilibrium.
    pub residual: Residual,
    /// Method by which it was found: a restart may have changed the branch.
    pub found_by: FoundBy,
}

/// Coordinates and wrench on the end that solve the conditions of equilibrium, with the work that it took.
pub(crate) struct Solution {
    pub coordinates: Vec<f64>,
    pub wrench: Wrench,
    pub iterations: usize,
    pub norms: ResidualNorms,
}

impl System {
    /// Tangent and shape by sweeps; `None` where there are none, or where passive joints are
    /// redundant or a pivot is lost.
    /// `solved` as in [`swept_stiffness`].
    pub fn swept_stiffness_and_stability(
        &self,
        chain: &Chain,
        scales: &[f64],
        solved: Option<&DMatrix<f64>>,
    ) -> Option<(ChainStiffness, ShapeStability)> {
        let sweep = self.sweep.as_ref()?;
        let stiffness = swept_stiffness(chain, self, sweep, scales, solved)?;
        let stability = swept_stability(self, sweep, scales)?;
        Some((stiffness, stability))
    }

    pub(crate) fn dense_stiffness_and_stability(
        &self,
        chain: &Chain,
        scales: &[f64],
        conservative: bool,
    ) -> (ChainStiffness, ShapeStability) {
        let stiffness = chain_stiffness(chain, self, scales, None);
        let stability = shape_stability(chain, self, scales, conservative);
        (stiffness, stability)
    }

    /// Everything that is known about the state at which the system was evaluated; it is dense unless
    /// the stiffness and stability are given.
    pub(crate) fn equilibrium(
        &self,
        chain: &Chain,
        scales: &[f64],
        solution: Solution,
        conservative: bool,
        stiffness_and_stability: Option<(ChainStiffness, ShapeStability)>,
    ) -> Equilibrium {
        let (stiffness, stability) = stiffness_and_stability
            .unwrap_or_else(|| self.dense_stiffness_and_stability(chain, scales, conservative));
        self.described(chain, solution, conservative, stiffness, stability)
    }

    pub(crate) fn described(
        &self,
        chain: &Chain,
        solution: Solution,
        conservative: bool,
        stiffness: ChainStiffness,
        stability: ShapeStability,
    ) -> Equilibrium {
        let Solution {
            coordinates,
            wrench,
            iterations,
            norms,
        } = solution;
        Equilibrium {
            tip: self.kinematics.tip_pose(),
            nodes: (0..chain.nodes().len())
                .map(|i| self.kinematics.node_pose(i))
                .collect(),
            spring_torques: self.spring_torque.clone(),
            energy: self.energy,
            conservative,
            coordinates,
            wrench,
            stiffness,
            stability,
            residual: Residual {
                closure_m: norms.closure / chain.scale().stiffness.sqrt(),
                torque: norms.torque / norms.loads.max(LEAST_LOAD * natural(chain)),
                iterations,
                rate: None,
            },
            found_by: FoundBy::Directly,
        }
    }
}
