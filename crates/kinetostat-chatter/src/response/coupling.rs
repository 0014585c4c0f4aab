//! Damping that couples modes with each other, and with directions without mass that dampers hold.

use nalgebra::{DMatrix, Matrix3, Vector3};

use crate::error::{ChatterError, ChatterErrorKind, Result};
use crate::number::{Complex64, larger};
use crate::response::mode::Mode;

/// Rates between two motions below this share of their own are rounding.
const SAME: f64 = 1e-9;
/// Tolerance of the tests of a matrix, as a share.
const OFF: f64 = 1e-6;

/// Directions without mass relax at most so many times as fast as the fastest mode swings, rad/s.
const FASTEST: f64 = 30.0;

/// `q'' + R_qq q' + R_qz z' + W^2 q = Phi^T F` and `z + R_zq q' + R_zz z' = H^T F`: modes `q` and directions without mass `z`, of unit
/// stiffness, with a symmetric matrix `R`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Coupling {
    rates: DMatrix<f64>,
    held: Vec<Vector3<f64>>,
}

impl Coupling {
    /// Couples modes; `None` where nothing is coupled.
    pub(crate) fn new(
        modes: &[Mode],
        rates: DMatrix<f64>,
        held: Vec<Vector3<f64>>,
    ) -> Result<Option<Self>> {
        let (m, n) = (modes.len(), modes.len() + held.len());
        let fault = |found: String, expected: &str| {
            let quantity = "damping between modes";
            ChatterError::new(ChatterErrorKind::Response, quantity, found, expected)
        };
        if rates.shape() != (n, n) {
            let found = format!("{} x {}", rates.nrows(), rates.ncols());
            let expected =
                format!("{n} x {n}, a row for each mode and each direction without mass");
            return Err(fault(found, &expected));
        }
        let own = |k: usize| match modes.get(k) {
            Some(mode) => mode.rate(),
            None => rates[(k, k)],
        };
        let size = |i: usize, j: usize| (rates[(i, i)].abs() * rates[(j, j)].abs()).sqrt();
        // Comparisons that are false for NaN.
        let is_fit = (0..n).all(|i| {
            let diagonal = larger(own(i), rates[(i, i)]);
            (rates[(i, i)] - own(i)).abs() <= OFF * diagonal
                && (0..i).all(|j| (rates[(i, j)] - rates[(j, i)]).abs() <= OFF * size(i, j))
        });
        if !is_fit || !held.iter().flatten().all(|x| x.is_finite()) {
            let found = "another matrix".to_owned();
            return Err(fault(
                found,
                "a symmetric one with 2 zeta w on its diagonal, 1/s",
            ));
        }
        if let Some(k) = (m..n).find(|k| rates[(*k, *k)] <= 0.0) {
            let found = format!("a time of relaxation of {:.2e} s", rates[(k, k)]);
            return Err(fault(
                found,
                "positive ones: what no damper holds is residual flexibility",
            ));
        }
        // Scaled to units in which the diagonal is one.
        let unit = |i: usize, j: usize| match (i == j, size(i, j)) {
            (true, own) => f64::from(u8::from(own > 0.0)),
            (false, 0.0) => 0.0,
            (false, size) => 0.5 * (rates[(i, j)] + rates[(j, i)]) / size,
        };
        let scaled = DMatrix::from_fn(n, n, unit);
        let least = scaled.symmetric_eigenvalues().min();
        if least < -OFF {
            let found = format!(
                "a motion that it drives, by {:.2e} of what damps others",
                -least
            );
            return Err(fault(found, "a matrix that takes energy from every motion"));
        }
        let couples = (0..n).any(|i| (0..i).any(|j| unit(i, j).abs() > SAME));
        let rates = DMatrix::from_fn(n, n, |i, j| match i == j {
            true => own(i),
            false => 0.5 * (rates[(i, j)] + rates[(j, i)]),
        });
        // A mode that does not swing has no root of a mode.
        let creeps = modes.iter().any(|mode| mode.damping_ratio() >= 1.0);
        Ok((couples || creeps || n > m).then_some(Self { rates, held }))
    }

    /// Rates of modes, then of directions without mass.
    pub(crate) fn rates(&self) -> &DMatrix<f64> {
        &self.rates
    }

    /// Translations of the cutting point in the directions without mass.
    pub(crate) fn held(&self) -> &[Vector3<f64>] {
        &self.held
    }

    /// Rotates the coupling into other axes.
    pub(crate) fn turned(&self, turned: &Matrix3<f64>) -> Self {
        Self {
            rates: self.rates.clone(),
            held: self.held.iter().map(|h| turned * h).collect(),
        }
    }

    /// Restricts the coupling to some of the modes, with the directions that relax at most [`FASTEST`] times as fast as
    /// the fastest of these oscillates: others are springs.
    pub(crate) fn of(&self, modes: &[Mode], kept: &[usize]) -> Option<Self> {
        let fastest = modes.iter().map(Mode::angular_frequency).fold(0.0, larger);
        let before = self.rates.nrows() - self.held.len();
        let slow: Vec<usize> = (before..self.rates.nrows())
            .filter(|k| FASTEST * self.rates[(*k, *k)] * fastest >= 1.0)
            .collect();
        let places: Vec<usize> = kept.iter().chain(&slow).copied().collect();
        let n = places.len();
        let rates = DMatrix::from_fn(n, n, |i, j| self.rates[(places[i], places[j])]);
        let couples = (0..n).any(|i| (0..i).any(|j| rates[(i, j)] != 0.0));
        let creeps = modes.iter().any(|mode| mode.damping_ratio() >= 1.0);
        (couples || creeps || !slow.is_empty()).then(|| Self {
            rates,
            held: slow.iter().map(|k| self.held[k - before]).collect(),
        })
    }

    /// Receptance of modes and massless directions at an angular frequency; not finite exactly at an undamped
    /// resonance.
    pub(crate) fn receptance(&self, modes: &[Mode], w: f64) -> Matrix3<Complex64> {
        let n = self.rates.nrows();
        let own = |k: usize| {
            modes
                .get(k)
                .map_or(1.0, |m| m.angular_frequency().powi(2) - w * w)
        };
        let dynamic = DMatrix::from_fn(n, n, |i, j| {
            Complex64::new(if i == j { own(i) } else { 0.0 }, w * self.rates[(i, j)])
        });
        let point = |k: usize| self.point(modes, k);
        let shapes = DMatrix::from_fn(n, 3, |k, axis| Complex64::from(point(k)[axis]));
        match dynamic.lu().solve(&shapes) {
            Some(moved) => {
                let sum = shapes.transpose() * moved;
                Matrix3::from_fn(|i, j| sum[(i, j)])
            }
            None => Matrix3::from_element(Complex64::from(f64::NAN)),
        }
    }

    /// Motion of the cutting point in a mode or in a massless direction.
    pub(crate) fn point(&self, modes: &[Mode], k: usize) -> Vector3<f64> {
        match modes.get(k) {
            Some(mode) => mode.shape(),
            None => self.held[k - modes.len()],
        }
    }
}
