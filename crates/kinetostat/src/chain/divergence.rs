//! Motions in which a shape goes away: divergence with and without a potential.
//!
//! With a potential the tangent stiffness `T` is symmetric, and every negative eigenvalue is a motion that
//! frees energy. Forces that follow the chain and moments about fixed axes make `T` unsymmetric: then a
//! neighbouring equilibrium exists where `det T = 0`, not where its symmetric part is indefinite
//! (Bolotin, Nonconservative Problems of the Theory of Elastic Stability, 1963). Below the latter
//! nothing goes away, whatever the masses are; above it the count here tells what the masses cannot change. A
//! flutter is not assessed: with masses that favour it and no damping every unsymmetric `T` has one.
//!
//! Let `U` span the eigenvectors of the symmetric part with negative eigenvalues and `P` the others. Among `P`
//! alone the symmetric part is positive, so that `T_PP` is regular, and
//!
//! ```text
//! det T = det T_PP det R,     R = T_UU - T_UP T_PP^-1 T_PU,     det T_PP > 0
//! ```
//!
//! `R`, static condensation onto the few motions in question, is singular exactly where `T` is, and its inverse is
//! `U^T T^-1 U`. Its real negative eigenvalues are counted: their number is odd exactly where `det T < 0`, and
//! then something goes away whatever the masses are. Conjugate ones may be a flutter, which depends on the masses.
//!
//! Where `U` is all there is, the symmetric part being negative in every motion, nothing depends on the masses:
//! with masses `M` and `T x = w^2 M x` the real part of `w^2 = x* T x / x* M x` is negative for every `x`, so that
//! all motions grow, whether they go straight or swing. The determinant does not tell it: of two motions
//! it is positive there. Sure it is only if no motion was condensed out of `T` before.

use nalgebra::{DMatrix, linalg::Schur};

use crate::linalg::saddle::inertia;
use crate::linalg::sparse::largest_eigenvalues;
use crate::number::larger;

/// Motions of a shape that are in its tangent stiffness.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TangentMotions {
    /// All.
    All,
    /// Some were condensed out of it.
    Condensed,
}

impl TangentMotions {
    pub(crate) fn all_if(all: bool) -> Self {
        match all {
            true => Self::All,
            false => Self::Condensed,
        }
    }
}

/// Number of motions in which a shape of tangent stiffness `tangent` (n x n, in units in which motions
/// count alike) goes away. Eigenvalues of the symmetric part down to `-zero` count as none.
pub fn diverging_motions(tangent: &DMatrix<f64>, zero: f64, motions: TangentMotions) -> usize {
    let n = tangent.nrows();
    if n == 0 {
        return 0;
    }
    let symmetric = 0.5 * (tangent + tangent.transpose());
    let turns = (tangent - tangent.transpose()).amax() > TURNS_NOTHING * symmetric.amax();
    // Counts the eigenvalues above `zero` of the negative matrix.
    let shifted = DMatrix::from_fn(n, n, |i, j| {
        -symmetric[(i, j)] - if i == j { zero } else { 0.0 }
    });
    let unstable = inertia(shifted).positive;
    if unstable == 0 || !turns || (motions == TangentMotions::All && unstable == n) {
        return unstable;
    }
    let (_, u) = largest_eigenvalues(&-symmetric, unstable);
    // The inverse of `R` is that part of the inverse of `T`.
    let Some(moved) = tangent.clone().lu().solve(&u) else {
        return unstable;
    };
    let condensed = u.transpose() * moved;
    let Some(schur) = Schur::try_new(condensed, f64::EPSILON, 10_000) else {
        return unstable;
    };
    let all = schur.complex_eigenvalues();
    let most = all.iter().fold(0.0_f64, |m, x| larger(m, x.norm()));
    if !most.is_finite() {
        return unstable;
    }
    // Two equal ones (a round rod) part by the root of what rounding leaves.
    let real = all.iter().filter(|x| x.im.abs() <= 1e-6 * most);
    real.filter(|x| x.re < 0.0).count()
}

/// Share of a tangent's largest entry below which what is not symmetric in it is rounding.
const TURNS_NOTHING: f64 = 1e-10;
