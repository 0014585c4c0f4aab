//! The motions that conditions leave, orthonormal in natural units.

use nalgebra::{DMatrix, DVector};

/// Relative size of a pivot below which a condition says nothing new.
const DEPENDENT: f64 = 1e-10;

/// Basis of the null space of `rows` (scaled, k x n), n x m, and the rank of the rows: by Householder reflections with
/// column pivoting of the transpose, so that redundant conditions do no harm.
pub(crate) fn null_space(rows: &DMatrix<f64>) -> (DMatrix<f64>, usize) {
    null_space_below(rows, DEPENDENT)
}

/// Null space with an explicit threshold for pivots, relative to the largest.
pub(crate) fn null_space_below(rows: &DMatrix<f64>, dependent: f64) -> (DMatrix<f64>, usize) {
    let n = rows.ncols();
    if rows.nrows() == 0 || n == 0 {
        return (DMatrix::identity(n, n), 0);
    }
    let qr = rows.transpose().col_piv_qr();
    let triangle = qr.r();
    let diagonal = DVector::from_fn(triangle.nrows().min(triangle.ncols()), |k, _| {
        triangle[(k, k)]
    });
    let most = diagonal
        .iter()
        .fold(0.0_f64, |m, x| if x.abs() > m { x.abs() } else { m });
    let rank = diagonal
        .iter()
        .filter(|x| x.abs() > dependent * most)
        .count();
    let mut transposed = DMatrix::identity(n, n);
    qr.q_tr_mul(&mut transposed);
    // The last rows of Q^T are orthogonal to all conditions.
    (transposed.rows(rank, n - rank).transpose(), rank)
}
