//! Eigenvalues of matrices without symmetry.

use nalgebra::linalg::{Schur, balancing::balance_parlett_reinsch};
use nalgebra::{Complex, DMatrix, DVector};

/// Rounds of the QR iteration for each row: it needs three or four where it converges at all.
const ROUNDS: usize = 60;
/// Matrices with the same eigenvalues from which the iteration begins anew where it does not end (it has no exceptional
/// shifts, and cycles for some matrices whose eigenvalues are all apart), and what counts as rounding in each of them.
const ROUNDING: [f64; 6] = [1.0, 1.0, 1.0, 8.0, 8.0, 64.0];

/// All eigenvalues; `None` where an entry is no number, or the iteration ends from no beginning.
///
/// Rows and columns are balanced first (James, Langou and Lowery 2014): stiff directions beside soft ones leave entries
/// that are worlds apart, and an iteration that takes the largest for the size of all.
pub(crate) fn eigenvalues(mut matrix: DMatrix<f64>) -> Option<Vec<Complex<f64>>> {
    if !matrix.iter().all(|entry| entry.is_finite()) {
        return None;
    }
    balance_parlett_reinsch(&mut matrix);
    let n = matrix.nrows();
    let rounds = ROUNDS * n.max(2);
    ROUNDING.iter().enumerate().find_map(|(begun, rounding)| {
        let schur = Schur::try_new(matrix.clone(), rounding * f64::EPSILON, rounds);
        let found = schur.map(|schur| schur.complex_eigenvalues().iter().copied().collect());
        if found.is_none() {
            // Seen in another mirror each time.
            let along = start(n, begun).normalize();
            let mirror = DMatrix::identity(n, n) - 2.0 * &along * along.transpose();
            matrix = &mirror * &matrix * &mirror;
        }
        found
    })
}

/// Vectors that no symmetry of a machine is orthogonal to: numbers without order, the same in every run.
pub(crate) fn start(size: usize, which: usize) -> DVector<f64> {
    let mut seed = 0x9E37_79B9_7F4A_7C15_u64.wrapping_mul(2 * which as u64 + 1);
    DVector::from_fn(size, |_, _| {
        seed ^= seed << 13;
        seed ^= seed >> 7;
        seed ^= seed << 17;
        (seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    })
}
