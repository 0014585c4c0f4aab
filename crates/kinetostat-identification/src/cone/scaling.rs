//! Scaling of a pair of primal and dual matrices.

use std::f64::consts::FRAC_1_SQRT_2;

use nalgebra::{DMatrix, DVector};

use super::symmetric::{singular, triangle_from_symmetric};

/// Scaling of Nesterov and Todd of a pair `X = G S G^T`, `Z = G^-T S G^-1` with `G = U diag(g)` and `S = E diag(s) E^T`.
///
/// `U` and `E` are orthogonal; near the central path `S` is about a multiple of the identity. Any `G Q` with orthogonal `Q` would do.
/// This choice has columns of very different size, but orthogonal ones: small eigenvalues of `X` and `Z` keep all their digits.
pub(super) struct Scaling {
    u: DMatrix<f64>,
    g: DVector<f64>,
    e: DMatrix<f64>,
    /// Eigenvalues of `S`.
    pub s: DVector<f64>,
}

impl Scaling {
    /// Scaling of `X = x I` and `Z = z I`.
    pub fn of_multiples(x: f64, z: f64, n: usize) -> Self {
        Self {
            u: DMatrix::identity(n, n),
            g: DVector::from_element(n, (x / z).sqrt().sqrt()),
            e: DMatrix::identity(n, n),
            s: DVector::from_element(n, (x * z).sqrt()),
        }
    }

    /// Scaled point `S`.
    pub fn point(&self) -> DMatrix<f64> {
        &self.e * DMatrix::from_diagonal(&self.s) * self.e.transpose()
    }

    /// Upper triangle of `X`.
    pub fn primal(&self) -> DVector<f64> {
        let g = &self.u * DMatrix::from_diagonal(&self.g);
        triangle_from_symmetric(&(&g * self.point() * g.transpose()))
    }

    /// Upper triangle of `Z`.
    pub fn dual(&self) -> DVector<f64> {
        let inverse = &self.u * DMatrix::from_diagonal(&self.g.map(|g| 1.0 / g));
        triangle_from_symmetric(&(&inverse * self.point() * inverse.transpose()))
    }

    /// Matrix of the map from scaled triangles `V` to triangles of `G V G^T`.
    pub fn map(&self) -> DMatrix<f64> {
        let n = self.s.len();
        let mut columns = Vec::with_capacity(n * (n + 1) / 2);
        for i in 0..n {
            for k in i..n {
                let size = self.g[i] * self.g[k];
                let outer = self.u.column(i) * self.u.column(k).transpose();
                let symmetric = if i == k {
                    outer * size
                } else {
                    (&outer + outer.transpose()) * (size * FRAC_1_SQRT_2)
                };
                columns.push(triangle_from_symmetric(&symmetric));
            }
        }
        DMatrix::from_columns(&columns)
    }

    /// Solution `V` of `(S V + V S) / 2 = right`.
    pub fn divide(&self, right: &DMatrix<f64>) -> DMatrix<f64> {
        let mut rotated = self.e.tr_mul(right) * &self.e;
        for i in 0..self.s.len() {
            for k in 0..self.s.len() {
                rotated[(i, k)] *= 2.0 / (self.s[i] + self.s[k]);
            }
        }
        &self.e * rotated * self.e.transpose()
    }

    /// Longest step from `S` along `direction` that stays semi-definite.
    pub fn longest_step(&self, direction: &DMatrix<f64>) -> f64 {
        let root = &self.e * DMatrix::from_diagonal(&self.s.map(|s| 1.0 / s.sqrt()));
        let relative = root.tr_mul(direction) * &root;
        let smallest = relative.symmetric_eigenvalues().min();
        if smallest < 0.0 {
            -1.0 / smallest
        } else {
            f64::INFINITY
        }
    }

    /// Scaling after a step; `None` if rounding errors made a matrix indefinite.
    pub fn step(&self, primal: &DMatrix<f64>, dual: &DMatrix<f64>, length: f64) -> Option<Self> {
        let point = self.point();
        let a = (&point + primal * length).cholesky()?.unpack();
        let b = (&point + dual * length).cholesky()?.unpack();
        // G A V diag(s)^-1/2 is a scaling of the new pair, then an orthogonal factor is split off on the right.
        let (v, _, s) = singular(b.tr_mul(&a));
        let change = a * v * DMatrix::from_diagonal(&s.map(|s| 1.0 / s.sqrt()));
        let (rotation, right, g) = singular(change.tr_mul(&DMatrix::from_diagonal(&self.g)));
        let is_positive = s.iter().chain(&g).all(|&x| x > 0.0 && x.is_finite());
        is_positive.then(|| Self {
            u: &self.u * rotation,
            g,
            e: right.transpose(),
            s,
        })
    }
}
