//! Linear differential equations of first order in Legendre polynomials, and collocation points of a stretch of time.
//!
//! The integral of a Legendre polynomial from the beginning of a stretch is one of its two neighbours: `u' = z u + g` with
//! `u = 0` at the beginning, integrated once, is the tridiagonal system `(1 - z S) u = S g` for the coefficients. Modes are
//! solved in their number times the square of that of the points, where a dense matrix at the nodes takes the cube.

use std::f64::consts::PI;

use nalgebra::{DMatrix, DVector};

use crate::number::Complex64;
use crate::stability::legendre;

/// The polynomials of degrees up to the last row at shares of the stretch (one a column).
pub(crate) fn polynomials(degree: usize, shares: &[f64]) -> DMatrix<f64> {
    let mut values = DMatrix::from_element(degree + 1, shares.len(), 1.0);
    for (column, share) in shares.iter().enumerate() {
        let x = 2.0 * share - 1.0;
        for k in 1..=degree {
            // (k) P_k = (2k - 1) x P_(k-1) - (k - 1) P_(k-2)
            let before = match k {
                1 => 0.0,
                _ => values[(k - 2, column)],
            };
            let (last, k_) = (values[(k - 1, column)], k as f64);
            values[(k, column)] = ((2.0 * k_ - 1.0) * x * last - (k_ - 1.0) * before) / k_;
        }
    }
    values
}

/// Solution of `u' = z u + g` with `u = 0` at the beginning, over a stretch of length 1, as a map from the coefficients
/// of `g`.
pub(crate) struct Answer {
    /// Real parts of the coefficients of `u` (a column each) by those of `g` (a row each).
    pub(crate) real: DMatrix<f64>,
    /// Imaginary parts.
    pub(crate) imaginary: DMatrix<f64>,
}

impl Answer {
    /// Solves for so many coefficients of `g`; `u` has one more. `None` where the system is singular.
    pub(crate) fn of(z: Complex64, count: usize) -> Option<Self> {
        let mut answer = Self {
            real: DMatrix::zeros(count, count + 1),
            imaginary: DMatrix::zeros(count, count + 1),
        };
        for row in 0..=count {
            for column in [row.wrapping_sub(1), row, row + 1] {
                if column < count {
                    answer.real[(column, row)] = integral(row, column);
                }
            }
        }
        answer.solve(z)?;
        Some(answer)
    }

    /// Gauss' elimination of `1 - z S` with exchange of neighbouring rows.
    fn solve(&mut self, z: Complex64) -> Option<()> {
        let last = self.real.ncols() - 1;
        let entry = |row: usize, column: usize| {
            let one = f64::from(u8::from(row == column));
            match column <= last {
                true => Complex64::from(one) - z * integral(row, column),
                false => Complex64::default(),
            }
        };
        // Each row: diagonal and the two entries beside it.
        let mut rows = Vec::with_capacity(last + 1);
        let (mut diagonal, mut beside) = (entry(0, 0), entry(0, 1));
        for k in 0..last {
            let below = entry(k + 1, k);
            let next = (entry(k + 1, k + 1), entry(k + 1, k + 2));
            if diagonal.norm_sqr() >= below.norm_sqr() {
                rows.push([diagonal, beside, Complex64::default()]);
                let factor = below / diagonal;
                self.subtract(factor, k, k + 1);
                (diagonal, beside) = (next.0 - factor * beside, next.1);
            } else {
                rows.push([below, next.0, next.1]);
                self.real.swap_columns(k, k + 1);
                self.imaginary.swap_columns(k, k + 1);
                let factor = diagonal / below;
                self.subtract(factor, k, k + 1);
                (diagonal, beside) = (beside - factor * next.0, -factor * next.1);
            }
        }
        rows.push([diagonal, Complex64::default(), Complex64::default()]);
        for k in (0..=last).rev() {
            let [diagonal, first, second] = rows[k];
            for (factor, from) in [(first, k + 1), (second, k + 2)] {
                if from <= last && factor != Complex64::default() {
                    self.subtract(factor, from, k);
                }
            }
            let inverse = diagonal.inv();
            if !(inverse.re.is_finite() && inverse.im.is_finite()) {
                return None;
            }
            self.multiply(inverse, k);
        }
        Some(())
    }

    /// Takes a multiple of one coefficient from another one.
    fn subtract(&mut self, factor: Complex64, from: usize, of: usize) {
        let count = self.real.nrows();
        let (re_from, re_of) = two_columns(&mut self.real, count, from, of);
        let (im_from, im_of) = two_columns(&mut self.imaginary, count, from, of);
        let from = re_from.iter().zip(im_from.iter());
        for ((re, im), (a, b)) in re_of.iter_mut().zip(im_of).zip(from) {
            *re -= factor.re * a - factor.im * b;
            *im -= factor.re * b + factor.im * a;
        }
    }

    fn multiply(&mut self, factor: Complex64, column: usize) {
        let mut real = self.real.column_mut(column);
        let mut imaginary = self.imaginary.column_mut(column);
        for (re, im) in real.iter_mut().zip(imaginary.iter_mut()) {
            (*re, *im) = (
                factor.re * *re - factor.im * *im,
                factor.re * *im + factor.im * *re,
            );
        }
    }
}

/// A column and another one that is written.
fn two_columns(
    matrix: &mut DMatrix<f64>,
    rows: usize,
    from: usize,
    of: usize,
) -> (&[f64], &mut [f64]) {
    let all = matrix.as_mut_slice();
    if from < of {
        let (low, high) = all.split_at_mut(of * rows);
        (&low[from * rows..][..rows], &mut high[..rows])
    } else {
        let (low, high) = all.split_at_mut(from * rows);
        (&high[..rows], &mut low[of * rows..][..rows])
    }
}

/// Entry of `S`: the share of a polynomial in the integral of another one.
fn integral(of: usize, integrated: usize) -> f64 {
    let half = 0.5 / (2.0 * integrated as f64 + 1.0);
    match (of, integrated) {
        (0, 0) => 0.5,
        _ if of == integrated + 1 => half,
        _ if of + 1 == integrated => -half,
        _ => 0.0,
    }
}

/// Chebyshev's points of a stretch, without its beginning.
#[derive(Clone, Debug)]
pub(crate) struct Chebyshev {
    /// Shares of the stretch, above 0 and up to 1.
    pub(crate) nodes: Vec<f64>,
}

impl Chebyshev {
    /// Creates so many nodes, the beginning not counted.
    pub(crate) fn new(points: usize) -> Self {
        let n = points.max(1);
        let node = |i: usize| (0.5 * PI * i as f64 / n as f64).sin().powi(2);
        Self {
            nodes: (1..=n).map(node).collect(),
        }
    }

    /// Values at the nodes (a row each) of Legendre's polynomials up to a degree.
    pub(crate) fn polynomials(&self, degree: usize) -> DMatrix<f64> {
        legendre::polynomials(degree, &self.nodes).transpose()
    }

    /// The matrix that takes values at the nodes to coefficients of Legendre's polynomials.
    pub(crate) fn coefficients(&self) -> Option<DMatrix<f64>> {
        self.polynomials(self.nodes.len() - 1).try_inverse()
    }

    /// Weights with which values at the nodes give the integral over a stretch so long, s.
    ///
    /// Those of Clenshaw and Curtis for all nodes and the beginning; the polynomial through the nodes has there the value at
    /// which the highest divided difference is none.
    pub(crate) fn weights(&self, duration: f64) -> DVector<f64> {
        let n = self.nodes.len();
        let weight = |i: usize| {
            let sum: f64 = (1..=n / 2)
                .map(|j| {
                    let half = if 2 * j == n { 0.5 } else { 1.0 };
                    let turn = 2.0 * PI * ((i * j) % n) as f64 / n as f64;
                    2.0 * half * turn.cos() / (4.0 * (j * j) as f64 - 1.0)
                })
                .sum();
            let end = if i == 0 || i == n { 0.5 } else { 1.0 };
            end * (1.0 - sum) / n as f64
        };
        let beginning = weight(0);
        DVector::from_fn(n, |row, _| {
            let i = row + 1;
            let sign = if i.is_multiple_of(2) { -1.0 } else { 1.0 };
            let end = if i == n { 1.0 } else { 2.0 };
            duration * (weight(i) + beginning * sign * end)
        })
    }
}
