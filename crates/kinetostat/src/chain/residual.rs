//! Residual of an equilibrium, and the method by which it was found.

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

/// Method by which an equilibrium was found. Where several equilibria exist, it tells which of them this is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
#[non_exhaustive]
pub enum FoundBy {
    /// Newton's iteration from the commanded posture, or from the state that was given.
    #[default]
    Directly,
    /// Newton's iteration from a posture slightly out of line, as a straight or flat one has no linear answer.
    OutOfLine,
    /// The load grew from rest in steps.
    GrowingLoad,
    /// Newton's iteration from another start, far from the commanded posture.
    OtherStart,
    /// A curve of equilibria was followed to it.
    Continuation,
    /// Damped steps, as limbs do not hold the platforms in all directions.
    Relaxation,
}

impl FoundBy {
    /// Returns the method, unless the equilibrium was found directly.
    ///
    /// ```
    /// use kinetostat::chain::FoundBy;
    ///
    /// assert_eq!(FoundBy::Directly.unless_directly(), None);
    /// assert_eq!(FoundBy::OtherStart.unless_directly(), Some(FoundBy::OtherStart));
    /// ```
    #[must_use]
    pub fn unless_directly(self) -> Option<Self> {
        (self != Self::Directly).then_some(self)
    }

    /// The equilibrium may lie on another branch than the one to which a load leads that grows from rest.
    #[must_use]
    pub fn may_be_another_branch(self) -> bool {
        matches!(self, Self::OutOfLine | Self::OtherStart)
    }

    /// Explains the method, in a sentence without its full stop.
    #[must_use]
    pub fn sentence(self) -> &'static str {
        match self {
            Self::Directly => "the equilibrium was found directly from the commanded posture",
            Self::OutOfLine => {
                "the equilibrium was found from a posture slightly out of line: of shapes that mirror each other it is one"
            }
            Self::GrowingLoad => {
                "the equilibrium was found with a load that grew from rest in steps: it is the one to which that load leads"
            }
            Self::OtherStart => {
                "the equilibrium was found from another start, after a load that grows from rest was lost: it may lie on another branch than the one to which that load leads"
            }
            Self::Continuation => "the equilibrium was found along a curve of equilibria",
            Self::Relaxation => {
                "the machine is under-constrained, and the equilibrium is the nearest one on the way from the commanded posture: there may be others farther away"
            }
        }
    }
}
