//! Factors of small dense matrices without allocating.

use nalgebra::SMatrix;

/// Smallest pivot as a share of the largest entry, of matrices in units that make their entries comparable.
const SMALLEST_PIVOT: f64 = 1e-13;

/// Factors `P A = L U` of a square matrix of at most `N` rows.
#[derive(Clone, Debug)]
pub(crate) struct Lu<const N: usize> {
    n: usize,
    a: SMatrix<f64, N, N>,
    row: [usize; N],
}

impl<const N: usize> Lu<N> {
    pub(crate) fn new() -> Self {
        Self {
            n: 0,
            a: SMatrix::zeros(),
            row: [0; N],
        }
    }

    /// Factors the matrix of `n` rows that `entry` gives, with partial pivoting; false if it is singular or not finite.
    pub(crate) fn factor(&mut self, n: usize, entry: impl Fn(usize, usize) -> f64) -> bool {
        self.n = n;
        self.row = std::array::from_fn(|i| i);
        self.a = SMatrix::from_fn(|i, j| if i < n && j < n { entry(i, j) } else { 0.0 });
        let least = SMALLEST_PIVOT
            * self
                .a
                .iter()
                .fold(0.0, |most, x| kinetostat::number::larger(most, x.abs()));
        let a = &mut self.a;
        for k in 0..n {
            let column = (k..n).map(|i| (i, a[(i, k)].abs()));
            let (best, pivot) = column.fold((k, 0.0), |b, c| if c.1 > b.1 { c } else { b });
            if pivot <= least {
                return false;
            }
            a.swap_rows(k, best);
            self.row.swap(k, best);
            for i in k + 1..n {
                a[(i, k)] /= a[(k, k)];
                for j in k + 1..n {
                    a[(i, j)] -= a[(i, k)] * a[(k, j)];
                }
            }
        }
        a.iter().all(|x| x.is_finite())
    }

    /// The solution for a right-hand side.
    pub(crate) fn solve(&self, b: &[f64; N]) -> [f64; N] {
        let (n, a, mut x) = (self.n, &self.a, [0.0; N]);
        for i in 0..n {
            x[i] = b[self.row[i]] - (0..i).map(|k| a[(i, k)] * x[k]).sum::<f64>();
        }
        for i in (0..n).rev() {
            x[i] = (x[i] - (i + 1..n).map(|k| a[(i, k)] * x[k]).sum::<f64>()) / a[(i, i)];
        }
        x
    }
}
