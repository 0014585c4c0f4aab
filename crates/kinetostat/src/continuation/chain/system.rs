//! A chain as a system in equilibrium with one parameter: only reactions that can exist, in units in which all unknowns are
//! comparable.
//!
//! ```text
//! unknowns  a (reactions), x (coordinates), lambda (what grows along a curve)
//! 0 = -R^T (pose(x), pose*(lambda))                        closure where the pose is prescribed
//! 0 = J^T F + sum J_j^T G_j - K_theta (theta - theta0)      F = R a + prescribed part(lambda)
//! ```
//!
//! `R` spans the reactions of the directions in which the chain can move at all (a planar chain has
//! three of six), so that a zero of the determinant of `[0 R^T J; J^T R H - K]` is a fold or a
//! bifurcation and never a matter of how the chain was written down. Passive motions that change
//! nothing (strut spin) are held by their own projector.

use std::sync::Arc;

use nalgebra::{DMatrix, DVector, Vector3, Vector6};

use crate::chain::equilibrium::{Equilibrium, System, disparate};
use crate::chain::problem::ChainProblem;
use crate::chain::residual::{FoundBy, ResidualNorms};
use crate::chain::stability::ShapeStability;
use crate::continuation::linear::curve_matrix::CurveMatrix;
use crate::continuation::linear::family::Family;
use crate::continuation::linear::tangent::NullDirections;
use crate::continuation::settings::{CurveSettings, Parameter};
use crate::continuation::tracing::system::{Corrected, CurveSystem, Row};
use crate::error::Error;
use crate::model::chain::Role;
use crate::settings::Settings;
use crate::spatial::{MotionKind, Pose, Wrench};

pub(crate) struct ChainSystem<'p, 'a> {
    pub problem: &'p ChainProblem<'a>,
    pub(super) parameter: Option<&'p Parameter>,
    pub settings: Settings,
    pub scaling: Vec<f64>,
    /// System as evaluated last: by sweeps along a long chain, or dense.
    pub equations: System,
    /// The other of the two, if there is one.
    pub(super) other: Option<Box<System>>,
    /// Dense matrices are wanted, whatever the chain.
    pub dense: bool,
    /// Orthonormal directions of the reactions, scaled base axes, 6 x r.
    pub(super) range: DMatrix<f64>,
    /// Directions in which the pose is prescribed, base axes, 6 x k: those that the chain cannot
    /// move in have no reaction here, but must be where they are prescribed all the same.
    pub(super) frame: DMatrix<f64>,
    /// Prescribed wrench and what grows of it, base axes.
    pub(super) given: Vector6<f64>,
    pub(super) grown: Vector6<f64>,
    /// Passive motions that change nothing.
    pub(super) neutral: usize,
    /// Parameter per scaled unit.
    pub sigma: f64,
    /// Square root of the natural energy.
    pub(super) unit: f64,
    /// Rotation (vector, rad) from the end to where it is prescribed: it is not small where some rotations are free.
    pub(super) turned: Vector3<f64>,
    /// All loads, those that grow included, have a potential.
    pub(super) conservative: bool,
    /// Poses of the nodes at the start, for the displacement along a load pattern.
    pub(super) reference: Vec<Pose>,
    /// Family of equilibria through the curve that is followed: what is neutral in it is at rest.
    pub family: Option<Arc<Family>>,
}

impl ChainSystem<'_, '_> {
    /// Number of reactions.
    pub fn reactions(&self) -> usize {
        self.range.ncols()
    }

    /// True if the parameter is a load factor.
    pub fn is_load(&self) -> bool {
        matches!(self.parameter, Some(Parameter::Load(_)))
    }

    pub fn coordinates_count(&self) -> usize {
        self.problem.chain.coordinate_count()
    }

    /// Number of equations.
    pub fn count(&self) -> usize {
        self.reactions() + self.coordinates_count()
    }

    /// Unknowns `(a, x, lambda)` from physical quantities.
    pub fn state(&self, coordinates: &[f64], wrench: &Wrench, value: f64) -> DVector<f64> {
        let (r, m) = (self.reactions(), self.count());
        let reaction = wrench.0 - self.given - self.grown * value;
        let scaled = DVector::from_fn(6, |i, _| reaction[i] / (self.scaling[i] * self.unit));
        let a = self.range.transpose() * scaled;
        DVector::from_fn(m + 1, |i, _| {
            if i < r {
                a[i]
            } else if i < m {
                coordinates[i - r] / (self.scaling[6 + i - r] * self.unit)
            } else {
                value / self.sigma
            }
        })
    }

    /// Metres or radians per unit of a coordinate of a state.
    pub fn unit_of_coordinate(&self, i: usize) -> f64 {
        self.scaling[6 + i] * self.unit
    }

    /// Coordinates (m, rad) of a state.
    pub fn coordinates(&self, z: &DVector<f64>) -> Vec<f64> {
        let r = self.reactions();
        (0..self.coordinates_count())
            .map(|i| z[r + i] * self.scaling[6 + i] * self.unit)
            .collect()
    }

    /// The state `to`, a step of an iteration away from `from`, as the springs of a chain with very stiff ones
    /// take that step: in their own strain.
    pub fn followed(&self, from: &DVector<f64>, to: DVector<f64>) -> DVector<f64> {
        match disparate(&self.scaling, self.problem.chain) {
            true => self.strained(from, to),
            false => to,
        }
    }

    /// The state `to`, a step away from `from` in the springs' own strain, see
    /// [`crate::model::springs::block::SpringBlock::follow`].
    pub fn strained(&self, from: &DVector<f64>, mut to: DVector<f64>) -> DVector<f64> {
        let x = self.strained_coordinates(&self.coordinates(from), self.coordinates(&to));
        let r = self.reactions();
        for (i, x) in x.into_iter().enumerate() {
            to[r + i] = x / (self.scaling[6 + i] * self.unit);
        }
        to
    }

    /// [`Self::strained`] of coordinates, m or rad.
    pub fn strained_coordinates(&self, from: &[f64], mut to: Vec<f64>) -> Vec<f64> {
        for block in self.problem.chain.springs() {
            block.follow(from, 1.0, &mut to);
        }
        to
    }

    /// Physical motion of the coordinates (m, rad) along a direction of states.
    pub fn motion(&self, direction: &DVector<f64>) -> Vec<f64> {
        self.coordinates(direction)
    }

    /// Wrench on the end (base axes) of a state.
    pub fn wrench(&self, z: &DVector<f64>) -> Wrench {
        let scaled = &self.range * z.rows(0, self.reactions());
        let reaction = Vector6::from_fn(|i, _| scaled[i] * self.scaling[i] * self.unit);
        Wrench(reaction + self.given + self.grown * self.value(z))
    }

    /// Parameter of a state.
    pub fn value(&self, z: &DVector<f64>) -> f64 {
        z[self.count()] * self.sigma
    }

    /// A conjugate in natural units.
    pub fn natural_conjugate(&self, conjugate: f64) -> f64 {
        conjugate * self.sigma / (self.unit * self.unit)
    }

    /// Change of the conjugate per scaled unknown, by `dG/dlambda`.
    pub fn conjugate_row(&self, gradient: &DVector<f64>) -> DVector<f64> {
        let m = self.count();
        let sign = match self.parameter {
            Some(Parameter::Displacement(_)) => -1.0,
            _ => 1.0,
        };
        let scale = sign * self.unit * self.unit / self.sigma;
        DVector::from_fn(m + 1, |i, _| match i < m {
            true => scale * gradient[i],
            false => 0.0,
        })
    }
}

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
