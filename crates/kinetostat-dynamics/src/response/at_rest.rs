//! Static flexibility of a machine, by its independent coordinates.

use nalgebra::DMatrix;

use crate::error::{Error, Result};
use crate::linear::LinearDynamics;
use crate::modes::pencil::{neutral_directions, symmetric};

impl LinearDynamics {
    pub(crate) fn no_flexibility(&self) -> Error {
        Error::NotSolved(format!(
            "'{}' has a massless direction without stiffness that its loads couple with others: its flexibility at rest is not defined",
            self.name
        ))
    }

    /// `(K - H + s M)^-1 b` by the independent coordinates; neutral directions take no part.
    pub(crate) fn solved_with_shift(
        &self,
        shift: f64,
        b: &DMatrix<f64>,
        neutral: bool,
    ) -> Result<DMatrix<f64>> {
        let n = self.len();
        let u = &self.units;
        let scaled = |a: &DMatrix<f64>| DMatrix::from_fn(n, n, |i, j| a[(i, j)] * u[i] * u[j]);
        let (mass, tangent) = (scaled(&self.mass), scaled(&self.tangent));
        let mut right = DMatrix::from_fn(n, b.ncols(), |i, j| b[(i, j)] * u[i]);
        let basis = neutral.then(|| neutral_directions(&mass, &symmetric(tangent.clone())).1);
        let mut a = tangent + mass * shift;
        if let Some(rest) = &basis {
            a = rest.tr_mul(&(a * rest));
            right = rest.tr_mul(&right);
        }
        let mut x = solve_scaled(a, right).ok_or_else(|| self.no_flexibility())?;
        if let Some(rest) = &basis {
            x = rest * x;
        }
        Ok(DMatrix::from_fn(n, b.ncols(), |i, j| x[(i, j)] * u[i]))
    }
}

/// `A^-1 b` with rows and columns in units of the diagonal.
fn solve_scaled(mut a: DMatrix<f64>, mut b: DMatrix<f64>) -> Option<DMatrix<f64>> {
    let n = a.nrows();
    let units: Vec<f64> = (0..n)
        .map(|i| {
            let own = a[(i, i)].abs();
            if own > 0.0 { 1.0 / own.sqrt() } else { 1.0 }
        })
        .collect();
    for j in 0..n {
        for i in 0..n {
            a[(i, j)] *= units[i] * units[j];
        }
    }
    for (mut row, unit) in b.row_iter_mut().zip(&units) {
        row *= *unit;
    }
    let mut x = a.lu().solve(&b)?;
    for (mut row, unit) in x.row_iter_mut().zip(&units) {
        row *= *unit;
    }
    Some(x)
}
