//! Symmetric matrices: triangles and square roots.

use std::f64::consts::{FRAC_1_SQRT_2, SQRT_2};

use nalgebra::{DMatrix, DVector};

/// Asymmetry and negative eigenvalues up to this size are rounding, for a unit diagonal.
const ROUNDING: f64 = 1e-9;

/// Eigenvalues below this fraction of the largest are zero.
const ZERO_EIGENVALUE: f64 = 1e-13;

/// Position of the entry (i, k) in the upper triangle of a symmetric n x n matrix, row by row.
pub(super) fn triangle_index(n: usize, i: usize, k: usize) -> usize {
    let (i, k) = (i.min(k), i.max(k));
    i * (2 * n + 1 - i) / 2 + k - i
}

/// Symmetric matrix from the upper triangle, row by row, with off-diagonal entries multiplied by the square root of 2.
pub(super) fn symmetric_from_triangle(triangle: &[f64], n: usize) -> DMatrix<f64> {
    DMatrix::from_fn(n, n, |i, k| {
        let value = triangle[triangle_index(n, i, k)];
        if i == k { value } else { value * FRAC_1_SQRT_2 }
    })
}

/// Inverse of [`symmetric_from_triangle`].
pub(super) fn triangle_from_symmetric(matrix: &DMatrix<f64>) -> DVector<f64> {
    let n = matrix.nrows();
    let mut triangle = Vec::with_capacity(n * (n + 1) / 2);
    for i in 0..n {
        triangle.push(matrix[(i, i)]);
        triangle.extend((i + 1..n).map(|k| matrix[(i, k)] * SQRT_2));
    }
    DVector::from_vec(triangle)
}

/// Matrix `B` (n x rank) with `B B^T = matrix`; `None` if the matrix is not square, finite, symmetric and positive semi-definite.
pub(crate) fn square_root(matrix: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    if !matrix.is_square() {
        return None;
    }
    // Unit diagonal: the units of the unknowns must not decide about the rank.
    let sizes = matrix
        .diagonal()
        .map(|d| if d > 0.0 { d.sqrt() } else { 1.0 });
    let scaled = DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |i, k| {
        matrix[(i, k)] / sizes[i] / sizes[k]
    });
    let is_symmetric = (&scaled - scaled.transpose()).amax() <= ROUNDING;
    let is_negative = scaled.diagonal().iter().any(|d| *d < 0.0);
    if !scaled.iter().all(|v| v.is_finite()) || !is_symmetric || is_negative {
        return None;
    }
    let eigen = ((&scaled + scaled.transpose()) * 0.5).symmetric_eigen();
    let values = &eigen.eigenvalues;
    if values.min() < -ROUNDING * values.amax() {
        return None;
    }
    let kept: Vec<usize> = (0..values.len())
        .filter(|&k| values[k] > ZERO_EIGENVALUE * values.amax())
        .collect();
    Some(DMatrix::from_fn(matrix.nrows(), kept.len(), |i, k| {
        sizes[i] * eigen.eigenvectors[(i, kept[k])] * values[kept[k]].sqrt()
    }))
}
