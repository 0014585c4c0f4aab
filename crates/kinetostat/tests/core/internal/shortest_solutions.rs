//! Shortest solutions without singular values against those by singular values.

use kinetostat::internal::shortest_and_free;
use kinetostat::linalg::SingularValues;
use kinetostat_testing::LargestEntry;
use nalgebra::{DMatrix, DVector};

/// Even numbers between -1 and 1, the same every time.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005);
        self.0 = self.0.wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn matrix(&mut self, rows: usize, columns: usize) -> DMatrix<f64> {
        DMatrix::from_fn(rows, columns, |_, _| self.next())
    }
}

#[test]
fn shortest_solutions_are_those_by_singular_values() {
    let mut numbers = Numbers(7);
    for round in 0..2000 {
        let (m, n) = (1 + round % 29, 1 + (round / 29) % 31);
        let rank = 1 + round % m.min(n);
        // Values that repeat, over up to five decades.
        let decades = (round % 6) as f64;
        let values = DVector::from_fn(rank, |i, _| {
            10.0_f64.powf(-decades * (i / 3) as f64 / (1 + rank / 3) as f64)
        });
        let own = |random: DMatrix<f64>| random.qr().q();
        let left = own(numbers.matrix(m, rank));
        let right = own(numbers.matrix(n, rank));
        let a = left * DMatrix::from_diagonal(&values) * right.transpose();
        let b = DVector::from_fn(m, |_, _| numbers.next());
        let (x, free) = shortest_and_free(&a, &b, 1e-9).expect("finite numbers");
        let by_values = SingularValues::of(&a);
        let expected = by_values.shortest(&b, 1e-9 * by_values.largest());
        let scale = 10.0_f64.powf(decades);
        let off = (&x - &expected).largest_entry();
        assert!(
            off <= 1e-13 * scale * scale,
            "{m} x {n}, rank {rank}: {off:e}"
        );
        assert_eq!(free.shape(), (n, n - rank), "{m} x {n}, rank {rank}");
        let square = free.transpose() * &free - DMatrix::identity(n - rank, n - rank);
        if rank < n {
            assert!(
                (&a * &free).largest_entry() <= 1e-13,
                "{m} x {n}, rank {rank}"
            );
            assert!(square.largest_entry() <= 1e-13, "{m} x {n}, rank {rank}");
            assert!((free.transpose() * &x).largest_entry() <= 1e-13 * (1.0 + x.largest_entry()));
        }
    }
    // Doubtful ranks are left to the singular values; odd numbers have no answer.
    let doubtful = DMatrix::from_diagonal(&DVector::from_vec(vec![1.0, 2e-9, 0.5e-9]));
    let (_, free) = shortest_and_free(&doubtful, &DVector::zeros(3), 1e-9).expect("finite");
    assert_eq!(free.ncols(), 1);
    let odd = DMatrix::from_element(2, 2, f64::NAN);
    assert!(shortest_and_free(&odd, &DVector::zeros(2), 1e-9).is_none());
}
