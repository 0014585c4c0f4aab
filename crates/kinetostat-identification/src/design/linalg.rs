//! Kernels on small dense matrices that work in place, and packed symmetric matrices.

use nalgebra::DMatrix;

/// Smallest pivot of a Cholesky factorisation, relative to the diagonal entry. Smaller ones are rounding.
const PIVOT: f64 = 1e-13;

/// Replaces the lower triangle of a symmetric matrix by its Cholesky factor. Returns false if the matrix is not positive definite.
pub(super) fn factor(a: &mut DMatrix<f64>) -> bool {
    let n = a.nrows();
    let data = a.as_mut_slice();
    for j in 0..n {
        let (done, rest) = data.split_at_mut(j * n);
        let column = &mut rest[..n];
        let diagonal = column[j];
        for k in 0..j {
            let previous = &done[k * n..(k + 1) * n];
            let f = previous[j];
            for (x, l) in column[j..].iter_mut().zip(&previous[j..]) {
                *x -= f * l;
            }
        }
        let pivot = column[j];
        // Also false for NaN.
        if !(pivot > PIVOT * diagonal && pivot.is_normal()) {
            return false;
        }
        let scale = 1.0 / pivot.sqrt();
        for x in &mut column[j..] {
            *x *= scale;
        }
    }
    true
}

/// Replaces the columns of `b` by the solutions of `L y = b`, with `L` the lower triangle of `l`.
pub(super) fn solve_lower(l: &DMatrix<f64>, b: &mut DMatrix<f64>) {
    let n = l.nrows();
    for column in b.as_mut_slice().chunks_exact_mut(n) {
        for k in 0..n {
            let factor = &l.as_slice()[k * n..(k + 1) * n];
            let y = column[k] / factor[k];
            column[k] = y;
            if y != 0.0 {
                for (x, f) in column[k + 1..].iter_mut().zip(&factor[k + 1..]) {
                    *x -= y * f;
                }
            }
        }
    }
}

/// Replaces `b` by the solution of `L^T y = b`, with `L` the lower triangle of `l`.
pub(super) fn solve_lower_transposed(l: &DMatrix<f64>, b: &mut DMatrix<f64>) {
    let n = l.nrows();
    for column in b.as_mut_slice().chunks_exact_mut(n) {
        for k in (0..n).rev() {
            let factor = &l.as_slice()[k * n..(k + 1) * n];
            let sum: f64 = (k + 1..n).map(|i| factor[i] * column[i]).sum();
            column[k] = (column[k] - sum) / factor[k];
        }
    }
}

/// Number of entries of a packed symmetric matrix.
pub(super) fn packed_len(n: usize) -> usize {
    n * (n + 1) / 2
}

/// Writes the lower triangle column by column, with the entries below the diagonal multiplied by `off_diagonal`.
///
/// The inner product of a matrix packed with 1 and one packed with 2 is the trace of the product.
pub(super) fn pack(a: &DMatrix<f64>, off_diagonal: f64, packed: &mut [f64]) {
    let n = a.nrows();
    let mut next = packed.iter_mut();
    for j in 0..n {
        for i in j..n {
            if let Some(x) = next.next() {
                *x = a[(i, j)] * if i == j { 1.0 } else { off_diagonal };
            }
        }
    }
}

/// Fills the lower triangle of a matrix from its packed entries; the upper triangle remains as it was.
pub(super) fn unpack(packed: &[f64], a: &mut DMatrix<f64>) {
    let n = a.nrows();
    let mut start = 0;
    for j in 0..n {
        let length = n - j;
        a.as_mut_slice()[j * n + j..(j + 1) * n].copy_from_slice(&packed[start..start + length]);
        start += length;
    }
}

/// Singular values and right vectors of a square matrix by one-sided Jacobi rotations (Hestenes, Inversion of matrices by
/// biorthogonalization, Journal of SIAM 6, 1958), which is exact to rounding for clustered values, too. Not sorted.
pub(super) fn right_singular(mut a: DMatrix<f64>) -> (Vec<f64>, DMatrix<f64>) {
    let n = a.ncols();
    let mut right = DMatrix::identity(n, n);
    for _ in 0..40 {
        let mut rotated = false;
        for i in 0..n {
            for j in i + 1..n {
                let (x, y) = (a.column(i), a.column(j));
                let (xx, yy, xy) = (x.norm_squared(), y.norm_squared(), x.dot(&y));
                if xy.abs() <= 1e-15 * (xx * yy).sqrt() {
                    continue;
                }
                rotated = true;
                let zeta = (yy - xx) / (2.0 * xy);
                let t = zeta.signum() / (zeta.abs() + zeta.hypot(1.0));
                let cosine = 1.0 / t.hypot(1.0);
                for m in [&mut a, &mut right] {
                    for k in 0..m.nrows() {
                        let (p, q) = (m[(k, i)], m[(k, j)]);
                        m[(k, i)] = cosine * (p - t * q);
                        m[(k, j)] = cosine * (t * p + q);
                    }
                }
            }
        }
        if !rotated {
            break;
        }
    }
    (a.column_iter().map(|c| c.norm()).collect(), right)
}
