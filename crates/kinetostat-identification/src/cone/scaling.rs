//! Scaling of a pair of primal and dual matrices.

use kinetostat::linalg::SingularValues;
use nalgebra::{DMatrix, DVector};

use super::symmetric::{symmetric_from_triangle, triangle_from_symmetric};

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

    /// `X` and `Z`.
    pub fn pair(&self) -> [DMatrix<f64>; 2] {
        [self.g.clone(), self.g.map(f64::recip)].map(|sizes| {
            let g = &self.u * DMatrix::from_diagonal(&sizes);
            &g * self.point() * g.transpose()
        })
    }

    /// Matrix of the map from scaled triangles `V` to triangles of `G V G^T`.
    pub fn map(&self) -> DMatrix<f64> {
        let n = self.s.len();
        let g = &self.u * DMatrix::from_diagonal(&self.g);
        let mut map = DMatrix::identity(n * (n + 1) / 2, n * (n + 1) / 2);
        for mut column in map.column_iter_mut() {
            let v = symmetric_from_triangle(column.as_slice(), n);
            column.copy_from(&triangle_from_symmetric(&(&g * v * g.transpose())));
        }
        map
    }

    /// Solution `V` of `(S V + V S) / 2 = right`.
    pub fn divide(&self, right: &DMatrix<f64>) -> DMatrix<f64> {
        let rotated = self.e.tr_mul(right) * &self.e;
        let sums = DMatrix::from_fn(self.s.len(), self.s.len(), |i, k| self.s[i] + self.s[k]);
        &self.e * rotated.component_div(&sums) * self.e.transpose() * 2.0
    }

    /// Longest step from `S` along `direction` that stays semi-definite.
    pub fn longest_step(&self, direction: &DMatrix<f64>) -> f64 {
        let root = &self.e * DMatrix::from_diagonal(&self.s.map(|s| 1.0 / s.sqrt()));
        let relative = root.tr_mul(direction) * &root;
        // Infinite if no eigenvalue is negative.
        1.0 / (-relative.symmetric_eigenvalues().min()).max(0.0)
    }

    /// Scaling after a step; `None` if rounding errors made a matrix indefinite.
    pub fn step(&self, primal: &DMatrix<f64>, dual: &DMatrix<f64>, length: f64) -> Option<Self> {
        let point = self.point();
        let a = (&point + primal * length).cholesky()?.unpack();
        let b = (&point + dual * length).cholesky()?.unpack();
        // G A V diag(s)^-1/2 is a scaling of the new pair, then an orthogonal factor is split off on the right.
        let balanced = SingularValues::of(&b.tr_mul(&a));
        let s = DVector::from_vec(balanced.values);
        let change = a * balanced.right * DMatrix::from_diagonal(&s.map(|s| 1.0 / s.sqrt()));
        let split = SingularValues::of(&change.tr_mul(&DMatrix::from_diagonal(&self.g)));
        let g = DVector::from_vec(split.values);
        let is_positive = s.iter().chain(&g).all(|&x| x > 0.0 && x.is_finite());
        is_positive.then(|| Self {
            u: &self.u * split.right,
            g,
            e: split.left.transpose(),
            s,
        })
    }
}
