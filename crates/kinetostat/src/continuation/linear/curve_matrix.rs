//! `[G_u G_lambda]` at a state of a curve of equilibria, closed by one more row: the steps of Newton's
//! method across the curve, its tangent, and the determinant that changes its sign at bifurcations.
//!
//! Short chains have a dense matrix. Of a long chain a sweep makes what is needed
//! ([`crate::continuation::linear::curve_sweep`]), with cost and memory that grow with the number of coordinates.

use nalgebra::{DMatrix, DVector};

use crate::continuation::linear::curve_sweep::CurveSweep;
use crate::continuation::linear::family::Family;
use crate::continuation::linear::tangent::{Tangent, Whole, bordered};

/// `[dG/du dG/dlambda]`, m x (m + 1), scaled.
pub(crate) enum CurveMatrix {
    /// All of it.
    Dense(Whole),
    /// Matrix of a long chain.
    Swept(Box<CurveSweep>),
}

impl CurveMatrix {
    /// `dG/dlambda`.
    pub fn gradient(&self) -> DVector<f64> {
        match self {
            Self::Dense(own) => own.matrix.column(own.matrix.ncols() - 1).into_owned(),
            Self::Swept(sweep) => sweep.gradient.clone(),
        }
    }

    pub fn is_finite(&self) -> bool {
        match self {
            Self::Dense(own) => own.matrix.iter().all(|v| v.is_finite()),
            Self::Swept(sweep) => sweep.gradient.iter().all(|v| v.is_finite()),
        }
    }

    /// Step that removes `residual` and `beside` in `[matrix; normal^T]`; the shortest one where that is
    /// singular. Along a family there is none. `None` if a sweep lost too much.
    pub fn step(
        &self,
        normal: &DVector<f64>,
        residual: &DVector<f64>,
        beside: f64,
        family: Option<&Family>,
    ) -> Option<DVector<f64>> {
        let own = match self {
            Self::Dense(own) => own,
            Self::Swept(sweep) => return sweep.closed_by(normal).solve(&-residual, -beside),
        };
        let matrix = &own.matrix;
        let m = matrix.nrows();
        let a = family.map_or_else(|| bordered(matrix, normal), |f| f.bordered(matrix, normal));
        let mut b = DMatrix::zeros(a.nrows(), 1);
        for i in 0..m {
            b[(i, 0)] = -residual[i];
        }
        b[(m, 0)] = -beside;
        let step = own.solve(a, b);
        Some(step.view((0, 0), (m + 1, 1)).column(0).into_owned())
    }

    /// Tangent, oriented along `guide`, at rest along the motions of a family.
    pub fn tangent(&self, guide: &DVector<f64>, family: Option<&Family>) -> Option<Tangent> {
        let own = match self {
            Self::Dense(own) => own,
            Self::Swept(sweep) => return sweep.closed_by(guide).tangent(),
        };
        let matrix = &own.matrix;
        let m = matrix.nrows();
        let a = family.map_or_else(|| bordered(matrix, guide), |f| f.bordered(matrix, guide));
        let mut unit = DMatrix::zeros(a.nrows(), 1);
        unit[(m, 0)] = 1.0;
        let (solution, sign, logarithm) = own.regular(a, &unit)?;
        let solution = solution.view((0, 0), (m + 1, 1)).column(0).into_owned();
        Tangent::new(&solution, sign, logarithm)
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
