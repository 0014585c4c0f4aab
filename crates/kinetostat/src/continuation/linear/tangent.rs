//! The direction in which an equilibrium persists, directions that the linearised conditions take to nothing, and the determinant
//! that changes its sign at bifurcations.

use nalgebra::{DMatrix, DVector};

use crate::linalg::singular_values::SingularValues;

/// Sign and logarithm of a determinant, and the direction in which equilibrium persists.
pub(crate) struct Tangent {
    pub direction: DVector<f64>,
    /// Sign of `det [G_z; t^T]`: it changes at a simple bifurcation.
    pub sign: f64,
    pub logarithm: f64,
}

impl Tangent {
    /// Builds from the solution of `[G_z; p^T] solution = (0, 1)` and the determinant of that matrix.
    pub fn new(solution: &DVector<f64>, sign: f64, logarithm: f64) -> Option<Self> {
        let norm = solution.norm();
        if !norm.is_finite() || norm == 0.0 {
            return None;
        }
        // det [A; t] = det [A; p] / (p . t), and p . t = 1 / norm.
        Some(Self {
            direction: solution / norm,
            sign,
            logarithm: logarithm + norm.ln(),
        })
    }
}

/// Sign and logarithm of the size of a determinant.
pub(crate) fn determinant(lu: &nalgebra::LU<f64, nalgebra::Dyn, nalgebra::Dyn>) -> (f64, f64) {
    let mut sign: f64 = lu.p().determinant();
    let mut logarithm = 0.0;
    for pivot in lu.lu_internal().diagonal().iter() {
        sign *= pivot.signum();
        logarithm += pivot.abs().max(1e-300).ln();
    }
    (sign, logarithm)
}

/// Directions that a matrix takes to nothing, or nearly so.
pub(crate) struct NullDirections {
    /// Singular values, the least first; zero where there are more columns than rows.
    pub values: Vec<f64>,
    /// Unit directions, one column for each value.
    pub right: DMatrix<f64>,
    /// Unit directions of the rows, the least first.
    pub left: DMatrix<f64>,
}

impl NullDirections {
    /// Finds the null directions of an `m x n` matrix.
    pub fn of(matrix: &DMatrix<f64>) -> Self {
        if !matrix.iter().all(|v| v.is_finite()) {
            return Self {
                values: Vec::new(),
                right: DMatrix::zeros(matrix.ncols(), 0),
                left: DMatrix::zeros(matrix.nrows(), 0),
            };
        }
        let own = SingularValues::of(matrix);
        let all = own.all_right();
        let value = |k: usize| own.values.get(k).copied().unwrap_or(0.0);
        let falling = |a: &DMatrix<f64>| {
            let order: Vec<usize> = (0..a.ncols()).rev().collect();
            a.select_columns(&order)
        };
        Self {
            values: (0..all.ncols()).rev().map(value).collect(),
            right: falling(&all),
            left: falling(&own.left),
        }
    }

    /// Converts to other units: orthonormal again, by ascending singular values.
    pub fn map(&mut self, change: impl Fn(&mut DMatrix<f64>)) {
        for vectors in [&mut self.right, &mut self.left] {
            if vectors.ncols() > 0 {
                change(vectors);
                *vectors = vectors.clone().qr().q();
            }
        }
    }

    /// Number of null directions: at least `least`, and all below a share of the largest singular value.
    pub fn count(&self, least: usize, share: f64) -> usize {
        let most = self.values.last().copied().unwrap_or(0.0);
        let below = |(i, value): &(usize, &f64)| *i < least || **value < share * most;
        self.values.iter().enumerate().take_while(below).count()
    }
}
