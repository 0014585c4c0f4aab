//! Interface of equilibria and of their stability, of a chain and of a machine alike.

use std::fmt::Debug;

use nalgebra::Matrix6;

use crate::chain::directions::Direction;
use crate::chain::equilibrium::Equilibrium;
use crate::chain::stability::ShapeStability;
use crate::spatial::{Pose, Wrench};

/// An equilibrium of a chain or of a machine.
pub trait CurveEquilibrium: Clone + Debug {
    /// Stability of the equilibrium on a curve.
    type Stability: CurveStability;

    /// Pose of the tool (of a chain: its end), base axes.
    fn tool(&self) -> &Pose;
    /// Wrench on the tool, about its origin, base axes (N, N m).
    fn wrench(&self) -> &Wrench;
    /// Energy in all springs, J.
    fn spring_energy(&self) -> f64;
    /// All loads have a potential; if not, statements about energy do not hold.
    fn conservative(&self) -> bool;
    /// Tangent stiffness at the tool, base axes.
    fn stiffness(&self) -> &Matrix6<f64>;
    /// Principal directions of that stiffness.
    fn directions(&self) -> &[Direction];
    /// The shape of the chain, or of every limb, stays while the tool is held.
    fn shape_stable(&self) -> bool;
    /// Largest share of the way to buckling while the tool is held; `None` without inner freedom.
    fn share_to_buckling(&self) -> Option<f64>;
    /// Motion of a chain's coordinates in which its shape would buckle; empty for a machine.
    fn buckling_mode(&self) -> &[f64];
}

/// Stability of an equilibrium on a curve.
pub trait CurveStability: Clone + Debug {
    /// True if the equilibrium is stable.
    fn stable(&self) -> bool;
    /// Number of independent motions in which it goes away.
    fn unstable_modes(&self) -> usize;
    /// True if, under loads without a potential, it does not diverge but may oscillate with growing amplitude
    /// (flutter), which depends on the masses.
    fn may_flutter(&self) -> bool;
}

impl CurveEquilibrium for Equilibrium {
    type Stability = ShapeStability;

    fn tool(&self) -> &Pose {
        &self.tip
    }

    fn wrench(&self) -> &Wrench {
        &self.wrench
    }

    fn spring_energy(&self) -> f64 {
        self.energy
    }

    fn conservative(&self) -> bool {
        self.conservative
    }

    fn stiffness(&self) -> &Matrix6<f64> {
        &self.stiffness.cartesian.matrix
    }

    fn directions(&self) -> &[Direction] {
        &self.stiffness.directions
    }

    fn shape_stable(&self) -> bool {
        self.stability.stable
    }

    fn share_to_buckling(&self) -> Option<f64> {
        self.stability.share_to_buckling
    }

    fn buckling_mode(&self) -> &[f64] {
        &self.stability.mode
    }
}

impl CurveStability for ShapeStability {
    fn stable(&self) -> bool {
        self.stable
    }

    fn unstable_modes(&self) -> usize {
        self.unstable_modes
    }

    fn may_flutter(&self) -> bool {
        self.may_flutter()
    }
}
