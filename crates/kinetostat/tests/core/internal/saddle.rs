//! Shortest solutions, inertia and complements.

use kinetostat::internal::{Saddle, complement, inertia, pseudo_inverse};
use nalgebra::DMatrix;

#[test]
fn singular_systems_get_the_shortest_solution_and_their_rank() {
    let a = DMatrix::from_row_slice(3, 3, &[2.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 1.0, 1.0]);
    assert_eq!(pseudo_inverse(&a).1, 2);
    let saddle = Saddle::new(a, &[1.0; 3], &[1.0; 3]);
    let mut b = DMatrix::from_row_slice(3, 1, &[4.0, 2.0, 2.0]);
    saddle.solve(&mut b);
    assert!((b - DMatrix::from_row_slice(3, 1, &[2.0, 1.0, 1.0])).norm() < 1e-12);
}

#[test]
fn inertia_agrees_with_the_eigenvalues_of_random_matrices() {
    let mut seed = 1_u64;
    let mut random = move || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (seed >> 33) as f64 / f64::from(1_u32 << 30) - 1.0
    };
    for n in 1..20 {
        let m = DMatrix::from_fn(n, n, |_, _| random());
        let a = &m + m.transpose();
        let eigenvalues = a.clone().symmetric_eigenvalues();
        let found = inertia(a);
        assert_eq!(
            found.positive,
            eigenvalues.iter().filter(|x| **x > 0.0).count()
        );
        assert_eq!(
            found.negative,
            eigenvalues.iter().filter(|x| **x < 0.0).count()
        );
    }
}

#[test]
fn complement_is_orthonormal_and_orthogonal() {
    let a = DMatrix::from_fn(7, 3, |i, j| {
        ((i * 3 + j * 5) % 7) as f64 - 2.0 + 0.1 * i as f64
    });
    let n = complement(&a);
    assert_eq!(n.shape(), (7, 4));
    assert!((n.transpose() * &a).norm() < 1e-12);
    assert!((n.transpose() * &n - DMatrix::identity(4, 4)).norm() < 1e-12);
}
