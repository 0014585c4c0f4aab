//! The monodromy operator: what one period of the cut makes of a small disturbance.

use nalgebra::{DMatrix, DVector, Dyn, LU};

use crate::error::{ChatterError, ChatterErrorKind, Result};
use crate::number::Complex64;
use crate::stability::eigenvalues::largest;
use crate::stability::period::Period;

/// The monodromy operator of a period at a depth.
///
/// Its vectors hold the states of the modes at the beginning of the period (real and imaginary parts), then the displacements
/// along the chip at all nodes, one period long. On a stretch, with `d` the difference of displacements from those one period
/// before, `(1 - a W) d = R u - s_before`: modes and residual flexibility stand in `W` alike, so that the flexibility that
/// acts without inertia is solved with the modes, exactly, as `(1 - a D G_res)^-1` (with the sign of `D` as in [D 8]).
pub(crate) struct Operator<'a> {
    pub(crate) period: &'a Period,
    depth: f64,
    factored: Vec<Option<LU<f64, Dyn, Dyn>>>,
}

impl<'a> Operator<'a> {
    pub(crate) fn new(period: &'a Period, depth: f64) -> Self {
        let factored = period
            .stretches
            .iter()
            .map(|stretch| {
                let cutting = stretch.cutting.as_ref()?;
                let n = cutting.force.nrows();
                Some((DMatrix::identity(n, n) - &cutting.force * depth).lu())
            })
            .collect();
        Self {
            period,
            depth,
            factored,
        }
    }

    /// Length of its vectors.
    pub(crate) fn size(&self) -> usize {
        2 * self.period.states.len() + self.period.differences()
    }

    /// Applies one period to a disturbance.
    pub(crate) fn apply(&self, before: &DVector<f64>) -> Result<DVector<f64>> {
        let states = self.period.states.len();
        let mut after = before.clone();
        let mut at = 0;
        for (stretch, factored) in self.period.stretches.iter().zip(&self.factored) {
            let mut driven = DVector::zeros(2 * states);
            if let (Some(cutting), Some(factored)) = (&stretch.cutting, factored) {
                let n = cutting.force.nrows();
                let last = before.rows(2 * states + at, n);
                // s = R u + a W (s - s_before): solved for the chip s - s_before.
                let mut chip = &cutting.state * after.rows(0, 2 * states) - last;
                if !factored.solve_mut(&mut chip) {
                    return Err(ChatterError::new(
                        ChatterErrorKind::NotConverged,
                        "one period of the cut",
                        format!("no solution at a depth of {} m", self.depth),
                        "another depth: here the cut and the residual flexibility together have no answer",
                    ));
                }
                driven = &cutting.end * &chip * self.depth;
                after
                    .rows_mut(2 * states + at, n)
                    .copy_from(&(last + &chip));
                at += n;
            }
            for (m, decay) in stretch.decay.iter().enumerate() {
                let (re, im) = (after[2 * m], after[2 * m + 1]);
                after[2 * m] = decay.re * re - decay.im * im + driven[2 * m];
                after[2 * m + 1] = decay.re * im + decay.im * re + driven[2 * m + 1];
            }
        }
        Ok(after)
    }

    /// Largest multiplier to a residual by its size, with its vector; `last` is the start vector of a nearby depth.
    pub(crate) fn largest(
        &self,
        accuracy: f64,
        last: &mut Option<DVector<f64>>,
    ) -> Result<(Complex64, DVector<Complex64>)> {
        // With many modes, most decay.
        let states = 2 * self.period.states.len();
        largest(self.size(), states, accuracy, last, |x| self.apply(x))
    }

    /// The operator as a matrix.
    pub(crate) fn dense(&self) -> Result<DMatrix<f64>> {
        let n = self.size();
        let mut matrix = DMatrix::zeros(n, n);
        let mut unit = DVector::zeros(n);
        for column in 0..n {
            unit[column] = 1.0;
            matrix.set_column(column, &self.apply(&unit)?);
            unit[column] = 0.0;
        }
        Ok(matrix)
    }
}
