//! Directions that the linearised conditions of equilibrium take to nothing.

use nalgebra::DMatrix;

use crate::linalg::singular_values::SingularValues;

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
