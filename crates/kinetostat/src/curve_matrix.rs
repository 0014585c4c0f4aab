//! `[G_u G_lambda]` at a state of a curve of equilibria, closed by one more row: the steps of Newton's
//! method across the curve, its tangent, and the determinant that changes its sign at bifurcations.
//!
//! Short chains have a dense matrix. Of a long chain a sweep makes what is needed
//! ([`crate::curve_sweep`]), with cost and memory that grow with the number of coordinates.

use nalgebra::{DMatrix, DVector};

use crate::curve_sweep::CurveSweep;
use crate::family::Family;
use crate::saddle::Saddle;

/// Sign and logarithm of a determinant, and the direction in which equilibrium persists.
pub(crate) struct Tangent {
    pub direction: DVector<f64>,
    /// Sign of `det [G_z; t^T]`: it changes at a simple bifurcation.
    pub sign: f64,
    pub logarithm: f64,
}

impl Tangent {
    /// From the solution of `[G_z; p^T] solution = (0, 1)` and the determinant of that matrix.
    pub fn new(solution: &DVector<f64>, sign: f64, logarithm: f64) -> Option<Self> {
        let norm = solution.norm();
        if !norm.is_finite() || norm == 0.0 {
            return None;
        }
        // det [A; t] = det [A; p] / (p . t), and p . t = 1 / norm.
        Some(Self {
            direction: solution / norm,
            sign,
            logarithm: logarithm + norm.ln(),
        })
    }
}

/// `[dG/du dG/dlambda]`, m x (m + 1), balanced.
pub(crate) enum CurveMatrix {
    /// All of it.
    Dense(DMatrix<f64>),
    /// Of a long chain.
    Swept(Box<CurveSweep>),
}

impl CurveMatrix {
    /// `dG/dlambda`.
    pub fn gradient(&self) -> DVector<f64> {
        match self {
            Self::Dense(matrix) => matrix.column(matrix.ncols() - 1).into_owned(),
            Self::Swept(sweep) => sweep.gradient.clone(),
        }
    }

    pub fn is_finite(&self) -> bool {
        match self {
            Self::Dense(matrix) => matrix.iter().all(|v| v.is_finite()),
            Self::Swept(sweep) => sweep.gradient.iter().all(|v| v.is_finite()),
        }
    }

    /// Step that removes `lack` and `miss` in `[matrix; normal^T]`; the shortest one where that is
    /// singular. Along a family there is none. `None` if a sweep lost too much.
    pub fn step(
        &self,
        normal: &DVector<f64>,
        lack: &DVector<f64>,
        miss: f64,
        family: Option<&Family>,
    ) -> Option<DVector<f64>> {
        let matrix = match self {
            Self::Dense(matrix) => matrix,
            Self::Swept(sweep) => return sweep.closed_by(normal).solve(&-lack, -miss),
        };
        let m = matrix.nrows();
        let a = family.map_or_else(|| bordered(matrix, normal), |f| f.bordered(matrix, normal));
        let ones = vec![1.0; a.nrows()];
        let mut b = DMatrix::zeros(a.nrows(), 1);
        for i in 0..m {
            b[(i, 0)] = -lack[i];
        }
        b[(m, 0)] = -miss;
        Saddle::new(a, &ones, &ones).solve(&mut b);
        Some(b.view((0, 0), (m + 1, 1)).column(0).into_owned())
    }

    /// Tangent, oriented along `guide`, at rest along the motions of a family.
    pub fn tangent(&self, guide: &DVector<f64>, family: Option<&Family>) -> Option<Tangent> {
        let matrix = match self {
            Self::Dense(matrix) => matrix,
            Self::Swept(sweep) => return sweep.closed_by(guide).tangent(),
        };
        let m = matrix.nrows();
        let lu = family
            .map_or_else(|| bordered(matrix, guide), |f| f.bordered(matrix, guide))
            .lu();
        let (sign, logarithm) = determinant(&lu);
        let mut unit = DVector::zeros(lu.l().nrows());
        unit[m] = 1.0;
        Tangent::new(
            &lu.solve(&unit)?.rows(0, m + 1).into_owned(),
            sign,
            logarithm,
        )
    }

    /// The tangent, if a sweep shows that the null direction is the only one: no matrix closed by it
    /// is nearly singular. `None` says nothing.
    pub fn only_direction(&self) -> Option<DVector<f64>> {
        match self {
            Self::Dense(_) => None,
            Self::Swept(sweep) => sweep.only_direction(),
        }
    }
}

/// Sign and logarithm of the size of a determinant.
pub(crate) fn determinant(lu: &nalgebra::LU<f64, nalgebra::Dyn, nalgebra::Dyn>) -> (f64, f64) {
    let mut sign: f64 = lu.p().determinant();
    let mut logarithm = 0.0;
    for pivot in lu.lu_internal().diagonal().iter() {
        sign *= pivot.signum();
        logarithm += pivot.abs().max(1e-300).ln();
    }
    (sign, logarithm)
}

/// `[matrix; normal^T]`.
fn bordered(matrix: &DMatrix<f64>, normal: &DVector<f64>) -> DMatrix<f64> {
    let m = matrix.nrows();
    let mut a = DMatrix::zeros(m + 1, m + 1);
    a.rows_mut(0, m).copy_from(matrix);
    a.row_mut(m).copy_from(&normal.transpose());
    a
}
