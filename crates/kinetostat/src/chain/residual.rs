//! Residuals of the conditions of equilibrium.

#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

use crate::chain::scaling::beyond;

/// Residuals of a system in scaled units (square root of energy).
#[derive(Clone, Copy, Default)]
pub(crate) struct ResidualNorms {
    pub closure: f64,
    pub torque: f64,
    /// Reference of the torques.
    pub loads: f64,
    /// The part of `torque` that is rounding, see [`crate::chain::system::rounding`].
    pub rounding: f64,
}

/// Share of the loads beyond which no unbalanced torque is taken for rounding.
const MOST_ROUNDING: f64 = 1e-3;

impl ResidualNorms {
    /// Unbalanced torque beyond rounding: a diverged state may have coordinates whose digits are worth more than all
    /// loads, and balances nothing.
    pub fn exceeding(&self) -> f64 {
        beyond(self.torque, self.rounding.min(MOST_ROUNDING * self.loads))
    }
}

/// Residual of the conditions of equilibrium.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[non_exhaustive]
pub struct Residual {
    /// Closure of the end pose where it is prescribed, m (rotations at the natural length).
    pub closure_m: f64,
    /// Unbalanced torque as a share of the loads.
    pub torque: f64,
    /// Iterations spent.
    pub iterations: usize,
    /// Rate observed: norm of the last correction by that of the one before, in scaled units
    /// (square root of energy). A linear iteration converges at its rate, exact Newton falls towards
    /// 0 from step to step. `None` with fewer than two corrections, and where nobody measured it.
    #[cfg_attr(feature = "serde", serde(default))]
    pub rate: Option<f64>,
}
