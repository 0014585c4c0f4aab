//! A matrix by its entries, in which systems of many platforms are assembled, and largest eigenvalues of a symmetric matrix.

use nalgebra::{DMatrix, DVector, Dim, Matrix, RawStorage};

use crate::number::largest_size;

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

/// Matrices of up to so many rows are decomposed as a whole.
const SMALL: usize = 96;
/// Motions in a block: eigenvalues of this multiplicity are found.
const BLOCK: usize = 4;
/// Largest residual of an eigenvector, as a share of the matrix.
const RESIDUAL: f64 = 1e-10;

/// The largest eigenvalues of a symmetric matrix, from the largest, and their orthonormal vectors.
///
/// A block Krylov space `[W, A W, A^2 W, ...]` with full orthogonalisation, and Rayleigh and Ritz in it (Saad,
/// Numerical Methods for Large Eigenvalue Problems, 2011, section 6.4). Blocks find eigenvalues that are
/// equal, as those of a round rod in its two planes are.
pub fn largest_eigenvalues(a: &DMatrix<f64>, count: usize) -> (DVector<f64>, DMatrix<f64>) {
    let n = a.nrows();
    if n > SMALL
        && 4 * count <= n
        && let Some(found) = in_krylov_space(a, count)
    {
        return found;
    }
    of_the_whole(a.clone(), count)
}

/// Share of the largest entry below which one is nothing to the largest eigenvalues; products of such numbers
/// underflow, and the iteration ends in NaN.
const NOTHING: f64 = 1e-60;

fn of_the_whole(mut a: DMatrix<f64>, count: usize) -> (DVector<f64>, DMatrix<f64>) {
    let least = NOTHING * a.amax();
    a.iter_mut()
        .filter(|x| x.abs() < least)
        .for_each(|x| *x = 0.0);
    let eigen = a.symmetric_eigen();
    let mut order: Vec<usize> = (0..eigen.eigenvalues.len()).collect();
    order.sort_by(|&i, &j| eigen.eigenvalues[j].total_cmp(&eigen.eigenvalues[i]));
    order.truncate(count);
    (
        eigen.eigenvalues.select_rows(&order),
        eigen.eigenvectors.select_columns(&order),
    )
}

/// `None` where half of all motions do not hold the vectors.
fn in_krylov_space(a: &DMatrix<f64>, count: usize) -> Option<(DVector<f64>, DMatrix<f64>)> {
    let n = a.nrows();
    let most = n / 2;
    let (mut space, mut image) = (DMatrix::zeros(n, 0), DMatrix::zeros(n, 0));
    // Numbers without any order that a motion of a machine could have.
    #[allow(clippy::cast_precision_loss)]
    let mut block = DMatrix::from_fn(n, BLOCK, |i, j| {
        ((1 + i + j * n) as f64 * 0.618_033_988_749_895).fract() - 0.5
    });
    while space.ncols() + BLOCK <= most {
        // Twice, for once leaves rounding.
        for _ in 0..2 {
            block -= &space * (space.transpose() * &block);
            block = block.qr().q();
        }
        let moved = a * &block;
        space = joined(space, &block);
        image = joined(image, &moved);
        if space.ncols() >= count + BLOCK {
            let within = space.transpose() * &image;
            let (values, chosen) = of_the_whole(0.5 * (&within + within.transpose()), count);
            let vectors = &space * &chosen;
            let residual = &image * &chosen - &vectors * DMatrix::from_diagonal(&values);
            if largest(&residual) <= RESIDUAL * a.amax() {
                return Some((values, vectors));
            }
        }
        block = moved;
    }
    None
}

fn joined(mut space: DMatrix<f64>, block: &DMatrix<f64>) -> DMatrix<f64> {
    let first = space.ncols();
    space = space.resize_horizontally(first + block.ncols(), 0.0);
    space.columns_mut(first, block.ncols()).copy_from(block);
    space
}

/// Largest size of an entry, NaN where one is: nalgebra's `amax` forgets it.
pub(crate) fn largest<R: Dim, C: Dim, S: RawStorage<f64, R, C>>(a: &Matrix<f64, R, C, S>) -> f64 {
    largest_size(a.iter())
}
