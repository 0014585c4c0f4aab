//! Laws of one coordinate. A spring with a knee has one stiffness up to a deflection, another beyond it.
//!
//! Wave gears and bearings under preload answer like this; their makers give two or three stiffnesses by range of
//! torque. With `c(x)` the deflection `x` cut off at `-d` and `d`,
//!
//! ```text
//! T = k2 x + (k1 - k2) c(x)      E = 1/2 k2 x^2 + (k1 - k2) (x c(x) - 1/2 c(x)^2)
//! ```
//!
//! so that `T = k1 x` to the knee and `T = k1 d + k2 (x - d)` beyond, alike in both senses. The torque is
//! continuous, its slope jumps at the knee. The inverse is a law of the same kind: `1/k1` to the torque `k1 d`.

#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

use crate::linalg::derivatives::{Forward, Number, Real};
use crate::model::limits::LARGEST;

/// A spring of one coordinate with two stiffnesses.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct BilinearLaw {
    /// Stiffness up to the knee, N/m or N m/rad.
    pub stiffness: f64,
    /// Stiffness beyond the knee, in the same unit; positive.
    pub beyond: f64,
    /// Deflection at the knee, m or rad, in both senses; positive.
    pub knee: f64,
}

impl SingleLaw for BilinearLaw {
    fn at_rest(&self) -> f64 {
        self.stiffness
    }

    fn fault(&self) -> Option<&'static str> {
        let usable = |x: f64| x > 0.0 && x <= LARGEST;
        let fits = usable(self.beyond) && usable(self.knee);
        (!fits).then_some(
            "the stiffness beyond its knee and the deflection there must be positive numbers",
        )
    }

    #[inline(always)]
    fn torque<N: Number>(&self, x: N) -> N {
        x * self.beyond + x.clamped(self.knee) * (self.stiffness - self.beyond)
    }

    #[inline(always)]
    fn deflection<N: Number>(&self, torque: N) -> N {
        let (first, then) = (1.0 / self.stiffness, 1.0 / self.beyond);
        torque * then + torque.clamped(self.stiffness * self.knee) * (first - then)
    }

    fn energy(&self, x: f64) -> f64 {
        let c = x.clamped(self.knee);
        0.5 * self.beyond * x * x + (self.stiffness - self.beyond) * (x - 0.5 * c) * c
    }
}

/// A law that grows without end in both senses, zero at zero.
pub trait SingleLaw {
    /// Stiffness at rest, N/m or N m/rad.
    fn at_rest(&self) -> f64;

    /// Describes the fault of its numbers, the stiffness at rest excepted.
    fn fault(&self) -> Option<&'static str>;

    /// Torque (N, N m) at a deflection (m, rad).
    fn torque<N: Number>(&self, x: N) -> N;

    /// The deflection at which the law has this torque: a contracting iteration needs no tangent then.
    fn deflection<N: Number>(&self, torque: N) -> N;

    /// Energy, J.
    fn energy(&self, x: f64) -> f64;

    /// Tangent stiffness at a deflection.
    #[inline(always)]
    fn tangent<R: Real>(&self, x: R) -> R {
        let [rate] = self.torque(Forward::variable(x, 0)).rate;
        rate
    }
}
