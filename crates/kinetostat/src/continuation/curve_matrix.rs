//! `[G_u G_lambda]` at a state of a curve of equilibria, closed by one more row: the steps of Newton's
//! method across the curve, its tangent, and the determinant that changes its sign at bifurcations.
//!
//! Short chains have a dense matrix. Of a long chain a sweep makes what is needed
//! ([`crate::continuation::curve_sweep`]), with cost and memory that grow with the number of coordinates.

use nalgebra::{DMatrix, DVector};

use crate::chain::material::{MaterialUnits, on_both_sides};
use crate::continuation::curve_sweep::CurveSweep;
use crate::continuation::family::Family;
use crate::linalg::saddle::Saddle;

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

/// Units of a state's coordinates, among its other unknowns, in which the springs' own stiffness is one.
pub(crate) struct StateUnits {
    /// The first coordinate.
    pub first: usize,
    /// How many there are.
    pub count: usize,
    pub material: MaterialUnits,
}

impl StateUnits {
    /// Of the coordinates' rows.
    pub fn rows(&self, a: &mut DMatrix<f64>) {
        let mut own = a.rows(self.first, self.count).into_owned();
        self.material.gather(&mut own);
        a.rows_mut(self.first, self.count).copy_from(&own);
    }

    /// Of the coordinates' rows and columns.
    pub fn both(&self, a: DMatrix<f64>) -> DMatrix<f64> {
        on_both_sides(a, |rows| self.rows(rows))
    }

    /// Directions in these units as those of the state.
    pub fn directions(&self, vectors: &mut DMatrix<f64>) {
        let own = vectors.rows(self.first, self.count).into_owned();
        let own = self.material.motions(own);
        vectors.rows_mut(self.first, self.count).copy_from(&own);
    }
}

/// All of `[dG/du dG/dlambda]`, with units for it where some springs are very much stiffer than others.
pub(crate) struct Whole {
    pub matrix: DMatrix<f64>,
    pub units: Option<StateUnits>,
}

impl Whole {
    /// Solution of a square system that begins with the matrix; the shortest one where it is singular.
    fn solve(&self, a: DMatrix<f64>, mut b: DMatrix<f64>) -> DMatrix<f64> {
        let ones = vec![1.0; a.nrows()];
        let Some(units) = &self.units else {
            Saddle::new(a, &ones, &ones).solve(&mut b);
            return b;
        };
        units.rows(&mut b);
        Saddle::new(units.both(a), &ones, &ones).solve(&mut b);
        units.directions(&mut b);
        b
    }

    /// Solution of a regular square system that begins with the matrix, for a right-hand side that does not
    /// concern the coordinates; with sign and logarithm of the size of the determinant.
    pub fn regular(&self, a: DMatrix<f64>, b: &DMatrix<f64>) -> Option<(DMatrix<f64>, f64, f64)> {
        let lu = match &self.units {
            Some(units) => units.both(a).lu(),
            None => a.lu(),
        };
        let (sign, logarithm) = determinant(&lu);
        let mut solution = lu.solve(b)?;
        if let Some(units) = &self.units {
            units.directions(&mut solution);
        }
        Some((solution, sign, logarithm))
    }
}

/// `[dG/du dG/dlambda]`, m x (m + 1), balanced.
pub(crate) enum CurveMatrix {
    /// All of it.
    Dense(Whole),
    /// Of a long chain.
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

    /// Step that removes `lack` and `miss` in `[matrix; normal^T]`; the shortest one where that is
    /// singular. Along a family there is none. `None` if a sweep lost too much.
    pub fn step(
        &self,
        normal: &DVector<f64>,
        lack: &DVector<f64>,
        miss: f64,
        family: Option<&Family>,
    ) -> Option<DVector<f64>> {
        let own = match self {
            Self::Dense(own) => own,
            Self::Swept(sweep) => return sweep.closed_by(normal).solve(&-lack, -miss),
        };
        let matrix = &own.matrix;
        let m = matrix.nrows();
        let a = family.map_or_else(|| bordered(matrix, normal), |f| f.bordered(matrix, normal));
        let mut b = DMatrix::zeros(a.nrows(), 1);
        for i in 0..m {
            b[(i, 0)] = -lack[i];
        }
        b[(m, 0)] = -miss;
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
