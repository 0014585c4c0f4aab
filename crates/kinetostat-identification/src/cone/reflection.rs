//! Householder reflections that add rows to an upper triangle.

use nalgebra::{DMatrix, DVector, DVectorView};

/// Eliminates `rows` by Householder reflections with the upper `triangle`, in the first `columns` columns.
///
/// In column k, `rows` is zero from row `height(k)` on; heights must not decrease. The reflections remain in `rows`, their
/// factors are returned: see [`reflect_vector`].
pub(super) fn reflect_rows(
    triangle: &mut DMatrix<f64>,
    rows: &mut DMatrix<f64>,
    columns: usize,
    height: impl Fn(usize) -> usize,
) -> Vec<f64> {
    let stride = rows.nrows();
    let mut factors = vec![0.0; columns];
    for k in 0..columns {
        let (left, right) = rows.as_mut_slice().split_at_mut((k + 1) * stride);
        let below = &mut left[k * stride..k * stride + height(k)];
        let length = DVectorView::from_slice(below, below.len()).norm();
        if length == 0.0 {
            continue;
        }
        let pivot = triangle[(k, k)];
        let diagonal = -pivot.hypot(length).copysign(pivot);
        factors[k] = (diagonal - pivot) / diagonal;
        below.iter_mut().for_each(|v| *v /= pivot - diagonal);
        triangle[(k, k)] = diagonal;
        for (j, other) in (k + 1..).zip(right.chunks_exact_mut(stride)) {
            let top = &mut triangle[(k, j)];
            reflect(factors[k], below, top, other);
        }
    }
    factors
}

/// Applies the reflections of [`reflect_rows`] to a right-hand side: `top` beside the triangle, `bottom` beside the rows.
pub(super) fn reflect_vector(
    rows: &DMatrix<f64>,
    factors: &[f64],
    height: impl Fn(usize) -> usize,
    top: &mut DVector<f64>,
    bottom: &mut DVector<f64>,
) {
    for (k, &factor) in factors.iter().enumerate() {
        let column = rows.column(k);
        let below = &column.as_slice()[..height(k)];
        reflect(factor, below, &mut top[k], bottom.as_mut_slice());
    }
}

/// Reflects one column: `top` and the entries `other` beside the reflection vector (1, below).
fn reflect(factor: f64, below: &[f64], top: &mut f64, other: &mut [f64]) {
    let other = &mut other[..below.len()];
    let dot = DVectorView::from_slice(below, below.len())
        .dot(&DVectorView::from_slice(other, below.len()));
    let change = factor * (*top + dot);
    *top -= change;
    for (o, b) in other.iter_mut().zip(below) {
        *o -= change * b;
    }
}
