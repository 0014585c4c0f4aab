//! Newton's iteration of a chain across a curve: equilibrium and one more condition.

use nalgebra::DVector;

use crate::continuation::chain::system::ChainSystem;
use crate::continuation::tracing::system::{Corrected, Row};

impl ChainSystem<'_, '_> {
    /// Newton from `z` on equilibrium and one more row.
    pub fn correct(&mut self, z: &DVector<f64>, row: &Row<'_>, most: usize) -> Option<Corrected> {
        let m = self.count();
        let mut z = z.clone();
        let mut last = f64::INFINITY;
        for iteration in 0..=most {
            let (residual, norms, matrix) = self.linearised(&z);
            let (normal, beside) = match row {
                Row::Plane(normal, offset) => ((*normal).clone(), normal.dot(&z) - offset),
                Row::Parameter(value) => {
                    let mut normal = DVector::zeros(m + 1);
                    normal[m] = 1.0;
                    (normal, z[m] - value / self.sigma)
                }
                Row::Conjugate(value) => {
                    let normal = self.conjugate_row(&matrix.gradient());
                    let size = normal.norm().max(f64::MIN_POSITIVE);
                    (normal / size, (self.conjugate(&z) - value) / size)
                }
            };
            let fine = self.converged(&norms) && beside.abs() <= 1e-11 * (1.0 + z.norm());
            if fine && (last < 1e-8 || iteration == most) {
                return Some(Corrected {
                    z,
                    matrix,
                    norms,
                    iterations: iteration,
                });
            }
            let finite = matrix.is_finite() && residual.iter().all(|v| v.is_finite());
            if iteration == most || !finite {
                return None;
            }
            let step = match matrix.step(&normal, &residual, beside, self.family.as_deref()) {
                Some(step) => step,
                None => {
                    let (residual, _, dense) = self.linearised_densely(&z);
                    self.whole(dense).step(&normal, &residual, beside, None)?
                }
            };
            let length = step.norm();
            if !length.is_finite() || (iteration > 1 && length > 2.0 * last && length > 1e-9) {
                // Next to very stiff springs the last steps are rounding.
                return fine.then_some(Corrected {
                    z,
                    matrix,
                    norms,
                    iterations: iteration,
                });
            }
            last = length;
            z = self.followed(&z, &z + step);
        }
        None
    }
}
