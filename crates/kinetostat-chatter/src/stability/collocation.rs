//! Chebyshev collocation of a mode on a stretch of time.

use std::f64::consts::PI;

use nalgebra::{DMatrix, DVector};

use crate::number::Complex64;

/// Nodes of a stretch and the derivative there, for polynomials that vanish at its beginning.
#[derive(Clone, Debug)]
pub(crate) struct Chebyshev {
    /// Shares of the stretch, above 0 and up to 1.
    pub(crate) nodes: Vec<f64>,
    /// Derivative by the share of the stretch, of a polynomial that is 0 at its beginning.
    derivative: DMatrix<f64>,
}

impl Chebyshev {
    /// So many nodes, the beginning not counted.
    pub(crate) fn new(points: usize) -> Self {
        let n = points.max(1);
        let all: Vec<f64> = (0..=n)
            .map(|i| 0.5 * (1.0 - (PI * i as f64 / n as f64).cos()))
            .collect();
        let weight = |i: usize| {
            let sign = if i.is_multiple_of(2) { 1.0 } else { -1.0 };
            if i == 0 || i == n { 0.5 * sign } else { sign }
        };
        let mut derivative = DMatrix::zeros(n, n);
        for i in 1..=n {
            let mut sum = 0.0;
            for j in 0..=n {
                if i == j {
                    continue;
                }
                // Differences of cosines by a product, without cancellation.
                let half = 0.5 * PI / n as f64;
                let apart = (half * (i + j) as f64).sin() * (half * (i as f64 - j as f64)).sin();
                let entry = weight(j) / weight(i) / apart;
                sum += entry;
                if j > 0 {
                    derivative[(i - 1, j - 1)] = entry;
                }
            }
            derivative[(i - 1, i - 1)] = -sum;
        }
        Self {
            nodes: all[1..].to_vec(),
            derivative,
        }
    }

    /// The matrix that takes values of `g` at the nodes to those of `u` with `u' = root u + g`, `u = 0` at the beginning, on a
    /// stretch so long, s.
    pub(crate) fn convolution(&self, root: Complex64, duration: f64) -> Option<DMatrix<Complex64>> {
        let mut matrix = self
            .derivative
            .map(|entry| Complex64::from(entry / duration));
        for i in 0..matrix.nrows() {
            matrix[(i, i)] -= root;
        }
        matrix.try_inverse()
    }

    /// Weights with which values at the nodes give the integral over a stretch so long, s.
    pub(crate) fn weights(&self, duration: f64) -> Option<DVector<f64>> {
        let n = self.nodes.len();
        // The end of the antiderivative is its last value: one row of the inverse.
        let mut last = DVector::zeros(n);
        last[n - 1] = duration;
        self.derivative.transpose().lu().solve(&last)
    }

    /// The matrix that takes values at these nodes to those at others: the polynomial through them.
    pub(crate) fn to(&self, others: &[f64]) -> DMatrix<f64> {
        let n = self.nodes.len();
        let weight = |i: usize| {
            // Those of all nodes, times the distance from the beginning, which is none.
            let sign = if i.is_multiple_of(2) { 1.0 } else { -1.0 };
            let end = if i + 1 == n { 0.5 } else { 1.0 };
            sign * end * self.nodes[i]
        };
        DMatrix::from_fn(others.len(), n, |row, i| {
            let x = others[row];
            match self.nodes.iter().position(|node| *node == x) {
                Some(at) => f64::from(u8::from(at == i)),
                None => {
                    let sum: f64 = (0..n).map(|j| weight(j) / (x - self.nodes[j])).sum();
                    weight(i) / (x - self.nodes[i]) / sum
                }
            }
        })
    }
}
