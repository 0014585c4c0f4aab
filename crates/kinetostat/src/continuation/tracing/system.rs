//! A system in equilibrium with one parameter: what a tracer of curves and a locator of special points ask of it.
//!
//! ```text
//! G(u, lambda) = 0,     z = (u, lambda / sigma)         m equations, m + 1 unknowns, the parameter last
//! ```
//!
//! A chain is one with all of its reactions and coordinates as unknowns ([`crate::continuation::chain::system`]); a machine
//! is one with the motions of its tool and the load, everything else condensed
//! ([`crate::continuation::machine::system`]). Unknowns and equations are in units in which they are comparable, so that
//! angles between tangents, steps and nearly singular matrices mean the same for both.

use std::sync::Arc;

use nalgebra::{DMatrix, DVector};

use crate::chain::residual::ResidualNorms;
use crate::continuation::curve::{Branch, BranchEnd, CurveEquilibrium, CurvePoint, Special};
use crate::continuation::linear::curve_matrix::CurveMatrix;
use crate::continuation::linear::family::Family;
use crate::continuation::linear::tangent::NullDirections;
use crate::continuation::settings::CurveSettings;
use crate::error::Error;

pub(crate) type Point<S> = CurvePoint<<S as CurveSystem>::Equilibrium>;

pub(crate) type SpecialPoint<S> = Special<<S as CurveSystem>::Equilibrium>;

pub(crate) type BranchOf<S> = Branch<<S as CurveSystem>::Equilibrium>;

/// Points of a branch in one direction from its start, and why they end.
pub(crate) type HalfBranch<S> = (Vec<Point<S>>, BranchEnd);

/// The two ends of a branch beside the point at which it leaves: unknowns and state, where there are some.
pub(crate) type Arms<E> = [Option<(DVector<f64>, E)>; 2];

/// Closing equation of the system of equilibrium along a curve.
pub(crate) enum Row<'v> {
    /// `normal . z = offset`.
    Plane(&'v DVector<f64>, f64),
    /// The parameter has this value.
    Parameter(f64),
    /// The conjugate has this value.
    Conjugate(f64),
}

/// A state that satisfies equilibrium.
pub(crate) struct Corrected {
    pub z: DVector<f64>,
    /// Matrix of the curve at that state.
    pub matrix: CurveMatrix,
    pub norms: ResidualNorms,
    pub iterations: usize,
}

/// A system in equilibrium with one parameter.
pub(crate) trait CurveSystem {
    /// Type of its equilibria.
    type Equilibrium: CurveEquilibrium;

    /// Number of equations `m`.
    fn count(&self) -> usize;
    /// True if the parameter is a load factor, false if it is a displacement.
    fn is_load(&self) -> bool;
    /// Parameter per unit of the last unknown.
    fn sigma(&self) -> f64;
    /// True if a curve starts in this direction: the parameter grows.
    fn points_forward(&self, t: &DVector<f64>) -> bool {
        t[self.count()] >= 0.0
    }
    /// Among null directions in none of which the parameter changes, the one in which a curve starts.
    fn start_where_still(&self, null: &DMatrix<f64>) -> DVector<f64> {
        null.column(0).into_owned()
    }
    /// Full turn of every unknown, 0 where a full turn makes a difference.
    fn full_turns(&self) -> Vec<f64>;

    /// Parameter of a state.
    fn value(&self, z: &DVector<f64>) -> f64 {
        z[self.count()] * self.sigma()
    }

    /// Continues from a point, in its family.
    fn resume(&mut self, point: &CurvePoint<Self::Equilibrium>) {
        self.set_family(point.family.clone());
        self.start_from(&point.equilibrium);
    }
    /// Starts the next search near this equilibrium.
    fn start_from(&mut self, near: &Self::Equilibrium);
    /// Family of equilibria through the curve that is followed: what is neutral in it is at rest.
    fn family(&self) -> Option<&Arc<Family>>;
    /// See [`Self::family`].
    fn set_family(&mut self, family: Option<Arc<Family>>);
    /// Dense matrices are wanted, whatever the size.
    fn set_dense(&mut self, dense: bool);

    /// Unstable modes of what is condensed out of the unknowns: where it changes, so does a sign that the determinant
    /// of the unknowns alone does not show, or it has a pole.
    fn condensed_modes(_found: &Self::Equilibrium) -> usize {
        0
    }

    /// True if something condensed has another shape in `found` than on the step from `a` to `b` of a branch, although the
    /// unknowns may be the same.
    fn condensed_apart(
        &self,
        _found: &Self::Equilibrium,
        _a: &Self::Equilibrium,
        _b: &Self::Equilibrium,
    ) -> bool {
        false
    }
    /// States beside a point at which something condensed loses its stability, on the branches that leave there: both
    /// arms of each.
    fn condensed_arms(
        &mut self,
        _at: &CurvePoint<Self::Equilibrium>,
    ) -> Vec<Arms<Self::Equilibrium>> {
        Vec::new()
    }

    /// Evaluates the system at a state; returns the residual and its measure.
    fn evaluate(&mut self, z: &DVector<f64>) -> (DVector<f64>, ResidualNorms);
    /// True if a residual is small enough.
    fn converged(&self, norms: &ResidualNorms) -> bool;
    /// Residual, its measure and `[dG/du dG/dlambda]` at a state.
    fn linearised(&mut self, z: &DVector<f64>) -> (DVector<f64>, ResidualNorms, CurveMatrix);
    /// Linearises with a dense matrix.
    fn linearised_densely(
        &mut self,
        z: &DVector<f64>,
    ) -> (DVector<f64>, ResidualNorms, DMatrix<f64>);
    /// `dG/dlambda` at a state.
    fn gradient(&mut self, z: &DVector<f64>) -> DVector<f64>;
    /// `[dG/du dG/dlambda]` at the state that was evaluated last (densely), with its units.
    fn whole(&self, matrix: DMatrix<f64>) -> CurveMatrix;
    /// Null directions of such a matrix (more rows or columns may follow).
    fn null_directions(&self, matrix: &DMatrix<f64>) -> NullDirections;
    /// An equilibrium near `z` that satisfies one more condition, if Newton's iteration finds it in so many steps.
    fn correct(&mut self, z: &DVector<f64>, row: &Row<'_>, most: usize) -> Option<Corrected>;

    /// The state `to`, a step of an iteration away from `from`, as the system's coordinates take it.
    fn followed(&self, from: &DVector<f64>, to: DVector<f64>) -> DVector<f64>;
    /// Motion (m, rad) along a direction of states.
    fn motion(&self, direction: &DVector<f64>) -> Vec<f64>;
    /// Size of a motion of the state that was evaluated last.
    fn size_of_motion(&self, motion: &DVector<f64>) -> f64;
    /// Largest step along a tangent that keeps motions small.
    fn longest_step(&self, t: &DVector<f64>, settings: &CurveSettings) -> f64;
    /// True if an equilibrium is beyond the largest angle.
    fn beyond_angle(&self, found: &Self::Equilibrium, largest: f64) -> bool;

    /// Conjugate of the parameter at the state that was evaluated last.
    fn conjugate(&self, z: &DVector<f64>) -> f64;
    /// Change of the conjugate per unknown, by `dG/dlambda`.
    fn conjugate_row(&self, gradient: &DVector<f64>) -> DVector<f64>;
    /// A conjugate in natural units.
    fn natural_conjugate(&self, conjugate: f64) -> f64;

    /// Stability at a state, which was evaluated last, with the conjugate motion held (`motion`), or under a dead load.
    fn stability(
        &mut self,
        c: &Corrected,
        motion: bool,
    ) -> <Self::Equilibrium as CurveEquilibrium>::Stability;
    /// Everything that is known about a state, which was evaluated last.
    fn equilibrium(&mut self, c: &Corrected) -> Self::Equilibrium;
    /// Error if no equilibrium was found near a state.
    fn not_converged(&mut self, z: &DVector<f64>, iterations: usize) -> Error;
}

/// `a - b`, full turns taken out.
pub(crate) fn wrapped(a: &DVector<f64>, b: &DVector<f64>, turns: &[f64]) -> DVector<f64> {
    let mut d = a - b;
    for (d, turn) in d.iter_mut().zip(turns) {
        if *turn > 0.0 {
            *d -= turn * (*d / turn).round();
        }
    }
    d
}

/// Distance of two states, full turns taken out.
pub(crate) fn distance<S: CurveSystem>(system: &S, a: &DVector<f64>, b: &DVector<f64>) -> f64 {
    wrapped(a, b, &system.full_turns()).norm()
}

/// Distance of `p` from the segment `a b`, full turns taken out.
pub(crate) fn off_segment(
    p: &DVector<f64>,
    a: &DVector<f64>,
    b: &DVector<f64>,
    turns: &[f64],
) -> f64 {
    let along = b - a;
    let from = wrapped(p, a, turns);
    let share = (from.dot(&along) / along.norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    (from - along * share).norm()
}
