//! A matrix by its entries: what systems of many platforms are assembled in.

use nalgebra::{DMatrix, Dim, Matrix, RawStorage};

/// A matrix by entries that add up.
#[derive(Clone, Debug)]
pub struct Sparse {
    /// Number of rows.
    pub rows: usize,
    /// Number of columns.
    pub columns: usize,
    /// Row, column and value.
    pub entries: Vec<(usize, usize, f64)>,
}

impl Sparse {
    /// Matrix without entries.
    pub fn zeros(rows: usize, columns: usize) -> Self {
        Self {
            rows,
            columns,
            entries: Vec::new(),
        }
    }

    /// Adds a block whose upper left entry is `(row, column)`.
    pub fn add<R: Dim, C: Dim, S: RawStorage<f64, R, C>>(
        &mut self,
        row: usize,
        column: usize,
        block: &Matrix<f64, R, C, S>,
    ) {
        for j in 0..block.ncols() {
            for i in 0..block.nrows() {
                let value = block[(i, j)];
                if value != 0.0 {
                    self.entries.push((row + i, column + j, value));
                }
            }
        }
    }

    /// Dense matrix with every zero written out.
    pub fn dense(&self) -> DMatrix<f64> {
        let mut a = DMatrix::zeros(self.rows, self.columns);
        for &(i, j, value) in &self.entries {
            a[(i, j)] += value;
        }
        a
    }

    /// Diagonal entries.
    pub fn diagonal(&self) -> Vec<f64> {
        let mut list = vec![0.0; self.rows];
        for &(i, j, value) in &self.entries {
            if i == j {
                list[i] += value;
            }
        }
        list
    }

    /// `A x`.
    pub fn times(&self, x: &DMatrix<f64>) -> DMatrix<f64> {
        let mut y = DMatrix::zeros(self.rows, x.ncols());
        for &(i, j, value) in &self.entries {
            for k in 0..x.ncols() {
                y[(i, k)] += value * x[(j, k)];
            }
        }
        y
    }
}
