//! Singular values, eigenvalues and triangles at clustered values: what ranks rest on.

use kinetostat::linalg::SingularValues;
use kinetostat_testing::{LargestEntry, Worst};
use nalgebra::{DMatrix, DVector};

use crate::common::Rng;

/// Orthonormal square matrix: a product of random reflections.
fn orthonormal(random: &mut Rng, n: usize) -> DMatrix<f64> {
    let mut q = DMatrix::identity(n, n);
    for _ in 0..n {
        let v = DVector::from_fn(n, |_, _| random.signed());
        let v = v.normalize();
        q -= 2.0 * &v * (v.transpose() * &q);
    }
    q
}

/// Values in clusters: equal ones, ones that differ by rounding, small ones, zeros.
fn clustered(random: &mut Rng, k: usize) -> Vec<f64> {
    let levels = [1.0, 1.0, 0.5, 1e-3, 1e-9, 0.0];
    let kinds = 1 + random.below(levels.len());
    let blur = [0.0, 1e-15, 1e-12, 1e-8][random.below(4)];
    let mut values: Vec<f64> = (0..k)
        .map(|i| match i {
            0 => 1.0,
            _ => levels[random.below(kinds)] * (1.0 + blur * random.signed()),
        })
        .collect();
    values.sort_by(|a, b| b.total_cmp(a));
    values
}

/// Matrices with singular values that are known: random orthonormal factors, or permutations with
/// signs (whole numbers, many exact zeros), at sizes from 1e-150 to 1e150.
fn cases(count: usize) -> impl Iterator<Item = (DMatrix<f64>, Vec<f64>)> {
    let mut random = Rng(8);
    (0..count).map(move |case| {
        let shapes = [
            (12, 12),
            (6, 12),
            (12, 6),
            (1, 7),
            (9, 1),
            (20, 20),
            (3, 3),
            (13, 8),
        ];
        let (m, n) = shapes[case % shapes.len()];
        let mut values = clustered(&mut random, m.min(n));
        let mut factor = |size: usize| match case % 3 {
            0 => {
                let mut order: Vec<usize> = (0..size).collect();
                for i in 0..size {
                    order.swap(i, random.below(size));
                }
                DMatrix::from_fn(size, size, |i, j| f64::from(u8::from(order[i] == j)))
            }
            _ => orthonormal(&mut random, size),
        };
        let (u, v) = (factor(m), factor(n));
        let unit = [1.0, 1.0, 1e150, 1e-150][random.below(4)];
        for x in &mut values {
            *x *= unit;
        }
        let mut s = DMatrix::zeros(m, n);
        for (i, x) in values.iter().enumerate() {
            s[(i, i)] = *x;
        }
        (u * s * v.transpose(), values)
    })
}

fn square_error(q: &DMatrix<f64>) -> f64 {
    (q.transpose() * q - DMatrix::identity(q.ncols(), q.ncols())).largest_entry()
}

#[test]
fn clustered_singular_values_come_back() {
    let mut theirs = Worst::new();
    for (case, (a, values)) in cases(6000).enumerate() {
        let own = SingularValues::of(&a);
        let most = values[0];
        for (found, expected) in own.values.iter().zip(&values) {
            let error = (found - expected).abs() / most;
            assert!(error <= 1e-14, "case {case}: {error:e}");
        }
        assert!(own.values.is_sorted_by(|a, b| a >= b), "case {case}");
        assert!(square_error(&own.left) <= 1e-13, "case {case}: left");
        assert!(square_error(&own.right) <= 1e-13, "case {case}: right");
        assert!(square_error(&own.all_left()) <= 1e-13, "case {case}: left");
        assert!(
            square_error(&own.all_right()) <= 1e-13,
            "case {case}: right"
        );
        let s = DMatrix::from_diagonal(&DVector::from_vec(own.values.clone()));
        let back = &own.left * s * own.right.transpose();
        let error = (back - &a).largest_entry() / most;
        assert!(error <= 1e-14, "case {case}: recomposed to {error:e}");
        let rank = values.iter().filter(|v| **v > 1e-11 * most).count();
        assert_eq!(own.rank(1e-11), rank, "case {case}");
        let null = own.null_space(1e-11);
        assert_eq!(null.ncols(), a.ncols() - rank, "case {case}");
        assert!((&a * null).largest_entry() <= 1e-13 * most, "case {case}");
        // The four conditions of Penrose.
        let inverse = own.pseudo_inverse(1e-11) * most;
        let (b, size) = (&a / most, inverse.largest_entry());
        let (left, right) = (&b * &inverse, &inverse * &b);
        assert!(
            (&left - left.transpose()).largest_entry() <= 1e-14 * size,
            "case {case}"
        );
        assert!(
            (&right - right.transpose()).largest_entry() <= 1e-14 * size,
            "case {case}"
        );
        assert!(
            (&left * &b - &b).largest_entry() <= 1e-14 * size,
            "case {case}"
        );
        theirs.add(theirs_is_off(&b));
    }
    println!(
        "recomposition errors of nalgebra's singular values here: up to {:.1e}",
        theirs.value()
    );
}

/// Recomposition error of the method that `clippy.toml` forbids. When this stays at rounding in a
/// later nalgebra, own code may go.
#[allow(clippy::disallowed_methods, reason = "it is what is measured")]
fn theirs_is_off(a: &DMatrix<f64>) -> f64 {
    let svd = a.clone().svd(true, true);
    svd.recompose()
        .map_or(f64::INFINITY, |back| (back - a).largest_entry())
}

#[test]
fn what_is_no_matrix_of_numbers_ends_and_says_so() {
    for (m, n) in [(0, 0), (0, 5), (4, 0)] {
        let own = SingularValues::of(&DMatrix::zeros(m, n));
        assert_eq!((own.values.len(), own.rank(1e-11)), (0, 0));
        assert_eq!(own.all_right(), DMatrix::identity(n, n));
        assert_eq!(own.pseudo_inverse(1e-11).shape(), (n, m));
    }
    let own = SingularValues::of(&DMatrix::zeros(3, 5));
    assert_eq!((own.rank(1e-11), own.null_space(1e-11).ncols()), (0, 5));
    for bad in [f64::NAN, f64::INFINITY] {
        let mut a = DMatrix::identity(4, 3);
        a[(2, 1)] = bad;
        let own = SingularValues::of(&a);
        assert!(own.values.iter().all(|v| v.is_nan()));
        assert_eq!(own.rank(1e-11), 0);
    }
}

/// What else of nalgebra ranks and stability rest on: symmetric eigenvalues and vectors, and QR, at
/// the same clusters.
#[test]
fn symmetric_eigenvalues_and_triangles_are_right_at_clusters() {
    let mut random = Rng(9);
    for case in 0..6000 {
        let n = [2, 3, 6, 12, 20][case % 5];
        let q = match case % 3 {
            0 => {
                let turn = |i: usize| if i.is_multiple_of(2) { 1.0 } else { -1.0 };
                let by = random.below(n);
                DMatrix::from_fn(n, n, |i, j| {
                    f64::from(u8::from((i + by) % n == j)) * turn(i)
                })
            }
            _ => orthonormal(&mut random, n),
        };
        let mut values = clustered(&mut random, n);
        for x in &mut values {
            *x *= [1.0, -1.0][random.below(2)];
        }
        let d = DMatrix::from_diagonal(&DVector::from_vec(values.clone()));
        let a = &q * d * q.transpose();
        let a = 0.5 * (&a + a.transpose());
        values.sort_by(f64::total_cmp);
        let eigen = a.clone().symmetric_eigen();
        let mut found: Vec<f64> = eigen.eigenvalues.iter().copied().collect();
        found.sort_by(f64::total_cmp);
        let mut only: Vec<f64> = a.symmetric_eigenvalues().iter().copied().collect();
        only.sort_by(f64::total_cmp);
        for i in 0..n {
            let errors = [found[i] - values[i], only[i] - values[i]];
            assert!(
                errors.iter().all(|e| e.abs() <= 1e-13),
                "case {case}: {errors:?}"
            );
        }
        let error = (eigen.recompose() - &a).largest_entry();
        assert!(error <= 1e-13, "case {case}: {error:e}");
        assert!(square_error(&eigen.eigenvectors) <= 1e-13, "case {case}");
        let qr = a.clone().qr();
        assert!(
            (qr.q() * qr.r() - &a).largest_entry() <= 1e-13,
            "case {case}: QR"
        );
        assert!(square_error(&qr.q()) <= 1e-13, "case {case}: Q");
    }
}
