//! Orthonormal bases of everything orthogonal to given columns, by Householder reflections.

use nalgebra::DMatrix;

/// Orthonormal basis of everything orthogonal to the (independent) columns of `a`, n x (n - k).
pub fn complement(a: &DMatrix<f64>) -> DMatrix<f64> {
    let (n, k) = a.shape();
    // Columns as many as rows have no complement; more can only be rounding.
    if k >= n {
        return DMatrix::zeros(n, 0);
    }
    let mut augmented = DMatrix::zeros(n, k + n);
    augmented.columns_mut(0, k).copy_from(a);
    augmented.columns_mut(k, n).fill_with_identity();
    let q = augmented.qr().q();
    q.columns(k, n - k).into_owned()
}

/// Complement of few columns in many rows, in a number of steps that grows with `n^2 k` only; a basis whose columns lie
/// along no axes.
pub(crate) fn complement_of_few(a: &DMatrix<f64>) -> DMatrix<f64> {
    let (n, k) = a.shape();
    if k >= n {
        return DMatrix::zeros(n, 0);
    }
    let mut turned = DMatrix::identity(n, n);
    a.clone().qr().q_tr_mul(&mut turned);
    turned.rows(k, n - k).transpose()
}
