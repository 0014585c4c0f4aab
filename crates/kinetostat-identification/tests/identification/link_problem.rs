//! Problem P4 of the reference values: compliance of a tube from 18 noisy load cases.

use nalgebra::{DMatrix, DVector};

use crate::support::Random;

/// Entries (a, b), a <= b, of a symmetric 6x6 matrix, row by row.
pub fn entries() -> impl Iterator<Item = (usize, usize)> {
    (0..6).flat_map(|a| (a..6).map(move |b| (a, b)))
}

/// Symmetric matrix from its upper triangle, row by row.
pub fn matrix(triangle: &[f64]) -> DMatrix<f64> {
    let mut matrix = DMatrix::zeros(6, 6);
    for ((a, b), &value) in entries().zip(triangle) {
        matrix[(a, b)] = value;
        matrix[(b, a)] = value;
    }
    matrix
}

/// Compliance of the tube (Euler-Bernoulli) at its free end, m and rad per N and N m.
pub fn tube() -> DMatrix<f64> {
    let (length, outer, inner) = (1.0, 0.25_f64, 0.21_f64);
    let (e, g) = (2.06e11, 7.9e10);
    let area = std::f64::consts::PI / 4.0 * (outer.powi(2) - inner.powi(2));
    let inertia = std::f64::consts::PI / 64.0 * (outer.powi(4) - inner.powi(4));
    let bending = length / (e * inertia);
    let mut c = DMatrix::from_diagonal(&DVector::from_vec(vec![
        length / (e * area),
        bending * length * length / 3.0,
        bending * length * length / 3.0,
        length / (2.0 * g * inertia),
        bending,
        bending,
    ]));
    for (a, b, sign) in [(1, 5, 1.0), (2, 4, -1.0)] {
        c[(a, b)] = sign * bending * length / 2.0;
        c[(b, a)] = c[(a, b)];
    }
    c
}

/// Rows of the twist `C w` by the 21 entries of `C`, 6 x 21.
pub fn rows(wrench: &DVector<f64>) -> DMatrix<f64> {
    let mut rows = DMatrix::zeros(6, 21);
    for (k, (a, b)) in entries().enumerate() {
        rows[(a, k)] = wrench[b];
        rows[(b, k)] = wrench[a];
    }
    rows
}

/// Weighted rows (108 x 21) and data of P4.
pub fn problem() -> (DMatrix<f64>, DVector<f64>) {
    let mut random = Random::new(1000);
    let wrenches: Vec<DVector<f64>> = (0..18)
        .map(|_| {
            let size = |i| if i < 3 { 3000.0 } else { 600.0 };
            DVector::from_iterator(6, (0..6).map(|i| size(i) * random.between(-1.0, 1.0)))
        })
        .collect();
    assert!((wrenches[0][0] + 1590.936705).abs() < 1e-6);
    let (mut matrix, mut data) = (DMatrix::zeros(108, 21), DVector::zeros(108));
    for (k, wrench) in wrenches.iter().enumerate() {
        let (columns, twist) = (rows(wrench), tube() * wrench);
        for i in 0..6 {
            let sigma = if i < 3 { 4e-6 } else { 6e-6 };
            matrix.set_row(6 * k + i, &(columns.row(i) / sigma));
            data[6 * k + i] = twist[i] / sigma + random.normal();
        }
    }
    (matrix, data)
}
