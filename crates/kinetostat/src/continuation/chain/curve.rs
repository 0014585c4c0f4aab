//! A chain as a system in equilibrium with one parameter.

use std::sync::Arc;

use nalgebra::{DMatrix, DVector};

use crate::chain::equilibrium::Equilibrium;
use crate::chain::residual::{FoundBy, ResidualNorms};
use crate::chain::stability::ShapeStability;
use crate::continuation::chain::system::ChainSystem;
use crate::continuation::linear::curve_matrix::CurveMatrix;
use crate::continuation::linear::family::Family;
use crate::continuation::linear::tangent::NullDirections;
use crate::continuation::settings::CurveSettings;
use crate::continuation::tracing::system::{Corrected, CurveSystem, Row};
use crate::error::Error;
use crate::model::chain::Role;
use crate::spatial::MotionKind;

impl CurveSystem for ChainSystem<'_, '_> {
    type Equilibrium = Equilibrium;

    fn count(&self) -> usize {
        self.count()
    }

    fn is_load(&self) -> bool {
        self.is_load()
    }

    fn sigma(&self) -> f64 {
        self.sigma
    }

    /// Full turns of passive joints.
    fn full_turns(&self) -> Vec<f64> {
        let r = self.reactions();
        let mut turns = vec![0.0; self.count() + 1];
        for (i, c) in self.problem.chain.coordinates().iter().enumerate() {
            if c.role == Role::Passive && c.kind == MotionKind::Revolute {
                turns[r + i] = std::f64::consts::TAU / self.unit_of_coordinate(i);
            }
        }
        turns
    }

    /// All that a chain needs is in the state itself.
    fn start_from(&mut self, _near: &Equilibrium) {}

    fn family(&self) -> Option<&Arc<Family>> {
        self.family.as_ref()
    }

    fn set_family(&mut self, family: Option<Arc<Family>>) {
        self.family = family;
    }

    fn set_dense(&mut self, dense: bool) {
        self.dense = dense;
    }

    fn evaluate(&mut self, z: &DVector<f64>) -> (DVector<f64>, ResidualNorms) {
        self.evaluate(z)
    }

    fn converged(&self, norms: &ResidualNorms) -> bool {
        self.converged(norms)
    }

    fn linearised(&mut self, z: &DVector<f64>) -> (DVector<f64>, ResidualNorms, CurveMatrix) {
        self.linearised(z)
    }

    fn linearised_densely(
        &mut self,
        z: &DVector<f64>,
    ) -> (DVector<f64>, ResidualNorms, DMatrix<f64>) {
        self.linearised_densely(z)
    }

    fn gradient(&mut self, z: &DVector<f64>) -> DVector<f64> {
        self.gradient(z).2
    }

    fn whole(&self, matrix: DMatrix<f64>) -> CurveMatrix {
        self.whole(matrix)
    }

    fn null_directions(&self, matrix: &DMatrix<f64>) -> NullDirections {
        self.null_directions(matrix)
    }

    fn correct(&mut self, z: &DVector<f64>, row: &Row<'_>, most: usize) -> Option<Corrected> {
        self.correct(z, row, most)
    }

    fn followed(&self, from: &DVector<f64>, to: DVector<f64>) -> DVector<f64> {
        self.followed(from, to)
    }

    fn motion(&self, direction: &DVector<f64>) -> Vec<f64> {
        self.motion(direction)
    }

    fn size_of_motion(&self, motion: &DVector<f64>) -> f64 {
        self.size_of_motion(motion)
    }

    fn longest_step(&self, t: &DVector<f64>, settings: &CurveSettings) -> f64 {
        let chain = self.problem.chain;
        let turn = settings.largest_turn;
        let mut h = 2.0_f64;
        for (dx, c) in self.motion(t).iter().zip(chain.coordinates()) {
            let most = match c.kind {
                MotionKind::Revolute => turn,
                MotionKind::Prismatic => turn * chain.scale().length,
            };
            h = h.min(most / dx.abs().max(1e-300));
        }
        h
    }

    fn beyond_angle(&self, found: &Equilibrium, largest: f64) -> bool {
        let joints = found
            .coordinates
            .iter()
            .zip(self.problem.chain.coordinates());
        let mut turns = joints.filter(|(_, c)| c.kind == MotionKind::Revolute);
        turns.any(|(x, _)| x.abs() > largest)
    }

    fn conjugate(&self, z: &DVector<f64>) -> f64 {
        self.conjugate(z)
    }

    fn conjugate_row(&self, gradient: &DVector<f64>) -> DVector<f64> {
        self.conjugate_row(gradient)
    }

    fn natural_conjugate(&self, conjugate: f64) -> f64 {
        self.natural_conjugate(conjugate)
    }

    fn stability(&mut self, c: &Corrected, motion: bool) -> ShapeStability {
        self.stability(c, motion)
    }

    fn equilibrium(&mut self, c: &Corrected) -> Equilibrium {
        Equilibrium {
            found_by: FoundBy::Continuation,
            ..self.equilibrium(c)
        }
    }

    fn not_converged(&mut self, z: &DVector<f64>, iterations: usize) -> Error {
        let (_, norms) = self.evaluate(z);
        let chain = self.problem.chain;
        Error::NotConverged {
            place: chain.place(),
            iterations,
            residual_position_m: norms.closure * chain.scale().length,
            residual_torque: norms.torque / norms.loads.max(1e-9),
            load_factor: 0.0,
            last: self.coordinates(z),
            limit: None,
        }
    }
}

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
