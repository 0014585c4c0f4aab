//! Families of equilibria: at one value of the parameter a chain can stand in a whole continuum of
//! shapes that differ by a motion which costs nothing (a buckled round rod turned about its axis, a
//! hinge at the tip that nothing holds).
//!
//! On the curves of a family `G_z` has more null directions than the curve's own, everywhere, and
//! the usual test functions are rounding. The further null directions `V` and the left null vectors
//! `Psi` that belong to them are taken out by a border,
//!
//! ```text
//! | G_z  Psi |
//! | t^T   0  |
//! | V^T   0  |
//! ```
//!
//! which is regular along the curve and changes the sign of its determinant at true bifurcations
//! only. The curve itself is followed at rest along `V` (a phase condition).

use nalgebra::{DMatrix, DVector};

use crate::continuation::linear::tangent::Whole;

/// Motions that lead from one equilibrium to another at the same value of the parameter.
#[derive(Clone, Debug)]
pub(crate) struct Family {
    /// Neutral directions of the state, orthonormal, (m + 1) x k.
    pub motions: DMatrix<f64>,
    /// Left null vectors of `G_z` that belong to them, orthonormal, m x k.
    lefts: DMatrix<f64>,
}

impl Family {
    pub fn new(motions: DMatrix<f64>, lefts: DMatrix<f64>) -> Self {
        Self { motions, lefts }
    }

    /// The matrix above, (m + 1 + k) square, `t` in row `m`.
    pub fn bordered(&self, matrix: &DMatrix<f64>, t: &DVector<f64>) -> DMatrix<f64> {
        let (m, k) = (matrix.nrows(), self.motions.ncols());
        let mut a = DMatrix::zeros(m + 1 + k, m + 1 + k);
        a.view_mut((0, 0), (m, m + 1)).copy_from(matrix);
        a.view_mut((0, m + 1), (m, k)).copy_from(&self.lefts);
        a.view_mut((m, 0), (1, m + 1)).copy_from(&t.transpose());
        a.view_mut((m + 1, 0), (k, m + 1))
            .copy_from(&self.motions.transpose());
        a
    }

    /// `[matrix; V^T]`: its null directions are those of the matrix that are not the family's.
    pub fn beside(&self, matrix: &DMatrix<f64>) -> DMatrix<f64> {
        let (m, k) = (matrix.nrows(), self.motions.ncols());
        let mut a = matrix.clone().resize_vertically(m + k, 0.0);
        a.rows_mut(m, k)
            .copy_from(&(self.motions.transpose() * matrix.amax()));
        a
    }

    /// `[matrix Psi]`: its left null vectors are those of the matrix that are not the family's.
    pub fn beside_left(&self, matrix: &DMatrix<f64>) -> DMatrix<f64> {
        let (n, k) = (matrix.ncols(), self.lefts.ncols());
        let mut a = matrix.clone().resize_horizontally(n + k, 0.0);
        a.columns_mut(n, k)
            .copy_from(&(&self.lefts * matrix.amax()));
        a
    }

    /// The family at a neighbouring state, with the orientation kept; `None` if it is too far away.
    pub fn carried(&self, whole: &Whole, t: &DVector<f64>) -> Option<Self> {
        let matrix = &whole.matrix;
        let (m, k) = (matrix.nrows(), self.motions.ncols());
        let a = self.bordered(matrix, t);
        let mut unit = DMatrix::zeros(m + 1 + k, k);
        for i in 0..k {
            unit[(m + 1 + i, i)] = 1.0;
        }
        let (motions, ..) = whole.regular(a.clone(), &unit)?;
        let (lefts, ..) = whole.regular(a.transpose(), &unit)?;
        let motions = motions.rows(0, m + 1).into_owned();
        let lefts = lefts.rows(0, m).into_owned();
        let motions = neutral_part(motions, t)?;
        let near = (self.motions.transpose() * &motions).determinant() > 0.5;
        let lefts = orthonormal(lefts)?;
        near.then_some(Self { motions, lefts })
    }

    /// True if the family's motions turn one of two directions of a null space into the other.
    pub fn joins(&self, from: &DVector<f64>, to: &DVector<f64>) -> bool {
        let mut left = to - from * from.dot(to);
        left -= &self.motions * (self.motions.transpose() * &left);
        left.norm() < 0.5 * to.norm()
    }
}

/// Null directions `motions` without their part along `t` that changes the parameter.
fn neutral_part(mut motions: DMatrix<f64>, t: &DVector<f64>) -> Option<DMatrix<f64>> {
    let last = t.len() - 1;
    if t[last].abs() > 1e-2 {
        for mut v in motions.column_iter_mut() {
            let share = v[last] / t[last];
            v.axpy(-share, t, 1.0);
        }
    }
    orthonormal(motions)
}

/// Gram-Schmidt, the orientation kept.
fn orthonormal(mut a: DMatrix<f64>) -> Option<DMatrix<f64>> {
    for j in 0..a.ncols() {
        let mut v = a.column(j).into_owned();
        let size = v.norm();
        for _ in 0..2 {
            for i in 0..j {
                let share = a.column(i).dot(&v);
                v.axpy(-share, &a.column(i), 1.0);
            }
        }
        let norm = v.norm();
        if !(norm.is_finite() && norm > 1e-6 * size) {
            return None;
        }
        a.set_column(j, &(v / norm));
    }
    Some(a)
}
