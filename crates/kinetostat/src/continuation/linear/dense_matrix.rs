//! `[G_u G_lambda]` of a curve as one dense matrix, in units in which springs of any stiffness are alike.

use nalgebra::{DMatrix, DVector};

use crate::chain::material::{MaterialUnits, on_both_sides};
use crate::continuation::linear::tangent::determinant;
use crate::linalg::saddle::Saddle;

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
