//! Eigenvalues of a small real matrix by the QR iteration.

use nalgebra::{DMatrix, DVector, linalg::Schur};

use crate::error::{ChatterError, ChatterErrorKind, Result};
use crate::number::Complex64;

/// Rounds of the QR iteration for each row: it needs three or four where it converges at all.
const ROUNDS: usize = 60;
/// Matrices with the same eigenvalues from which the iteration begins anew where it does not end: it has no shifts for that, and
/// cycles for some matrices whose eigenvalues are all apart.
const BEGUN: usize = 6;
/// Threshold of rounding below the diagonal in each attempt, in units of it: the last steps may end a little above one.
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

/// A vector that no symmetry makes blind for an eigenvector: numbers without order, the same in every run.
pub(crate) fn start(size: usize) -> DVector<f64> {
    let mut seed = 0x9E37_79B9_7F4A_7C15_u64;
    DVector::from_fn(size, |_, _| {
        seed ^= seed << 13;
        seed ^= seed >> 7;
        seed ^= seed << 17;
        (seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    })
}
