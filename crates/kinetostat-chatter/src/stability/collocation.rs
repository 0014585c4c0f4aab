//! Points of a stretch of time, and polynomials through the values there.

use std::f64::consts::PI;

use nalgebra::{DMatrix, DVector};

use crate::stability::legendre;

/// Chebyshev's points of a stretch, without its beginning.
#[derive(Clone, Debug)]
pub(crate) struct Chebyshev {
    /// Shares of the stretch, above 0 and up to 1.
    pub(crate) nodes: Vec<f64>,
}

impl Chebyshev {
    /// Creates so many nodes, the beginning not counted.
    pub(crate) fn new(points: usize) -> Self {
        let n = points.max(1);
        let node = |i: usize| (0.5 * PI * i as f64 / n as f64).sin().powi(2);
        Self {
            nodes: (1..=n).map(node).collect(),
        }
    }

    /// Values at the nodes (a row each) of Legendre's polynomials up to a degree.
    pub(crate) fn polynomials(&self, degree: usize) -> DMatrix<f64> {
        legendre::polynomials(degree, &self.nodes).transpose()
    }

    /// The matrix that takes values at the nodes to coefficients of Legendre's polynomials.
    pub(crate) fn coefficients(&self) -> Option<DMatrix<f64>> {
        self.polynomials(self.nodes.len() - 1).try_inverse()
    }

    /// Weights with which values at the nodes give the integral over a stretch so long, s.
    ///
    /// Those of Clenshaw and Curtis for all nodes and the beginning; the polynomial through the nodes has there the value at
    /// which the highest divided difference is none.
    pub(crate) fn weights(&self, duration: f64) -> DVector<f64> {
        let n = self.nodes.len();
        let weight = |i: usize| {
            let sum: f64 = (1..=n / 2)
                .map(|j| {
                    let half = if 2 * j == n { 0.5 } else { 1.0 };
                    let turn = 2.0 * PI * ((i * j) % n) as f64 / n as f64;
                    2.0 * half * turn.cos() / (4.0 * (j * j) as f64 - 1.0)
                })
                .sum();
            let end = if i == 0 || i == n { 0.5 } else { 1.0 };
            end * (1.0 - sum) / n as f64
        };
        let beginning = weight(0);
        DVector::from_fn(n, |row, _| {
            let i = row + 1;
            let sign = if i.is_multiple_of(2) { -1.0 } else { 1.0 };
            let end = if i == n { 1.0 } else { 2.0 };
            duration * (weight(i) + beginning * sign * end)
        })
    }
}
