//! Viscous damping that couples modes, and holds what has no mass: dampers at joints do [D 8].
//!
//! `x = Phi q + Psi z + ..` with the modes `Phi` and directions without mass `Psi`, which are orthogonal to the modes in `K - H` and of unit
//! stiffness. A damper in series with a spring moves them: `z + T z' + C_zq q' = Psi^T F`, where `T` are times of relaxation. With
//! `C = R R^T`, dampers push along `K^-1 R`, of which `Z = K^-1 R - Phi W^-2 Phi^T R` is without mass: the eigenvectors `V` of
//! `R^T Z` give `Psi = Z V T^(-1/2)`, one direction for each damper at most.

use nalgebra::{Complex, DMatrix, DVector, Matrix3, Vector3};

use crate::damping::Damping;
use crate::error::Result;
use crate::linear::LinearDynamics;
use crate::modes::Modes;

/// Times of relaxation below this share of what all of the flexibility at the dampers would make them are rounding.
const RELAXING: f64 = 1e-10;

/// Coupling by viscous damping: of modes with each other and with massless directions that dampers hold.
#[derive(Clone, Debug, PartialEq)]
pub struct CoupledDamping {
    /// Motion of the point in each direction without mass, of unit stiffness, m per sqrt(N m), base axes. Their flexibility at rest is a
    /// part of the residual one.
    pub held: Vec<Vector3<f64>>,
    /// `C` by modes (1/s, with `2 zeta_k w_k` on the diagonal), then by these directions (s, the times of relaxation on the
    /// diagonal).
    pub rates: DMatrix<f64>,
}

impl LinearDynamics {
    /// Coupling of the lowest modes, at a point with these motions; `None` if nothing is coupled, if damping is not
    /// viscous (structural), and if the machine does not hold its place.
    pub(crate) fn coupled_damping(
        &self,
        modes: &Modes,
        damping: &Damping,
        motions: &DMatrix<f64>,
        count: usize,
    ) -> Result<Option<CoupledDamping>> {
        let holds = modes.counts.free + modes.counts.unstable + modes.counts.neutral == 0;
        let is_viscous = !matches!(damping, Damping::Structural { .. });
        if !(is_viscous && holds && self.modes_are_coupled_by(damping)) {
            return Ok(None);
        }
        let dampers = self.dampers(modes, damping)?;
        let all: Vec<DVector<f64>> = modes.modes.iter().map(|m| m.shape.clone()).collect();
        let shapes = DMatrix::from_columns(&all);
        let driven = shapes.tr_mul(&dampers);
        let mut without_mass = self.solved_with_shift(0.0, &dampers, false)?;
        let whole = dampers.tr_mul(&without_mass).trace();
        let mut at_rest = driven.clone();
        for (mut row, mode) in at_rest.row_iter_mut().zip(&modes.modes) {
            row /= mode.squared;
        }
        without_mass -= &shapes * at_rest;
        let relaxing = dampers.tr_mul(&without_mass);
        let eigen = (0.5 * (&relaxing + relaxing.transpose())).symmetric_eigen();
        let counts = |time: &f64| *time > RELAXING * whole;
        let times: Vec<(usize, f64)> = (eigen.eigenvalues.iter().copied().enumerate())
            .filter(|(_, time)| counts(time))
            .collect();
        // Psi, and R^T of it.
        let directions = DMatrix::from_fn(dampers.ncols(), times.len(), |row, k| {
            let (column, time) = times[k];
            eigen.eigenvectors[(row, column)] / time.sqrt()
        });
        let held = &without_mass * &directions;
        let by_held = &relaxing * directions;
        let (kept, driven) = (count, driven.rows(0, count));
        let between = driven * &by_held;
        let own = driven * driven.transpose();
        let size = kept + times.len();
        let rates = DMatrix::from_fn(size, size, |i, j| match (i < kept, j < kept) {
            (true, true) => own[(i, j)],
            (true, false) => between[(i, j - kept)],
            (false, true) => between[(j, i - kept)],
            (false, false) if i == j => times[i - kept].1,
            (false, false) => 0.0,
        });
        let at = motions.rows(0, 3) * held;
        let held = at.column_iter().map(|c| Vector3::new(c[0], c[1], c[2]));
        Ok(Some(CoupledDamping {
            held: held.collect(),
            rates,
        }))
    }

    /// `R` of `C = R R^T`, a column for each damper.
    fn dampers(&self, modes: &Modes, damping: &Damping) -> Result<DMatrix<f64>> {
        if let Damping::Viscous(list) = damping {
            let column =
                |(name, c): &(String, f64)| Ok(self.motion_of_coordinate(name)? * c.sqrt());
            let columns = list.iter().map(column).collect::<Result<Vec<_>>>()?;
            return Ok(DMatrix::from_columns(&columns));
        }
        let matrix = self.damping_matrix(modes, damping)?;
        // Scaled to units in which the diagonal is one.
        let units = matrix
            .diagonal()
            .map(|own| if own > 0.0 { own.sqrt() } else { 1.0 });
        let n = matrix.nrows();
        let scaled = DMatrix::from_fn(n, n, |i, j| matrix[(i, j)] / (units[i] * units[j]));
        let eigen = scaled.symmetric_eigen();
        Ok(DMatrix::from_fn(n, n, |i, j| {
            let own = eigen.eigenvalues[j];
            let root = if own > 0.0 { own.sqrt() } else { 0.0 };
            units[i] * eigen.eigenvectors[(i, j)] * root
        }))
    }
}

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
