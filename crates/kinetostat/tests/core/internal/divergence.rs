//! Motions that run away under loads that follow: closed forms and random matrices.

use kinetostat::internal::{TangentMotions, diverging_motions};
use nalgebra::DMatrix;

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
                diverging_motions(&column(force, a), 0.0, TangentMotions::All),
                count,
                "{a} {force}"
            );
        }
        assert_eq!(
            diverging_motions(&column(second - 1e-6, a), 0.0, TangentMotions::All),
            1,
            "{a}"
        );
    }
    // Beyond a = 5/9 no force makes it diverge, though the symmetric part turns indefinite.
    for a in [0.56, 0.8, 1.0] {
        for force in [0.3, 1.0, 1.5, 1.9] {
            assert_eq!(
                diverging_motions(&column(force, a), 0.0, TangentMotions::All),
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
fn of_two_motions_the_stability_is_that_of_all_masses_in_all_units() {
    let mut state = 7;
    let mut seen = [0; 3];
    for case in 0..400 {
        let t = DMatrix::from_fn(2, 2, |_, _| random(&mut state));
        let skew = 3.0 * random(&mut state);
        let t = &t + DMatrix::from_row_slice(2, 2, &[-0.5, skew, -skew, -0.5]);
        let count = diverging_motions(&t, 0.0, TangentMotions::All);
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
                diverging_motions(&moved, 0.0, TangentMotions::All),
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
        let count = diverging_motions(&t, 0.0, TangentMotions::All);
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
