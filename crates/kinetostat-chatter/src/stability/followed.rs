//! One eigenvalue of a small matrix with nothing below its first subdiagonal, as the matrix grows.

use nalgebra::{DMatrix, DVector};

use crate::error::{ChatterError, ChatterErrorKind, Result};
use crate::number::Complex64;
use crate::stability::eigenvalues::{eigenvalues, start};

/// An eigenvalue of the small matrix with its vector of unit length.
pub(crate) struct Followed {
    pub(crate) value: Complex64,
    pub(crate) vector: DVector<Complex64>,
    /// Norm of the residual `A x - value x` in the small matrix.
    left: f64,
    /// The QR iteration has found no larger one.
    pub(crate) is_largest: bool,
}

impl Followed {
    /// The largest one, by the QR iteration.
    pub(crate) fn largest_of(matrix: &DMatrix<f64>) -> Result<Self> {
        let value = *eigenvalues(matrix.clone())?.first().ok_or_else(no_vector)?;
        let from = start(matrix.nrows()).map(Complex64::from);
        Ok(Self {
            value,
            vector: inverse_iteration(matrix, value, from)?,
            left: 0.0,
            is_largest: true,
        })
    }

    /// Follows the eigenvalue into a matrix that has grown.
    pub(crate) fn in_larger(self, matrix: &DMatrix<f64>) -> Result<Self> {
        let from = self
            .vector
            .resize_vertically(matrix.nrows(), Complex64::default());
        let vector = inverse_iteration(matrix, self.value, from)?;
        let image = matrix.map(Complex64::from) * &vector;
        let value = vector.dotc(&image);
        Ok(Self {
            value,
            left: (image - &vector * value).norm(),
            vector,
            is_largest: false,
        })
    }

    /// Residual in the whole space, of which the next vector is so long.
    pub(crate) fn residual(&self, rest: f64) -> f64 {
        let last = self.vector[self.vector.len() - 1].norm();
        self.left.hypot(rest * last)
    }
}

fn no_vector() -> ChatterError {
    ChatterError::new(
        ChatterErrorKind::NotConverged,
        "largest multiplier",
        "no eigenvector",
        "an operator of finite numbers",
    )
}

/// The eigenvector of unit length that belongs to the eigenvalue nearest to a value.
fn inverse_iteration(
    matrix: &DMatrix<f64>,
    value: Complex64,
    from: DVector<Complex64>,
) -> Result<DVector<Complex64>> {
    let size = matrix.norm().max(f64::MIN_POSITIVE);
    // A little beside the eigenvalue, so that there is an answer.
    let beside = value + Complex64::new(1e-14 * size, 0.7e-14 * size);
    let shifted = Shifted::new(matrix, beside);
    let mut vector = from;
    for _ in 0..2 {
        shifted.solve(&mut vector);
        let norm = vector.norm();
        if !(norm > 0.0 && norm.is_finite()) {
            return Err(no_vector());
        }
        vector /= Complex64::from(norm);
    }
    Ok(vector)
}

/// A matrix with nothing below its first subdiagonal, less a number on its diagonal, eliminated row by row with pivots.
struct Shifted {
    upper: DMatrix<Complex64>,
    /// Elimination steps of each row: true if it was swapped with the next one, and the multiple of that subtracted
    /// from it.
    steps: Vec<(bool, Complex64)>,
}

impl Shifted {
    fn new(matrix: &DMatrix<f64>, shift: Complex64) -> Self {
        let n = matrix.nrows();
        let mut upper = matrix.map(Complex64::from);
        let mut steps = Vec::with_capacity(n);
        for i in 0..n {
            upper[(i, i)] -= shift;
        }
        for i in 0..n.saturating_sub(1) {
            let changes = upper[(i + 1, i)].norm_sqr() > upper[(i, i)].norm_sqr();
            if changes {
                for j in i..n {
                    upper.swap((i, j), (i + 1, j));
                }
            }
            let below = upper[(i + 1, i)];
            let factor = match below == Complex64::default() {
                true => below,
                false => below / upper[(i, i)],
            };
            for j in i..n {
                let taken = factor * upper[(i, j)];
                upper[(i + 1, j)] -= taken;
            }
            steps.push((changes, factor));
        }
        Self { upper, steps }
    }

    fn solve(&self, vector: &mut DVector<Complex64>) {
        for (i, (changes, factor)) in self.steps.iter().enumerate() {
            if *changes {
                vector.swap_rows(i, i + 1);
            }
            let taken = factor * vector[i];
            vector[i + 1] -= taken;
        }
        for j in (0..vector.len()).rev() {
            vector[j] /= self.upper[(j, j)];
            let known = vector[j];
            for i in 0..j {
                vector[i] -= self.upper[(i, j)] * known;
            }
        }
    }
}
