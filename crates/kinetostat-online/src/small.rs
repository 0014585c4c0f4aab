//! Factors of small dense matrices in buffers of the caller: a cycle may not allocate.

/// Smallest pivot as a share of the largest one (of a matrix in units that make its entries comparable).
const SMALLEST_PIVOT: f64 = 1e-13;

/// Cholesky factor of a symmetric positive definite matrix in place (`n` rows of `n`, lower triangle); false if it is singular.
pub(crate) fn cholesky(a: &mut [f64], n: usize) -> bool {
    let largest = (0..n).fold(0.0_f64, |most, i| most.max(a[i * n + i]));
    for j in 0..n {
        for k in 0..j {
            let factor = a[j * n + k];
            for i in j..n {
                a[i * n + j] -= a[i * n + k] * factor;
            }
        }
        let pivot = a[j * n + j];
        if pivot.is_nan() || pivot <= SMALLEST_PIVOT * largest {
            return false;
        }
        let root = pivot.sqrt();
        for i in j..n {
            a[i * n + j] /= root;
        }
    }
    true
}

/// Solves with the factor of [`cholesky`] in place.
pub(crate) fn solve_cholesky(l: &[f64], n: usize, x: &mut [f64]) {
    for i in 0..n {
        for k in 0..i {
            x[i] -= l[i * n + k] * x[k];
        }
        x[i] /= l[i * n + i];
    }
    for i in (0..n).rev() {
        for k in i + 1..n {
            x[i] -= l[k * n + i] * x[k];
        }
        x[i] /= l[i * n + i];
    }
}

/// Factors `P A = L U` of a square matrix of at most `N` rows.
#[derive(Clone, Debug)]
pub(crate) struct Lu<const N: usize> {
    n: usize,
    a: [[f64; N]; N],
    row: [usize; N],
}

impl<const N: usize> Lu<N> {
    pub(crate) fn new() -> Self {
        Self {
            n: 0,
            a: [[0.0; N]; N],
            row: [0; N],
        }
    }

    /// Factors the matrix that `entry` gives, with partial pivoting; false if it is singular.
    pub(crate) fn factor(&mut self, n: usize, entry: impl Fn(usize, usize) -> f64) -> bool {
        self.n = n;
        let mut largest = 0.0_f64;
        for i in 0..n {
            self.row[i] = i;
            for j in 0..n {
                self.a[i][j] = entry(i, j);
                largest = largest.max(self.a[i][j].abs());
            }
        }
        for k in 0..n {
            let mut best = k;
            for i in k + 1..n {
                if self.a[i][k].abs() > self.a[best][k].abs() {
                    best = i;
                }
            }
            self.a.swap(k, best);
            self.row.swap(k, best);
            let pivot = self.a[k][k];
            if pivot.is_nan() || pivot.abs() <= SMALLEST_PIVOT * largest {
                return false;
            }
            for i in k + 1..n {
                let factor = self.a[i][k] / pivot;
                self.a[i][k] = factor;
                for j in k + 1..n {
                    self.a[i][j] -= factor * self.a[k][j];
                }
            }
        }
        true
    }

    /// The solution for a right-hand side.
    pub(crate) fn solve(&self, b: &[f64; N]) -> [f64; N] {
        let mut x = [0.0; N];
        for i in 0..self.n {
            x[i] = b[self.row[i]];
            for k in 0..i {
                x[i] -= self.a[i][k] * x[k];
            }
        }
        for i in (0..self.n).rev() {
            for k in i + 1..self.n {
                x[i] -= self.a[i][k] * x[k];
            }
            x[i] /= self.a[i][i];
        }
        x
    }
}
