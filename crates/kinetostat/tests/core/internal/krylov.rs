//! The largest eigenvalues of matrices whose eigenvalues are known.

use kinetostat::internal::largest_eigenvalues;
use kinetostat_testing::LargestEntry;
use nalgebra::{DMatrix, DVector};

/// `Q diag(d) Q` with a reflection `Q`: eigenvalues known exactly.
fn turned(d: &[f64]) -> DMatrix<f64> {
    let n = d.len();
    let v = DVector::from_fn(n, |i, _| (1.0 + i as f64 * 0.37).sin()).normalize();
    let q = DMatrix::identity(n, n) - 2.0 * &v * v.transpose();
    &q * DMatrix::from_diagonal(&DVector::from_row_slice(d)) * &q
}

#[test]
fn the_largest_are_found_also_where_they_are_equal() {
    for n in [20, 96, 97, 200, 300] {
        for equal in 1..=4 {
            // A buckling load, its partners, and many that are small or negative.
            let mut d: Vec<f64> = (0..n).map(|i| -1.0 + 1.7 * i as f64 / n as f64).collect();
            for x in &mut d[..equal] {
                *x = 1.25;
            }
            d[equal] = 1.1;
            let a = turned(&d);
            let count = equal + 1;
            let (values, vectors) = largest_eigenvalues(&a, count);
            for k in 0..count {
                let expected = if k < equal { 1.25 } else { 1.1 };
                assert!(
                    (values[k] - expected).abs() < 1e-12,
                    "{n} {equal}: {values}"
                );
            }
            let residual = &a * &vectors - &vectors * DMatrix::from_diagonal(&values);
            assert!(
                residual.largest_entry() < 1e-9,
                "{n} {equal}: {}",
                residual.largest_entry()
            );
            let gram = vectors.transpose() * &vectors;
            assert!(gram.is_identity(1e-12), "{n} {equal}: {gram}");
        }
    }
}

#[test]
fn a_matrix_without_order_is_decomposed_as_a_whole() {
    // All eigenvalues close together: no small space holds the largest.
    let d: Vec<f64> = (0..150).map(|i| 1.0 + 1e-7 * f64::from(i)).collect();
    let (values, vectors) = largest_eigenvalues(&turned(&d), 2);
    assert!((values[0] - d[149]).abs() < 1e-13 && (values[1] - d[148]).abs() < 1e-13);
    assert!((vectors.transpose() * &vectors).is_identity(1e-12));
}

#[test]
fn numbers_whose_products_underflow_are_none() {
    let mut a = DMatrix::zeros(5, 5);
    for (i, j, value) in [
        (0, 0, -3.6e-240),
        (0, 4, -5.2e-240),
        (1, 1, -2.5e-240),
        (1, 3, 3.7e-240),
    ]
    .into_iter()
    .chain([
        (2, 2, 2.7e-271),
        (2, 3, -3.9e-136),
        (2, 4, -3.6e-139),
        (3, 4, -6.0e-274),
    ]) {
        a[(i, j)] = value;
        a[(j, i)] = value;
    }
    let (values, vectors) = largest_eigenvalues(&a, 1);
    assert!((values[0] / 3.9e-136 - 1.0).abs() < 1e-6, "{values}");
    assert!((vectors.norm() - 1.0).abs() < 1e-12, "{vectors}");
}
