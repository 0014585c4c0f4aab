//! Motions in which a shape goes away: divergence with and without a potential.
//!
//! With a potential the tangent stiffness `T` is symmetric, and every negative eigenvalue is a motion that
//! frees energy. Forces that follow the chain and moments about fixed axes make `T` unsymmetric: then a
//! neighbouring equilibrium exists where `det T = 0`, not where its symmetric part is indefinite
//! (Bolotin, Nonconservative Problems of the Theory of Elastic Stability, 1963). Below the latter
//! nothing goes away, whatever the masses are; above it the count here tells what the masses cannot change. A
//! flutter is not judged: with masses that favour it and no damping every unsymmetric `T` has one.
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

use crate::linalg::krylov::largest_eigenvalues;
use crate::linalg::saddle::inertia;

/// Number of motions in which a shape of tangent stiffness `tangent` (n x n, in units in which motions
/// count alike) goes away. Eigenvalues of the symmetric part down to `-zero` count as none. `whole`: no
/// motion of the shape was condensed out of it.
pub(crate) fn diverging_motions(tangent: &DMatrix<f64>, zero: f64, whole: bool) -> usize {
    let n = tangent.nrows();
    if n == 0 {
        return 0;
    }
    let symmetric = 0.5 * (tangent + tangent.transpose());
    let turns = (tangent - tangent.transpose()).amax() > TURNS_NOTHING * symmetric.amax();
    // Those above `zero` of the negative matrix.
    let shifted = DMatrix::from_fn(n, n, |i, j| {
        -symmetric[(i, j)] - if i == j { zero } else { 0.0 }
    });
    let unstable = inertia(shifted).positive;
    if unstable == 0 || !turns || (whole && unstable == n) {
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
    let most = all.iter().fold(0.0_f64, |m, x| m.max(x.norm()));
    // Two equal ones (a round rod) part by the root of what rounding leaves.
    let real = all.iter().filter(|x| x.im.abs() <= 1e-6 * most);
    real.filter(|x| x.re < 0.0).count()
}

/// Share of a tangent's largest entry below which what is not symmetric in it is rounding.
const TURNS_NOTHING: f64 = 1e-10;

#[cfg(test)]
mod tests {
    use super::*;

    /// Ziegler's column: two bars of length one, two springs of one, a force that follows the second
    /// bar by the share `a` of its turn. `T = K - P [1, -a; 0, 1 - a]`, `K = [2, -1; -1, 1]`.
    fn column(force: f64, a: f64) -> DMatrix<f64> {
        DMatrix::from_row_slice(
            2,
            2,
            &[2.0 - force, a * force - 1.0, -1.0, 1.0 - (1.0 - a) * force],
        )
    }

    #[test]
    fn a_follower_force_diverges_where_the_determinant_says() {
        // det = 1 - 3 (1 - a) P + (1 - a) P^2.
        for a in [0.0_f64, 0.2, 0.4, 0.5, 0.55] {
            let b = 1.0 - a;
            let root = (9.0 * b * b - 4.0 * b).max(0.0).sqrt();
            let (first, second) = ((3.0 * b - root) / (2.0 * b), (3.0 * b + root) / (2.0 * b));
            for (force, count) in [(0.0, 0), (first - 1e-6, 0), (first + 1e-6, 1)] {
                assert_eq!(
                    diverging_motions(&column(force, a), 0.0, true),
                    count,
                    "{a} {force}"
                );
            }
            assert_eq!(
                diverging_motions(&column(second - 1e-6, a), 0.0, true),
                1,
                "{a}"
            );
        }
        // Beyond a = 5/9 no force makes it diverge, though the symmetric part turns indefinite.
        for a in [0.56, 0.8, 1.0] {
            for force in [0.3, 1.0, 1.5, 1.9] {
                assert_eq!(
                    diverging_motions(&column(force, a), 0.0, true),
                    0,
                    "{a} {force}"
                );
            }
        }
    }

    fn random(state: &mut u64) -> f64 {
        *state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (*state >> 33) as f64 / (1_u64 << 30) as f64 - 1.0
    }

    /// Two motions are surely lost where the symmetric part is negative definite or the determinant
    /// negative; else there are masses with which both frequencies are real. The same in all units.
    #[test]
    fn of_two_motions_the_verdict_is_that_of_all_masses_in_all_units() {
        let mut state = 7;
        let mut seen = [0; 3];
        for case in 0..400 {
            let t = DMatrix::from_fn(2, 2, |_, _| random(&mut state));
            let skew = 3.0 * random(&mut state);
            let t = &t + DMatrix::from_row_slice(2, 2, &[-0.5, skew, -skew, -0.5]);
            let count = diverging_motions(&t, 0.0, true);
            let symmetric = 0.5 * (&t + t.transpose());
            let own = symmetric.symmetric_eigenvalues();
            let awaited = match (t.determinant() < 0.0, own.max() < 0.0) {
                (true, _) => 1,
                (false, true) => 2,
                (false, false) => 0,
            };
            assert_eq!(count, awaited, "case {case}: {t}");
            seen[count] += 1;
            let other = DMatrix::from_fn(2, 2, |_, _| random(&mut state));
            if other.determinant().abs() > 0.05 {
                let moved = other.transpose() * &t * &other;
                assert_eq!(
                    diverging_motions(&moved, 0.0, true),
                    awaited,
                    "case {case}: {t}"
                );
            }
            // Masses without end across the motion that the springs hold leave real frequencies.
            let eigen = symmetric.symmetric_eigen();
            let best = eigen.eigenvectors.column(eigen.eigenvalues.imax());
            let mut real_somewhere = false;
            for heavy in [1.0, 1e2, 1e4, 1e6, 1e8] {
                let light = best * best.transpose();
                let inverse = &light + (DMatrix::identity(2, 2) - &light) / heavy;
                let a = inverse * &t;
                let (trace, det) = (a.trace(), a.determinant());
                real_somewhere |= trace > 0.0 && det > 0.0 && trace * trace > 4.0 * det;
            }
            assert!(count == 0 || !real_somewhere, "case {case}: {t}");
            if count == 0 && own.max() > 1e-3 {
                assert!(real_somewhere, "case {case}: {t}");
            }
        }
        assert!(seen.iter().all(|n| *n > 30), "{seen:?}");
    }

    #[test]
    fn its_parity_is_the_sign_of_the_determinant() {
        let mut state = 1;
        let mut next = || random(&mut state);
        let mut counts = [0; 8];
        for case in 0..400 {
            let n = 2 + case % 6;
            let skew = [0.0, 0.3, 1.0][case % 3];
            let t = DMatrix::from_fn(n, n, |_, _| next());
            let shift = DMatrix::identity(n, n) * 0.5;
            let t = 0.5 * (&t + t.transpose()) + skew * 0.5 * (&t - t.transpose()) + shift;
            let count = diverging_motions(&t, 0.0, true);
            counts[count] += 1;
            assert_eq!(count % 2 == 1, t.determinant() < 0.0, "case {case}: {t}");
            if skew == 0.0 {
                let all = t.symmetric_eigenvalues();
                assert_eq!(count, all.iter().filter(|x| **x < 0.0).count());
            }
        }
        assert!(
            counts[0] > 50 && counts[1] > 50 && counts[2] > 20,
            "{counts:?}"
        );
    }
}
