//! Symmetric matrices as triangles, and an accurate singular value decomposition.

use std::f64::consts::{FRAC_1_SQRT_2, SQRT_2};

use nalgebra::{DMatrix, DVector};

/// Limit of the sweeps of rotations; a few are enough.
const SWEEPS: usize = 30;

/// Position of the entry (i, k), i <= k, in the upper triangle of an n x n matrix, row by row.
pub(super) fn triangle_index(n: usize, i: usize, k: usize) -> usize {
    i * (2 * n + 1 - i) / 2 + k - i
}

/// Symmetric matrix from the upper triangle, row by row, with off-diagonal entries multiplied by the square root of 2.
pub(super) fn symmetric_from_triangle(triangle: &[f64], n: usize) -> DMatrix<f64> {
    DMatrix::from_fn(n, n, |i, k| {
        let value = triangle[triangle_index(n, i.min(k), i.max(k))];
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

/// Singular value decomposition `matrix = L diag(s) R^T` by the one-sided rotations of Jacobi and Hestenes: `(R, L, s)`.
///
/// It is accurate for singular values of very different size if they come from columns of very different size (Demmel and Veselic
/// 1992), unlike methods that reduce the matrix to two diagonals first.
pub(super) fn singular(mut matrix: DMatrix<f64>) -> (DMatrix<f64>, DMatrix<f64>, DVector<f64>) {
    let n = matrix.ncols();
    let mut right = DMatrix::identity(n, n);
    for _ in 0..SWEEPS {
        let mut is_orthogonal = true;
        for i in 0..n {
            for k in i + 1..n {
                let (a, b) = (matrix.column(i).norm(), matrix.column(k).norm());
                let dot = matrix.column(i).dot(&matrix.column(k));
                if dot.abs() <= f64::EPSILON * a * b {
                    continue;
                }
                is_orthogonal = false;
                let ratio = (b - a) * (b + a) / (2.0 * dot);
                let tangent = 1.0_f64.copysign(ratio) / (ratio.abs() + ratio.hypot(1.0));
                let cosine = 1.0 / tangent.hypot(1.0);
                for m in [&mut matrix, &mut right] {
                    for row in 0..n {
                        let (x, y) = (m[(row, i)], m[(row, k)]);
                        m[(row, i)] = cosine * (x - tangent * y);
                        m[(row, k)] = cosine * (y + tangent * x);
                    }
                }
            }
        }
        if is_orthogonal {
            break;
        }
    }
    let sizes = DVector::from_iterator(n, matrix.column_iter().map(|c| c.norm()));
    for (mut column, size) in matrix.column_iter_mut().zip(&sizes) {
        column /= *size;
    }
    (right, matrix, sizes)
}
