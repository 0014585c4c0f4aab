//! The dense linear problem at one point of a curve: its matrix, the direction in which the equilibrium persists, directions that
//! it takes to nothing, and the determinant that changes its sign at bifurcations.

use nalgebra::{DMatrix, DVector};

use crate::chain::graded::{MaterialUnits, on_both_sides};
use crate::linalg::saddle::Saddle;
use crate::linalg::singular_values::SingularValues;

/// Sign and logarithm of a determinant, and the direction in which equilibrium persists.
pub(crate) struct Tangent {
    pub direction: DVector<f64>,
    /// Sign of `det [G_z; t^T]`: it changes at a simple bifurcation.
    pub sign: f64,
    pub logarithm: f64,
}

impl Tangent {
    /// Builds from the solution of `[G_z; p^T] solution = (0, 1)` and the determinant of that matrix.
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

/// Directions that a matrix takes to nothing, or nearly so.
pub(crate) struct NullDirections {
    /// Singular values, the least first; zero where there are more columns than rows.
    pub values: Vec<f64>,
    /// Unit directions, one column for each value.
    pub right: DMatrix<f64>,
    /// Unit directions of the rows, the least first.
    pub left: DMatrix<f64>,
}

impl NullDirections {
    /// Finds the null directions of an `m x n` matrix.
    pub fn of(matrix: &DMatrix<f64>) -> Self {
        if !matrix.iter().all(|v| v.is_finite()) {
            return Self {
                values: Vec::new(),
                right: DMatrix::zeros(matrix.ncols(), 0),
                left: DMatrix::zeros(matrix.nrows(), 0),
            };
        }
        let own = SingularValues::of(matrix);
        let all = own.all_right();
        let value = |k: usize| own.values.get(k).copied().unwrap_or(0.0);
        let falling = |a: &DMatrix<f64>| {
            let order: Vec<usize> = (0..a.ncols()).rev().collect();
            a.select_columns(&order)
        };
        Self {
            values: (0..all.ncols()).rev().map(value).collect(),
            right: falling(&all),
            left: falling(&own.left),
        }
    }

    /// Converts to other units: orthonormal again, by ascending singular values.
    pub fn map(&mut self, change: impl Fn(&mut DMatrix<f64>)) {
        for vectors in [&mut self.right, &mut self.left] {
            if vectors.ncols() > 0 {
                change(vectors);
                *vectors = vectors.clone().qr().q();
            }
        }
    }

    /// Number of null directions: at least `least`, and all below a share of the largest singular value.
    pub fn count(&self, least: usize, share: f64) -> usize {
        let most = self.values.last().copied().unwrap_or(0.0);
        let below = |(i, value): &(usize, &f64)| *i < least || **value < share * most;
        self.values.iter().enumerate().take_while(below).count()
    }
}

/// Units of a state's coordinates, among its other unknowns, in which the springs' own stiffness is one.
pub(crate) struct StateUnits {
    /// The first coordinate.
    pub first: usize,
    /// Number of coordinates.
    pub count: usize,
    pub material: MaterialUnits,
}

impl StateUnits {
    /// Transforms the coordinates' rows.
    pub fn rows(&self, a: &mut DMatrix<f64>) {
        let mut own = a.rows(self.first, self.count).into_owned();
        self.material.gather(&mut own);
        a.rows_mut(self.first, self.count).copy_from(&own);
    }

    /// Transforms the coordinates' rows and columns.
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
    pub fn solve(&self, a: DMatrix<f64>, mut b: DMatrix<f64>) -> DMatrix<f64> {
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

/// `[matrix; normal^T]`.
pub(crate) fn bordered(matrix: &DMatrix<f64>, normal: &DVector<f64>) -> DMatrix<f64> {
    let m = matrix.nrows();
    let mut a = DMatrix::zeros(m + 1, m + 1);
    a.rows_mut(0, m).copy_from(matrix);
    a.row_mut(m).copy_from(&normal.transpose());
    a
}
