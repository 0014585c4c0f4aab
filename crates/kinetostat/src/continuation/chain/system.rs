//! The conditions of equilibrium of a chain as a regular system: only reactions that can exist, in
//! units in which all unknowns are comparable.
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

use crate::chain::equilibrium::{System, disparate};
use crate::chain::problem::ChainProblem;
use crate::continuation::linear::family::Family;
use crate::continuation::settings::Parameter;
use crate::settings::Settings;
use crate::spatial::{Pose, Wrench};

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
