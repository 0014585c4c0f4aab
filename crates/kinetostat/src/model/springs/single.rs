//! Laws of one coordinate: a torque by a deflection, and back.

use crate::linalg::derivatives::{Forward, Number, Real};

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
