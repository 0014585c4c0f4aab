//! A spring with a knee: one stiffness up to a deflection, another beyond it.
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

use serde::{Deserialize, Serialize};

use crate::linalg::derivatives::Number;
use crate::model::limits::LARGEST;
use crate::model::springs::single::SingleLaw;

/// A spring of one coordinate with two stiffnesses.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::derivatives::Forward;

    const LAWS: [BilinearLaw; 2] = [
        BilinearLaw {
            stiffness: 2e5,
            beyond: 6e5,
            knee: 1e-3,
        },
        BilinearLaw {
            stiffness: 3e5,
            beyond: 1e5,
            knee: 2e-3,
        },
    ];

    #[test]
    fn torque_is_the_derivative_of_the_energy_and_the_tangent_that_of_the_torque() {
        for law in LAWS {
            for x in [-4e-3, -1.5e-3, 0.0, 0.4e-3, 0.9e-3, 2.5e-3] {
                let (h, [tangent]) = (1e-7, law.torque(Forward::variable(x, 0)).rate);
                let work = (law.energy(x + h) - law.energy(x - h)) / (2.0 * h);
                assert!(
                    (work - law.torque(x)).abs() < 1e-4,
                    "{work} {}",
                    law.torque(x)
                );
                let slope = (law.torque(x + h) - law.torque(x - h)) / (2.0 * h);
                assert!((slope - tangent).abs() < 1e-3, "{slope} {tangent}");
                assert!((law.deflection(law.torque(x)) - x).abs() < 1e-15);
            }
        }
    }

    #[test]
    fn the_torque_is_continuous_at_the_knee_and_odd() {
        for law in LAWS {
            let at = law.stiffness * law.knee;
            for side in [1.0 - 1e-12, 1.0, 1.0 + 1e-12] {
                assert!((law.torque(side * law.knee) - at).abs() < 1e-8 * at);
                assert_eq!(law.torque(-side * law.knee), -law.torque(side * law.knee));
            }
            assert!((law.energy(law.knee) - 0.5 * at * law.knee).abs() < 1e-12);
        }
    }
}
