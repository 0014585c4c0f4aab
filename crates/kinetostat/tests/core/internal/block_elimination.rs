//! Block elimination against dense systems.

use kinetostat::internal::{BlockFactors, Pivots, Sparse, inertia};
use kinetostat_testing::LargestEntry;
use nalgebra::DMatrix;

/// A symmetric system over a ring with chords: `stiff` on the diagonal of block `k`, a rigid
/// condition beside every third block.
struct Case {
    matrix: Sparse,
    nodes: Vec<usize>,
}

fn case(seed: u64, stiff: impl Fn(usize) -> f64, conditions: bool) -> Case {
    let mut seed = seed;
    let mut random = move || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (seed >> 33) as f64 / f64::from(1_u32 << 30) - 1.0
    };
    let count = 18;
    let mut nodes: Vec<usize> = (0..6 * count).map(|i| i / 6).collect();
    let mut entries = Vec::new();
    for k in 0..count {
        let ends = [(k + 1) % count, (k * k + 3) % count];
        for other in ends.into_iter().filter(|&other| other != k) {
            for i in 0..6 {
                for j in 0..6 {
                    let v = 0.3 * random();
                    entries.push((6 * k + i, 6 * other + j, v));
                    entries.push((6 * other + j, 6 * k + i, v));
                }
            }
        }
        for i in 0..6 {
            entries.push((6 * k + i, 6 * k + i, stiff(k)));
        }
    }
    if conditions {
        for k in (0..count - 1).step_by(3) {
            let row = nodes.len();
            nodes.push(k);
            for j in 0..12 {
                let v = random();
                entries.push((row, 6 * k + j, v));
                entries.push((6 * k + j, row, v));
            }
        }
    }
    let size = nodes.len();
    let matrix = Sparse {
        rows: size,
        columns: size,
        entries,
    };
    Case { matrix, nodes }
}

#[test]
fn blocks_solve_the_dense_system() {
    // Definite, indefinite, and with blocks that are zero until others are eliminated.
    let zeros = |k: usize| if k.is_multiple_of(2) { 0.0 } else { 2.0 };
    let cases = [
        case(1, |_| 4.0, false),
        case(2, |_| 4.0, true),
        case(3, |k| if k.is_multiple_of(2) { 4.0 } else { -4.0 }, true),
        case(4, zeros, false),
        case(5, zeros, true),
        case(6, |_| 0.0, false),
    ];
    for (number, own) in cases.into_iter().enumerate() {
        let size = own.nodes.len();
        let units: Vec<f64> = (0..size).map(|i| 1.0 + (i % 5) as f64 * 0.1).collect();
        let factors = BlockFactors::new(&own.matrix, &own.nodes, &units, Pivots::Any);
        let factors = factors.expect("a regular system");
        let dense = own.matrix.dense();
        let given = DMatrix::from_fn(size, 2, |i, j| ((i * 7 + j * 3) % 11) as f64 - 5.0);
        let mut found = given.clone();
        factors.solve(&mut found);
        let left = (&dense * &found - &given).largest_entry()
            / (dense.largest_entry() * found.largest_entry());
        assert!(left < 1e-14, "{number}: {left:e}");
        assert_eq!(factors.inertia().0, inertia(dense), "{number}");
    }
}

#[test]
fn a_singular_system_has_no_factors() {
    let mut own = case(7, |_| 4.0, true);
    // The last condition twice.
    let last = own.nodes.len() - 1;
    for (i, j, v) in own.matrix.entries.clone() {
        if i == last {
            own.matrix.entries.push((i + 1, j, v));
            own.matrix.entries.push((j, i + 1, v));
        }
    }
    own.nodes.push(own.nodes[last]);
    (own.matrix.rows, own.matrix.columns) = (last + 2, last + 2);
    let units = vec![1.0; last + 2];
    assert!(BlockFactors::new(&own.matrix, &own.nodes, &units, Pivots::Any).is_none());
}

#[test]
fn unknowns_without_entries_are_zero() {
    let matrix = Sparse {
        rows: 3,
        columns: 3,
        entries: vec![(0, 0, 2.0), (2, 2, 4.0)],
    };
    let factors = BlockFactors::new(&matrix, &[0, 0, 1], &[1.0; 3], Pivots::Any);
    let mut b = DMatrix::from_column_slice(3, 1, &[2.0, 5.0, 2.0]);
    factors.expect("regular").solve(&mut b);
    assert_eq!(b.as_slice(), &[1.0, 0.0, 0.5]);
}
