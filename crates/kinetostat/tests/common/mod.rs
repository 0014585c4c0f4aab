//! Machines, random chains, golden files and the invariants of every equilibrium.
#![allow(dead_code)]

pub mod invariants;
pub mod machines;
pub mod random;

pub use invariants::{assert_chain_equilibrium, assert_equilibrium};
pub use machines::*;
pub use random::*;

use kinetostat_testing::{LargestEntry, Worst};
use nalgebra::{DMatrix, Matrix6};
use serde_json::Value;

/// A golden file with provenance.
pub fn golden(name: &str) -> Value {
    let path = format!("{}/tests/golden/{name}", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{path}: {e}"));
    let value: Value = serde_json::from_str(&text).unwrap_or_else(|e| panic!("{path}: {e}"));
    for key in ["source", "quantity", "units", "status", "digits"] {
        assert!(value[key].is_string(), "{path}: no '{key}'");
    }
    let status = value["status"].as_str().unwrap();
    assert!(
        ["agrees", "erratum", "computed"].contains(&status),
        "{path}: status {status}"
    );
    value
}

pub fn number(v: &Value) -> f64 {
    v.as_f64().unwrap_or_else(|| panic!("not a number: {v}"))
}

pub fn numbers(v: &Value) -> Vec<f64> {
    v.as_array()
        .unwrap_or_else(|| panic!("not a list: {v}"))
        .iter()
        .map(number)
        .collect()
}

pub fn matrix(v: &Value) -> Matrix6<f64> {
    let rows: Vec<Vec<f64>> = v.as_array().unwrap().iter().map(numbers).collect();
    Matrix6::from_fn(|i, j| rows[i][j])
}

pub fn name(v: &Value) -> &str {
    v["name"].as_str().unwrap()
}

/// `|a - b| <= tolerance`, with what it was.
#[track_caller]
pub fn close(what: &str, found: f64, expected: f64, tolerance: f64) {
    assert!(
        (found - expected).abs() <= tolerance,
        "{what}: found {found:.12e}, expected {expected:.12e}, off by {:.2e} > {tolerance:.1e}",
        (found - expected).abs()
    );
}

#[track_caller]
pub fn all_close(what: &str, found: &[f64], expected: &[f64], tolerance: f64) {
    assert_eq!(found.len(), expected.len(), "{what}");
    for (i, (a, b)) in found.iter().zip(expected).enumerate() {
        close(&format!("{what}[{i}]"), *a, *b, tolerance);
    }
}

/// Largest difference of two 6 x 6 stiffnesses as a share of the largest entry of its own block
/// (N/m, N, N m): units are never mixed.
pub fn block_error(a: &Matrix6<f64>, b: &Matrix6<f64>) -> f64 {
    let mut worst = Worst::new();
    for (r, c) in [(0, 0), (0, 3), (3, 0), (3, 3)] {
        let d = (a - b).fixed_view::<3, 3>(r, c).largest_entry();
        worst.add(d / b.fixed_view::<3, 3>(r, c).largest_entry().max(1e-300));
    }
    worst.value()
}

/// As [`block_error`], but each block is compared with the geometric mean of the diagonal blocks:
/// for matrices in which a block may vanish.
pub fn scaled_error(a: &Matrix6<f64>, b: &Matrix6<f64>) -> f64 {
    let size = |r: usize| b.fixed_view::<3, 3>(r, r).largest_entry().max(1e-300);
    let mut worst = Worst::new();
    for r in [0, 3] {
        for c in [0, 3] {
            let d = (a - b).fixed_view::<3, 3>(r, c).largest_entry();
            worst.add(d / (size(r) * size(c)).sqrt());
        }
    }
    worst.value()
}

#[track_caller]
pub fn same_stiffness(what: &str, a: &Matrix6<f64>, b: &Matrix6<f64>, tolerance: f64) {
    let e = scaled_error(a, b);
    assert!(
        e <= tolerance,
        "{what}: relative difference {e:.2e} > {tolerance:.1e}\n{a:.6e}{b:.6e}"
    );
}

/// Rank by singular values of a matrix whose rotations are measured at `length`.
pub fn rank(k: &Matrix6<f64>, length: f64) -> usize {
    let scaled = DMatrix::from_fn(6, 6, |i, j| {
        let unit = |i: usize| if i < 3 { 1.0 } else { length };
        k[(i, j)] / (unit(i) * unit(j))
    });
    // Eigenvalues of [0 A; A^T 0] are the singular values and their opposites.
    let mut twice = DMatrix::zeros(12, 12);
    twice.view_mut((0, 6), (6, 6)).copy_from(&scaled);
    twice
        .view_mut((6, 0), (6, 6))
        .copy_from(&scaled.transpose());
    let values = twice.symmetric_eigenvalues();
    let most = values.max();
    values.iter().filter(|x| **x > 1e-9 * most).count()
}
