//! The largest eigenvalue of an operator by Arnoldi's method with full orthogonalisation.
//!
//! The monodromy operator is compact: a few eigenvalues count, the others fall faster than any power. So a space of some
//! twenty vectors holds the largest to rounding; it grows to the whole space where it has to.

use nalgebra::{DMatrix, DVector, linalg::Schur};

use crate::error::{ChatterError, ChatterErrorKind, Result};
use crate::number::Complex64;

/// Size of the first space that is looked at, and by how much it grows.
const FIRST: usize = 10;
const GROWTH: usize = 4;
/// Residual of an eigenvalue that is to be known well, by its size.
pub(crate) const ACCURATE: f64 = 1e-10;
/// Residual where it matters on which side of the unit circle it lies.
pub(crate) const ROUGH: f64 = 1e-6;
/// Rounds of the QR iteration for each row: it needs three or four where it converges at all.
const ROUNDS: usize = 60;
/// Matrices with the same eigenvalues from which the iteration begins anew where it does not end: it has no shifts for that, and
/// cycles for some matrices whose eigenvalues are all apart.
const BEGUN: usize = 6;
/// What counts as rounding below the diagonal in each of them, in units of it: the last steps may end a little above one.
const ROUNDING: [f64; BEGUN] = [1.0, 1.0, 1.0, 8.0, 8.0, 64.0];

/// All eigenvalues of a real matrix, the largest first.
pub(crate) fn eigenvalues(matrix: DMatrix<f64>) -> Result<Vec<Complex64>> {
    let fault = |found: &str| {
        ChatterError::new(
            ChatterErrorKind::NotConverged,
            "multipliers",
            found,
            "eigenvalues of a matrix of finite numbers",
        )
    };
    if !matrix.iter().all(|entry| entry.is_finite()) {
        return Err(fault("an entry that is not finite"));
    }
    let found = by_qr(&matrix).ok_or_else(|| fault("no convergence of the QR iteration"))?;
    let mut all: Vec<Complex64> = found;
    // Equal sizes: the one of a pair that turns forward comes first.
    all.sort_by(|a, b| {
        b.norm()
            .total_cmp(&a.norm())
            .then_with(|| b.im.total_cmp(&a.im))
    });
    Ok(all)
}

/// Eigenvalues of a matrix of finite numbers by the QR iteration; `None` where it ends from no beginning.
pub(crate) fn by_qr(matrix: &DMatrix<f64>) -> Option<Vec<Complex64>> {
    let n = matrix.nrows();
    let rounds = ROUNDS * n.max(2);
    // Seen in another mirror each time.
    let mut seen = matrix.clone();
    ROUNDING.iter().enumerate().find_map(|(begun, rounding)| {
        let schur = Schur::try_new(seen.clone(), rounding * f64::EPSILON, rounds);
        let found = schur.map(|schur| schur.complex_eigenvalues().iter().copied().collect());
        if found.is_none() {
            let along = start(n + begun).rows(begun, n).normalize();
            let mirror = DMatrix::identity(n, n) - 2.0 * &along * along.transpose();
            seen = &mirror * &seen * &mirror;
        }
        found
    })
}

/// The largest eigenvalue of an operator on vectors of a length to a residual by its size, with its vector.
pub(crate) fn largest(
    size: usize,
    accuracy: f64,
    mut apply: impl FnMut(&DVector<f64>) -> Result<DVector<f64>>,
) -> Result<(Complex64, DVector<Complex64>)> {
    let mut basis: Vec<DVector<f64>> = vec![start(size).normalize()];
    let mut hessenberg: Vec<Vec<f64>> = Vec::new();
    let mut wanted = FIRST.min(size);
    loop {
        let k = basis.len();
        let mut next = apply(&basis[k - 1])?;
        let length = next.norm();
        let mut column = vec![0.0; k + 1];
        // Twice is enough to be at right angles to rounding.
        for _ in 0..2 {
            for (i, vector) in basis.iter().enumerate() {
                let share = vector.dot(&next);
                next.axpy(-share, vector, 1.0);
                column[i] += share;
            }
        }
        let rest = next.norm();
        column[k] = rest;
        hessenberg.push(column);
        let whole = k >= size || rest.is_nan() || rest <= 1e-14 * length;
        if whole || k >= wanted {
            wanted = (wanted + GROWTH).min(size);
            let small = DMatrix::from_fn(k, k, |i, j| {
                hessenberg[j].get(i).copied().unwrap_or_default()
            });
            let value = *eigenvalues(small.clone())?.first().ok_or_else(no_vector)?;
            let vector = eigenvector(&small, value)?;
            let residual = rest * vector[k - 1].norm();
            if whole || residual <= accuracy * value.norm() {
                let mut full = DVector::from_element(size, Complex64::default());
                for (share, vector) in vector.iter().zip(&basis) {
                    full.zip_apply(vector, |entry, v| *entry += share * v);
                }
                return Ok((value, full));
            }
        }
        basis.push(next / rest);
    }
}

fn no_vector() -> ChatterError {
    ChatterError::new(
        ChatterErrorKind::NotConverged,
        "largest multiplier",
        "no eigenvector",
        "an operator of finite numbers",
    )
}

/// The eigenvector of unit length by inverse iteration.
fn eigenvector(matrix: &DMatrix<f64>, value: Complex64) -> Result<DVector<Complex64>> {
    let n = matrix.nrows();
    let size = matrix.norm().max(f64::MIN_POSITIVE);
    let mut shifted = matrix.map(Complex64::from);
    for i in 0..n {
        // A little beside the eigenvalue, so that there is an answer.
        shifted[(i, i)] -= value + Complex64::new(1e-14 * size, 0.7e-14 * size);
    }
    let factored = shifted.lu();
    let mut vector = start(n).map(Complex64::from);
    for _ in 0..2 {
        vector = factored.solve(&vector).ok_or_else(no_vector)?;
        let norm = vector.norm();
        if !(norm > 0.0 && norm.is_finite()) {
            return Err(no_vector());
        }
        vector /= Complex64::from(norm);
    }
    Ok(vector)
}

/// A vector that no symmetry makes blind for an eigenvector: numbers without order, the same in every run.
fn start(size: usize) -> DVector<f64> {
    let mut seed = 0x9E37_79B9_7F4A_7C15_u64;
    DVector::from_fn(size, |_, _| {
        seed ^= seed << 13;
        seed ^= seed >> 7;
        seed ^= seed << 17;
        (seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    })
}
