//! Modal data of the translations of one point.

use nalgebra::{Complex, DMatrix, Matrix3, Vector3};

use crate::response::coupled::CoupledDamping;

/// Modal data of the translations of one point: what lobes are computed from.
///
/// The receptance is `sum_k phi_k phi_k^T / (w_k^2 - w^2 + 2 i zeta_k w_k w) + residual`, base axes.
#[derive(Clone, Debug, PartialEq)]
pub struct TranslationalModes {
    /// Mode shapes at the point, normalised by mass, `1/sqrt(kg)`.
    pub shapes: Vec<Vector3<f64>>,
    /// Signed squares of the angular frequencies, (rad/s)^2; negative where unstable, zero where free.
    pub squared: Vec<f64>,
    /// Shares of critical damping.
    pub ratios: Vec<f64>,
    /// Residual flexibility of everything else, m/N.
    pub residual: Matrix3<f64>,
    /// Coupling by damping, if there is any.
    pub coupling: Option<CoupledDamping>,
}

impl TranslationalModes {
    /// Receptance at a frequency, Hz, with all that damping couples, m/N, base axes; numbers that are none exactly at an undamped
    /// resonance.
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Matrix3, Vector3};
    /// use kinetostat_dynamics::TranslationalModes;
    ///
    /// let one = TranslationalModes {
    ///     shapes: vec![Vector3::x() / 2.0], // 4 kg
    ///     squared: vec![2500.0],
    ///     ratios: vec![0.02],
    ///     residual: Matrix3::zeros(),
    ///     coupling: None,
    /// };
    /// let at_resonance = one.receptance_at_hz(50.0 / std::f64::consts::TAU)[(0, 0)].norm();
    /// assert!((at_resonance * 4.0 * 2500.0 * 2.0 * 0.02 - 1.0).abs() < 1e-9);
    /// ```
    #[must_use]
    pub fn receptance_at_hz(&self, hz: f64) -> Matrix3<Complex<f64>> {
        let w = hz * std::f64::consts::TAU;
        let modes = self.shapes.len();
        let held = self
            .coupling
            .as_ref()
            .map_or(&[][..], |c| c.held.as_slice());
        let n = modes + held.len();
        let dynamic = DMatrix::from_fn(n, n, |i, j| {
            let own = if i < modes {
                self.squared[i] - w * w
            } else {
                1.0
            };
            let rate = match &self.coupling {
                Some(coupling) => coupling.rates[(i, j)],
                None if i == j => 2.0 * self.ratios[i] * self.squared[i].abs().sqrt(),
                None => 0.0,
            };
            Complex::new(if i == j { own } else { 0.0 }, w * rate)
        });
        let moved = |k: usize| {
            if k < modes {
                self.shapes[k]
            } else {
                held[k - modes]
            }
        };
        let shapes = DMatrix::from_fn(n, 3, |k, axis| Complex::from(moved(k)[axis]));
        let at_rest = held
            .iter()
            .fold(self.residual, |sum, h| sum - h * h.transpose());
        match dynamic.lu().solve(&shapes) {
            Some(answer) => {
                let sum = shapes.transpose() * answer;
                at_rest.map(Complex::from) + Matrix3::from_fn(|i, j| sum[(i, j)])
            }
            None => Matrix3::from_element(Complex::from(f64::NAN)),
        }
    }
}
