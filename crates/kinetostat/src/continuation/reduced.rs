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

use nalgebra::{DMatrix, DVector, Matrix6, Vector3, Vector6};

use crate::chain::equilibrium::{Equilibrium, System, balance, disparate, rounding};
use crate::chain::material::{MaterialUnits, material_springs};
use crate::chain::potential::is_conservative;
use crate::chain::problem::{ChainProblem, Prescribed, check_numbers, check_problem};
use crate::chain::residual::Balance;
use crate::chain::scaling::{natural, nudged};
use crate::chain::stability::{ShapeStability, stability_within, swept_stability_within};
use crate::chain::sweep::solve::EndMotions;
use crate::chain::sweep::stages::{Path, turned_rows};
use crate::continuation::curve_matrix::{CurveMatrix, StateUnits, Whole};
use crate::continuation::curve_sweep::CurveSweep;
use crate::continuation::family::Family;
use crate::continuation::singular_point::NullDirections;
use crate::error::{Error, Result};
use crate::linalg::complement::complement;
use crate::linalg::saddle::{RANK_TOLERANCE, column_space};
use crate::linalg::singular_values::SingularValues;
use crate::model::chain::Role;
use crate::model::loads::load::Load;
use crate::settings::Settings;
use crate::spatial::{Pose, Twist, Wrench, moved, pose_residual, rotation_rate, turn_matrix};

/// Loads that grow together: at factor `f` the chain carries its own loads plus `f` times these.
#[derive(Clone, Debug, Default)]
pub struct LoadPattern {
    /// Wrench on the end, about its origin, base axes (N, N m); only directions in which the end
    /// condition prescribes the wrench.
    pub end: Wrench,
    /// Loads on the nodes.
    pub loads: Vec<Load>,
}

/// What grows along a curve of equilibria.
#[derive(Clone, Debug)]
pub enum Parameter {
    /// The end is moved by `value * twist` from the pose that the problem prescribes: base axes, at
    /// the end's origin, only directions in which the pose is prescribed. With a unit twist the
    /// parameter is in m (rad) and its conjugate, the end's force (moment) along the twist, in N
    /// (N m).
    Displacement(Twist),
    /// A pattern of loads is multiplied by the parameter (a pure number). The conjugate is the
    /// displacement along the pattern since the curve's start: factor times it is work (J).
    Load(LoadPattern),
}

impl Parameter {
    /// Motion of the end along one of the six directions `x y z rx ry rz` of the end condition's
    /// axes, 1 m or 1 rad per unit.
    #[must_use]
    pub fn along(axes: &nalgebra::Rotation3<f64>, direction: usize) -> Self {
        let unit = Vector6::from_fn(|i, _| f64::from(u8::from(i == direction)));
        Self::Displacement(Twist(turn_matrix(axes) * unit))
    }

    /// A wrench on the end, base axes.
    #[must_use]
    pub fn end_wrench(wrench: Wrench) -> Self {
        Self::Load(LoadPattern {
            end: wrench,
            loads: Vec::new(),
        })
    }
}

/// What closes the system of equilibrium along a curve.
pub(crate) enum Row<'v> {
    /// `normal . z = offset`.
    Plane(&'v DVector<f64>, f64),
    /// The parameter has this value.
    Parameter(f64),
    /// The conjugate has this value.
    Conjugate(f64),
}

/// Stability of an equilibrium as its end is prescribed: free where a wrench is, held where the pose is. `None`
/// where the problem cannot be looked at.
pub(crate) fn stability_as_prescribed(
    problem: &ChainProblem<'_>,
    settings: &Settings,
    found: &Equilibrium,
) -> Option<ShapeStability> {
    let mut reduced = Reduced::new(problem, None, settings).ok()?.by_sweeps();
    let z = reduced.state(&found.coordinates, &found.wrench, 0.0);
    let (_, balance, matrix) = reduced.linearised(&z);
    let iterations = found.residual.iterations;
    let state = Corrected {
        z,
        matrix,
        balance,
        iterations,
    };
    Some(reduced.stability(&state, false))
}

/// A state that satisfies equilibrium.
pub(crate) struct Corrected {
    pub z: DVector<f64>,
    /// Of the curve at that state.
    pub matrix: CurveMatrix,
    pub balance: Balance,
    pub iterations: usize,
}

pub(crate) struct Reduced<'p, 'a> {
    pub problem: &'p ChainProblem<'a>,
    parameter: Option<&'p Parameter>,
    pub settings: Settings,
    pub factors: Vec<f64>,
    /// As it was evaluated last: by sweeps along a long chain, or dense.
    pub system: System,
    /// The other of the two, if there is one.
    other: Option<Box<System>>,
    /// Dense matrices are wanted, whatever the chain.
    pub dense: bool,
    /// Orthonormal directions of the reactions, balanced base axes, 6 x r.
    range: DMatrix<f64>,
    /// Directions in which the pose is prescribed, base axes, 6 x k: those that the chain cannot
    /// move in have no reaction here, but must be where they are prescribed all the same.
    frame: DMatrix<f64>,
    /// Prescribed wrench and what grows of it, base axes.
    given: Vector6<f64>,
    grown: Vector6<f64>,
    /// Passive motions that change nothing.
    neutral: usize,
    /// Parameter per balanced unit.
    pub sigma: f64,
    /// Square root of the natural energy.
    unit: f64,
    /// Rotation (vector, rad) that the end lacks: it is not small where some rotations are free.
    turned: Vector3<f64>,
    /// All loads, those that grow included, have a potential.
    conservative: bool,
    /// Poses of the nodes at the start, for the displacement along a load pattern.
    reference: Vec<Pose>,
    /// Family of equilibria through the curve that is followed: what is neutral in it is at rest.
    pub family: Option<Arc<Family>>,
}

/// Largest part of `v` (in the given balance) that lies in directions that are prescribed
/// otherwise.
fn misplaced(v: &Vector6<f64>, turn: &Matrix6<f64>, wrong: impl Fn(usize) -> bool) -> bool {
    let local = turn.transpose() * v;
    let most = local.amax();
    (0..6).any(|k| wrong(k) && local[k].abs() > 1e-9 * most)
}

impl<'p, 'a> Reduced<'p, 'a> {
    pub fn new(
        problem: &'p ChainProblem<'a>,
        parameter: Option<&'p Parameter>,
        settings: &Settings,
    ) -> Result<Self> {
        check_problem(problem)?;
        let chain = problem.chain;
        settings.check(&format!("chain '{}'", chain.name()))?;
        let factors = balance(chain, &problem.posture);
        let mut system = System::new(
            chain,
            &problem.base,
            &problem.posture,
            &problem.commands,
            false,
        );
        let turn = turn_matrix(&problem.end.axes);
        let is_pose = |k: usize| problem.end.prescribed[k] == Prescribed::Pose;
        let projector = |wanted: &dyn Fn(usize) -> bool| {
            let mut sum = Matrix6::zeros();
            for k in (0..6).filter(|&k| wanted(k)) {
                sum += turn.column(k) * turn.column(k).transpose();
            }
            sum
        };
        let mut grown = Vector6::zeros();
        let mut conservative = is_conservative(problem);
        match parameter {
            Some(Parameter::Displacement(twist)) => {
                check_numbers(problem, "the direction of a curve", &twist.0)?;
                if twist.0.amax() == 0.0 || misplaced(&twist.0, &turn, |k| !is_pose(k)) {
                    return Err(Error::model(
                        format!("chain '{}'", chain.name()),
                        "the direction of a displacement must not vanish and must lie in directions in which the end condition prescribes the pose",
                    ));
                }
            }
            Some(Parameter::Load(pattern)) => {
                check_numbers(problem, "the load pattern", &pattern.end.0)?;
                if misplaced(&pattern.end.0, &turn, is_pose) {
                    return Err(Error::model(
                        format!("chain '{}'", chain.name()),
                        "the end wrench of a load pattern must lie in directions in which the end condition prescribes the wrench",
                    ));
                }
                let mut loaded = problem.clone();
                loaded.loads.clone_from(&pattern.loads);
                loaded.end.wrench = pattern.end;
                check_problem(&loaded)?;
                conservative &= is_conservative(&loaded);
                grown = pattern.end.0;
                system.pattern.0.clone_from(&pattern.loads);
            }
            None => {}
        }
        let given = projector(&|k| !is_pose(k)) * problem.end.wrench.0;
        let mut reduced = Self {
            problem,
            parameter,
            settings: *settings,
            factors,
            system,
            other: None,
            dense: false,
            range: DMatrix::zeros(6, 0),
            frame: DMatrix::zeros(6, 0),
            given,
            grown,
            neutral: 0,
            sigma: 1.0,
            unit: natural(chain),
            turned: Vector3::zeros(),
            conservative,
            reference: Vec::new(),
            family: None,
        };
        reduced.find_range(&turn);
        reduced.find_neutral();
        Ok(reduced)
    }

    /// Evaluates by sweeps along the chain where it is long and no passive motion is redundant. What
    /// needs whole matrices (special points, families) still has them.
    pub fn by_sweeps(mut self) -> Self {
        if self.neutral > 0 {
            return self;
        }
        let p = self.problem;
        let (posture, commands) = (&p.posture, &p.commands);
        let factors = &self.factors;
        let mut swept = System::of_chain(p.chain, &p.base, posture, commands, factors, None);
        if swept.path() == Path::Sweep {
            swept.pattern.0.clone_from(&self.system.pattern.0);
            self.other = Some(Box::new(swept));
        }
        self
    }

    /// Takes the system that serves: dense where a family is followed or where it is wanted.
    fn choose(&mut self) {
        let wanted = match self.dense || self.family.is_some() {
            true => Path::Dense,
            false => Path::Sweep,
        };
        if self.system.path() != wanted
            && let Some(other) = &mut self.other
        {
            std::mem::swap(&mut self.system, other);
        }
    }

    /// With dense matrices, whatever the chain; what was evaluated is dense afterwards.
    pub fn densely<T>(&mut self, work: impl FnOnce(&mut Self) -> T) -> T {
        let before = std::mem::replace(&mut self.dense, true);
        let answer = work(self);
        self.dense = before;
        answer
    }

    /// The derivative as a dense matrix, with what equilibrium lacks.
    pub fn linearised_densely(
        &mut self,
        z: &DVector<f64>,
    ) -> (DVector<f64>, Balance, DMatrix<f64>) {
        let (lack, balance, gradient) = self.densely(|own| own.gradient(z));
        let matrix = self.with_gradient(&gradient);
        (lack, balance, matrix)
    }

    /// Reactions that can exist: the union of the Jacobian's range over several postures.
    fn find_range(&mut self, turn: &Matrix6<f64>) {
        let problem = self.problem;
        let chain = problem.chain;
        let held: Vec<usize> = (0..6)
            .filter(|&k| problem.end.prescribed[k] == Prescribed::Pose)
            .collect();
        let frame = DMatrix::from_fn(6, held.len(), |i, k| turn[(i, held[k])]);
        let n = chain.coordinate_count();
        let sizes = [0.0, 0.4, -0.9, 1.7];
        let mut all = DMatrix::zeros(held.len(), n * sizes.len());
        for (k, size) in sizes.into_iter().enumerate() {
            let x = nudged(chain, &problem.posture, size);
            self.system
                .kinematics
                .update(chain, &problem.base, &x, &problem.commands);
            self.system.jacobian = self.system.kinematics.jacobian(chain.tip());
            all.columns_mut(k * n, n)
                .copy_from(&(frame.transpose() * self.balanced_jacobian()));
        }
        self.range = &frame * column_space(&all);
        self.frame = frame;
    }

    /// Passive motions that change nothing, wherever the chain is and whatever its reactions are.
    fn find_neutral(&mut self) {
        let problem = self.problem;
        let passive = problem.chain.indices_of(Role::Passive).len();
        let mut least = passive;
        for (k, size) in [0.3, -0.7, 1.3].into_iter().enumerate() {
            if least == 0 {
                break;
            }
            let x = nudged(problem.chain, &problem.posture, size);
            let mut z = self.state(&x, &Wrench::zero(), 0.0);
            for i in 0..self.reactions() {
                z[i] = 0.2 * ((i + k) as f64 + 0.4).sin();
            }
            z[self.count()] = 0.3;
            self.evaluate(&z);
            let columns = self.passive_columns();
            if !columns.iter().all(|v| v.is_finite()) {
                continue;
            }
            let rank = SingularValues::of(&columns).rank(100.0 * RANK_TOLERANCE);
            least = least.min(passive.saturating_sub(rank));
        }
        self.neutral = least;
    }

    /// Columns of the passive joints in `[R^T J; H]`, balanced.
    fn passive_columns(&self) -> DMatrix<f64> {
        let passive = self.problem.chain.indices_of(Role::Passive);
        let (n, r) = (self.coordinates_count(), self.reactions());
        let rows = self.range.transpose() * self.balanced_jacobian();
        DMatrix::from_fn(r + n, passive.len(), |i, j| {
            if i < r {
                rows[(i, passive[j])]
            } else {
                self.hessian(i - r, passive[j])
            }
        })
    }

    fn hessian(&self, i: usize, j: usize) -> f64 {
        self.system.hessian[(i, j)] * self.factors[6 + i] * self.factors[6 + j]
    }

    fn balanced_jacobian(&self) -> DMatrix<f64> {
        crate::chain::passive::balanced_jacobian(&self.system, &self.factors)
    }

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
        let scaled = DVector::from_fn(6, |i, _| reaction[i] / (self.factors[i] * self.unit));
        let a = self.range.transpose() * scaled;
        DVector::from_fn(m + 1, |i, _| {
            if i < r {
                a[i]
            } else if i < m {
                coordinates[i - r] / (self.factors[6 + i - r] * self.unit)
            } else {
                value / self.sigma
            }
        })
    }

    /// Coordinates (m, rad) of a state.
    pub fn coordinates(&self, z: &DVector<f64>) -> Vec<f64> {
        let r = self.reactions();
        (0..self.coordinates_count())
            .map(|i| z[r + i] * self.factors[6 + i] * self.unit)
            .collect()
    }

    /// The state `to`, a step of an iteration away from `from`, as the springs of a chain with very stiff ones
    /// take that step: in their own strain.
    pub fn followed(&self, from: &DVector<f64>, to: DVector<f64>) -> DVector<f64> {
        match disparate(&self.factors, self.problem.chain) {
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
            to[r + i] = x / (self.factors[6 + i] * self.unit);
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
        let balanced = &self.range * z.rows(0, self.reactions());
        let reaction = Vector6::from_fn(|i, _| balanced[i] * self.factors[i] * self.unit);
        Wrench(reaction + self.given + self.grown * self.value(z))
    }

    /// Parameter of a state.
    pub fn value(&self, z: &DVector<f64>) -> f64 {
        z[self.count()] * self.sigma
    }

    /// Evaluates the system at a state; returns what equilibrium lacks, balanced, and its measure.
    pub fn evaluate(&mut self, z: &DVector<f64>) -> (DVector<f64>, Balance) {
        self.choose();
        let p = self.problem;
        let value = self.value(z);
        let (x, wrench) = (self.coordinates(z), self.wrench(z));
        self.system.pattern.1 = value;
        self.system.evaluate_problem(p, &x, &wrench, 1.0);
        let target = match self.parameter {
            Some(Parameter::Displacement(twist)) => moved(&p.end.pose, &Twist(twist.0 * value)),
            _ => p.end.pose,
        };
        let miss = pose_residual(&target, &self.system.kinematics.tip_pose());
        self.turned = miss.angular();
        let scaled = DVector::from_fn(6, |i, _| -miss.0[i] * self.factors[i] / self.unit);
        let closure = self.range.transpose() * &scaled;
        let (r, m) = (self.reactions(), self.count());
        let mut loads = 0.0_f64;
        let lack = DVector::from_fn(m, |i, _| {
            if i < r {
                closure[i]
            } else {
                let s = self.factors[6 + i - r] / self.unit;
                loads = loads
                    .max((self.system.torque[i - r] * s).abs())
                    .max((self.system.spring_torque[i - r] * s).abs());
                self.system.unbalanced(i - r) * s
            }
        });
        for i in 0..6 {
            loads = loads.max((wrench.0[i] / (self.factors[i] * self.unit)).abs());
        }
        let balance = Balance {
            closure: (self.frame.transpose() * &scaled).norm(),
            torque: lack.rows(r, m - r).norm(),
            loads,
            rounding: rounding(p.chain, &self.system, &self.factors) / self.unit,
        };
        (lack, balance)
    }

    pub fn converged(&self, b: &Balance) -> bool {
        b.torque.is_finite()
            && b.closure <= self.settings.closure
            && b.exceeding() <= self.settings.torque * b.loads + 1e-14
    }

    /// Change of the closure with the coordinates, balanced, r x n. Where some rotations are free,
    /// the rotation vector of what is lacking does not change by the motion alone.
    fn closure_rows(&self) -> DMatrix<f64> {
        let mut jacobian = self.balanced_jacobian();
        let own = rotation_rate(&self.turned);
        let turned = own * jacobian.fixed_rows::<3>(3);
        jacobian.fixed_rows_mut::<3>(3).copy_from(&turned);
        self.range.transpose() * jacobian
    }

    /// Derivative of the conditions by `(a, x)` where the system was evaluated, m x m.
    pub fn matrix(&self) -> DMatrix<f64> {
        self.assembled(true)
    }

    /// The same with loads and Jacobians lagged: without the loads' Hessian [R 4.15].
    pub fn lagged_matrix(&self) -> DMatrix<f64> {
        self.assembled(false)
    }

    fn assembled(&self, with_hessian: bool) -> DMatrix<f64> {
        let (n, r) = (self.coordinates_count(), self.reactions());
        let rows = self.reaction_rows();
        let mut a = DMatrix::zeros(r + n, r + n);
        a.view_mut((0, r), (r, n)).copy_from(&self.closure_rows());
        a.view_mut((r, 0), (n, r)).copy_from(&rows.transpose());
        a.view_mut((r, r), (n, n))
            .copy_from(&-self.spring_tangent());
        if with_hessian {
            let mut block = a.view_mut((r, r), (n, n));
            block += self.load_hessian();
        }
        if let Some(v) = self.neutral_motions() {
            let mut block = a.view_mut((r, r), (n, n));
            block -= &v * v.transpose();
        }
        a
    }

    /// Motions of the end that reactions hold, balanced, r x n.
    pub fn reaction_rows(&self) -> DMatrix<f64> {
        self.range.transpose() * self.balanced_jacobian()
    }

    /// Hessian of all loads, balanced, n x n; symmetric only where the loads allow it.
    pub fn load_hessian(&self) -> DMatrix<f64> {
        let n = self.coordinates_count();
        DMatrix::from_fn(n, n, |i, j| self.hessian(i, j))
    }

    /// Tangent of the springs, balanced, n x n.
    pub fn spring_tangent(&self) -> DMatrix<f64> {
        let n = self.coordinates_count();
        DMatrix::from_fn(n, n, |i, j| {
            self.system.spring_tangent[(i, j)] * self.factors[6 + i] * self.factors[6 + j]
        })
    }

    /// `H - K`, symmetric part, balanced, n x n.
    pub fn curvature(&self) -> DMatrix<f64> {
        let n = self.coordinates_count();
        let k = &self.system.spring_tangent;
        DMatrix::from_fn(n, n, |i, j| {
            let h = 0.5 * (self.hessian(i, j) + self.hessian(j, i));
            h - k[(i, j)] * self.factors[6 + i] * self.factors[6 + j]
        })
    }

    /// Units in which the springs' own stiffness is one at the state that was evaluated last (densely); none
    /// where no spring is very much stiffer than another.
    fn state_units(&self) -> Option<StateUnits> {
        let chain = self.problem.chain;
        disparate(&self.factors, chain).then(|| StateUnits {
            first: self.reactions(),
            count: self.coordinates_count(),
            material: MaterialUnits::of(chain, &material_springs(&self.system, &self.factors)),
        })
    }

    /// Size of a motion of the state that was evaluated last: where some springs are very much stiffer than others
    /// by what the springs store, as stiff coordinates go far without strain.
    pub fn size_of_motion(&self, motion: &DVector<f64>) -> f64 {
        let chain = self.problem.chain;
        if !disparate(&self.factors, chain) {
            return motion.norm();
        }
        let own = motion.rows(self.reactions(), self.coordinates_count());
        let x: Vec<f64> = own.iter().copied().collect();
        let stored: f64 = if let Some(sweep) = &self.system.sweep {
            let mut torques = vec![0.0; x.len()];
            sweep.spring_product(&x, &mut torques);
            x.iter().zip(&torques).map(|(x, t)| x * t).sum()
        } else {
            let springs = material_springs(&self.system, &self.factors);
            own.dot(&(springs * own))
        };
        let passive = chain.indices_of(Role::Passive).into_iter();
        let passive: f64 = passive.map(|i| x[i] * x[i]).sum();
        let rest = motion.norm_squared() - own.norm_squared();
        (rest.max(0.0) + passive + stored.max(0.0)).sqrt()
    }

    /// `[dG/du dG/dlambda]` at the state that was evaluated last (densely), with its units.
    pub fn whole(&self, matrix: DMatrix<f64>) -> CurveMatrix {
        let units = self.state_units();
        CurveMatrix::Dense(Whole { matrix, units })
    }

    /// Null directions of `[dG/du dG/dlambda]` (more rows or columns may follow) at the state that was evaluated
    /// last (densely).
    pub fn null_directions(&self, matrix: &DMatrix<f64>) -> NullDirections {
        let Some(units) = self.state_units() else {
            return NullDirections::of(matrix);
        };
        let mut found = NullDirections::of(&units.both(matrix.clone()));
        found.map(|vectors| units.directions(vectors));
        found
    }

    /// Orthonormal passive motions that change nothing here, n x neutral.
    pub fn neutral_motions(&self) -> Option<DMatrix<f64>> {
        if self.neutral == 0 {
            return None;
        }
        let columns = self.passive_columns();
        if !columns.iter().all(|v| v.is_finite()) {
            return None;
        }
        let gram = (columns.transpose() * &columns).symmetric_eigen();
        let mut order: Vec<usize> = (0..gram.eigenvalues.len()).collect();
        order.sort_by(|&i, &j| gram.eigenvalues[i].total_cmp(&gram.eigenvalues[j]));
        let passive = self.problem.chain.indices_of(Role::Passive);
        let mut v = DMatrix::zeros(self.coordinates_count(), self.neutral);
        for k in 0..self.neutral {
            for (j, &index) in passive.iter().enumerate() {
                v[(index, k)] = gram.eigenvectors[(j, order[k])];
            }
        }
        Some(v)
    }

    /// `[dG/du dG/dlambda]` at a state, with what equilibrium lacks there.
    pub fn linearised(&mut self, z: &DVector<f64>) -> (DVector<f64>, Balance, CurveMatrix) {
        let (lack, balance, gradient) = self.gradient(z);
        if let Some(sweep) = &self.system.sweep {
            let turned = turned_rows(&rotation_rate(&self.turned));
            if let Some(swept) = CurveSweep::new(sweep, &self.range, &turned, gradient) {
                return (lack, balance, CurveMatrix::Swept(Box::new(swept)));
            }
            let (lack, balance, matrix) = self.linearised_densely(z);
            let matrix = self.whole(matrix);
            return (lack, balance, matrix);
        }
        let matrix = self.with_gradient(&gradient);
        let matrix = self.whole(matrix);
        (lack, balance, matrix)
    }

    /// `[dG/du dG/dlambda]` where the (dense) system was evaluated.
    fn with_gradient(&self, gradient: &DVector<f64>) -> DMatrix<f64> {
        let m = self.count();
        let mut a = DMatrix::zeros(m, m + 1);
        a.columns_mut(0, m).copy_from(&self.matrix());
        a.column_mut(m).copy_from(gradient);
        a
    }

    /// `dG/dlambda` at a state, with what equilibrium lacks there; evaluates the system.
    pub fn gradient(&mut self, z: &DVector<f64>) -> (DVector<f64>, Balance, DVector<f64>) {
        let m = self.count();
        let r = self.reactions();
        let mut gradient = DVector::zeros(m);
        // All conditions are linear in the factor of loads: elsewhere first, here last.
        let step = (1.0 / self.sigma).abs().min(1.0);
        let ahead = match self.parameter {
            Some(Parameter::Load(pattern)) if !pattern.loads.is_empty() => {
                let mut ahead = z.clone();
                ahead[m] += step;
                Some(self.evaluate(&ahead).0)
            }
            _ => None,
        };
        let (lack, balance) = self.evaluate(z);
        match (self.parameter, ahead) {
            (Some(Parameter::Displacement(twist)), _) => {
                // A finite turn about a fixed axis keeps its axis; the end's origin moves straight.
                let turning = rotation_rate(&-self.turned) * twist.angular();
                let rate = Twist::new(twist.linear(), turning).0;
                let part = DVector::from_fn(6, |i, _| {
                    -rate[i] * self.factors[i] / self.unit * self.sigma
                });
                gradient
                    .rows_mut(0, r)
                    .copy_from(&(self.range.transpose() * part));
            }
            (Some(Parameter::Load(_)), Some(more)) => gradient = (more - &lack) / step,
            (Some(Parameter::Load(_)), None) => {
                for i in 0..m - r {
                    let pushed = self.system.jacobian.column(i).dot(&self.grown);
                    gradient[r + i] = pushed * self.factors[6 + i] / self.unit * self.sigma;
                }
            }
            (None, _) => {}
        }
        (lack, balance, gradient)
    }

    /// Chooses the parameter's unit and the reference of displacements at the start of a curve.
    pub fn start(
        &mut self,
        coordinates: &[f64],
        wrench: &Wrench,
        value: f64,
    ) -> Result<DVector<f64>> {
        self.sigma = 1.0;
        let z = self.state(coordinates, wrench, value);
        self.evaluate(&z);
        let balanced = |v: &Vector6<f64>, power: i32| {
            DVector::from_fn(6, |i, _| v[i] * self.factors[i].powi(power) / self.unit)
        };
        let size = match self.parameter {
            Some(Parameter::Displacement(twist)) => {
                let moved = balanced(&twist.0, 1);
                let within = self.range.transpose() * &moved;
                if within.norm() < (1.0 - 1e-9) * moved.norm() {
                    return Err(Error::model(
                        format!("chain '{}'", self.problem.chain.name()),
                        "the end of this chain can never move in the direction of the curve",
                    ));
                }
                moved.norm()
            }
            Some(Parameter::Load(pattern)) => {
                let mut wrenches = vec![(0, Wrench(self.grown))];
                for load in &pattern.loads {
                    let chain = self.problem.chain;
                    load.add_wrenches(chain, &self.system.kinematics, 1.0, &mut wrenches);
                }
                let sizes = wrenches.iter().map(|(_, w)| balanced(&w.0, -1).norm());
                sizes.fold(0.0, f64::max)
            }
            None => 1.0,
        };
        if !(size.is_finite() && size > 0.0) {
            return Err(Error::model(
                format!("chain '{}'", self.problem.chain.name()),
                "the load pattern of the curve is zero",
            ));
        }
        self.sigma = 1.0 / size;
        self.reference = (0..self.problem.chain.nodes().len())
            .map(|i| self.system.kinematics.node_pose(i))
            .collect();
        Ok(self.state(coordinates, wrench, value))
    }

    /// Conjugate of the parameter at the state where the system was evaluated.
    pub fn conjugate(&self, z: &DVector<f64>) -> f64 {
        match self.parameter {
            Some(Parameter::Displacement(twist)) => twist.0.dot(&self.wrench(z).0),
            Some(Parameter::Load(pattern)) => {
                let chain = self.problem.chain;
                let mut wrenches = vec![(chain.tip(), Wrench(self.grown))];
                for load in &pattern.loads {
                    load.add_wrenches(chain, &self.system.kinematics, 1.0, &mut wrenches);
                }
                wrenches
                    .iter()
                    .map(|(node, wrench)| {
                        let here = self.system.kinematics.node_pose(*node);
                        self.reference
                            .get(*node)
                            .map_or(0.0, |start| pose_residual(&here, start).dot(wrench))
                    })
                    .sum()
            }
            None => 0.0,
        }
    }

    /// A conjugate in natural units.
    pub fn natural_conjugate(&self, conjugate: f64) -> f64 {
        conjugate * self.sigma / (self.unit * self.unit)
    }

    /// Change of the conjugate per balanced unknown, by `dG/dlambda`.
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

    /// Newton from `z` on equilibrium and one more row.
    pub fn correct(&mut self, z: &DVector<f64>, row: &Row<'_>, most: usize) -> Option<Corrected> {
        let m = self.count();
        let mut z = z.clone();
        let mut last = f64::INFINITY;
        for iteration in 0..=most {
            let (lack, balance, matrix) = self.linearised(&z);
            let (normal, miss) = match row {
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
            let fine = self.converged(&balance) && miss.abs() <= 1e-11 * (1.0 + z.norm());
            if fine && (last < 1e-8 || iteration == most) {
                return Some(Corrected {
                    z,
                    matrix,
                    balance,
                    iterations: iteration,
                });
            }
            let finite = matrix.is_finite() && lack.iter().all(|v| v.is_finite());
            if iteration == most || !finite {
                return None;
            }
            let step = match matrix.step(&normal, &lack, miss, self.family.as_deref()) {
                Some(step) => step,
                None => {
                    let (lack, _, dense) = self.linearised_densely(&z);
                    self.whole(dense).step(&normal, &lack, miss, None)?
                }
            };
            let length = step.norm();
            if !length.is_finite() || (iteration > 1 && length > 2.0 * last && length > 1e-9) {
                // Beside very stiff springs the last steps are rounding.
                return fine.then_some(Corrected {
                    z,
                    matrix,
                    balance,
                    iterations: iteration,
                });
            }
            last = length;
            z = self.followed(&z, &z + step);
        }
        None
    }

    /// Rows (balanced) of the motions that are held: with the parameter's direction held as well,
    /// or left to a dead load.
    fn held_rows(&self, matrix: &CurveMatrix, motion: bool) -> DMatrix<f64> {
        let (r, n) = (self.reactions(), self.coordinates_count());
        let rows = self.range.transpose() * self.balanced_jacobian();
        let gradient = matrix.gradient();
        match self.parameter {
            Some(Parameter::Displacement(_)) if !motion => {
                let direction = DMatrix::from_fn(r, 1, |i, _| gradient[i]);
                complement(&direction).transpose() * rows
            }
            Some(Parameter::Load(_)) if motion => {
                let mut all = DMatrix::zeros(r + 1, n);
                all.rows_mut(0, r).copy_from(&rows);
                for j in 0..n {
                    all[(r, j)] = gradient[r + j];
                }
                all
            }
            _ => rows,
        }
    }

    /// Motions of the end that are held, balanced, 6 x k; `None` where the load that grows acts
    /// elsewhere too and what it does is held.
    fn held_motions(&self, matrix: &CurveMatrix, motion: bool) -> Option<DMatrix<f64>> {
        let r = self.reactions();
        match self.parameter {
            Some(Parameter::Displacement(_)) if !motion => {
                let gradient = matrix.gradient();
                let direction = DMatrix::from_fn(r, 1, |i, _| gradient[i]);
                Some(&self.range * complement(&direction))
            }
            Some(Parameter::Load(pattern)) if motion => {
                let pushed = Vector6::from_fn(|i, _| self.grown[i] / self.factors[i]);
                let unit = DVector::from_iterator(6, pushed.normalize().iter().copied());
                let mut all = self.range.clone().insert_column(r, 0.0);
                all.set_column(r, &unit);
                pattern.loads.is_empty().then_some(all)
            }
            _ => Some(self.range.clone()),
        }
    }

    /// Stability at a state, which was evaluated last, with the conjugate motion held (`motion`), or
    /// under a dead load.
    pub fn stability(&mut self, c: &Corrected, motion: bool) -> ShapeStability {
        if let Some(sweep) = &self.system.sweep {
            let swept = self.held_motions(&c.matrix, motion).and_then(|held| {
                let moved = column_space(&self.balanced_jacobian());
                let ends = EndMotions::held_in(moved, &held);
                swept_stability_within(sweep, &self.factors, &ends)
            });
            // Without a potential the symmetric part, which sweeps judge, is not the whole.
            let alone = match swept {
                Some(swept) if self.conservative || swept.stable => return swept,
                // One motion goes away exactly where the determinant is negative (`divergence.rs`).
                one => one.filter(|s| s.unstable_modes == 1 && self.family.is_none()),
            };
            let dense = self.densely(|own| {
                own.evaluate(&c.z);
                match alone {
                    Some(mut one) => {
                        one.stable = !own.determinant_is_negative(&c.matrix, motion);
                        one.unstable_modes = usize::from(!one.stable);
                        one
                    }
                    None => own.dense_stability(&c.matrix, motion),
                }
            });
            self.evaluate(&c.z);
            return dense;
        }
        self.dense_stability(&c.matrix, motion)
    }

    /// Whether `det V^T (K - H) V` is negative, `V` the motions that are free: `[0 R; R^T H - K]` with independent
    /// rows `R` of the others has its sign times `(-1)^n`.
    fn determinant_is_negative(&self, matrix: &CurveMatrix, motion: bool) -> bool {
        let rows = self.held_rows(matrix, motion);
        let rows = column_space(&rows).transpose() * rows;
        let (r, n) = rows.shape();
        let mut bordered = DMatrix::zeros(r + n, r + n);
        bordered
            .view_mut((r, 0), (n, r))
            .copy_from(&rows.transpose());
        bordered.view_mut((0, r), (r, n)).copy_from(&rows);
        bordered
            .view_mut((r, r), (n, n))
            .copy_from(&(self.load_hessian() - self.spring_tangent()));
        let factors = bordered.lu();
        // The product itself would leave the range of numbers.
        let turned = factors.u().diagonal().iter().filter(|x| **x < 0.0).count();
        let swapped = usize::from(factors.p().determinant::<f64>() < 0.0);
        (turned + swapped + n) % 2 == 1
    }

    fn dense_stability(&self, matrix: &CurveMatrix, motion: bool) -> ShapeStability {
        let rows = self.held_rows(matrix, motion);
        let rank = column_space(&rows).ncols();
        self.within_family(&rows, rank)
    }

    /// Stability while `rows` (of a rank) are held. The motions of a family are neither stable nor
    /// unstable, whatever rounding says: they are held too, counted as zeros, and named.
    fn within_family(&self, rows: &DMatrix<f64>, rank: usize) -> ShapeStability {
        let judge = |rows: &DMatrix<f64>| {
            let (chain, conservative) = (self.problem.chain, self.conservative);
            stability_within(chain, &self.system, &self.factors, rows, conservative)
        };
        let Some(family) = &self.family else {
            return judge(rows);
        };
        let (r, n) = (self.reactions(), self.coordinates_count());
        let (first, n_held) = (rows.nrows(), family.motions.ncols());
        let mut held = rows.clone().resize_vertically(first + n_held, 0.0);
        held.rows_mut(first, n_held)
            .copy_from(&family.motions.rows(r, n).transpose());
        let taken = column_space(&held).ncols().saturating_sub(rank);
        let mut stability = judge(&held);
        // Every motion held adds a positive and a negative eigenvalue in place of its zero.
        let inertia = &mut stability.inertia;
        inertia.positive = inertia.positive.saturating_sub(taken);
        inertia.negative = inertia.negative.saturating_sub(taken);
        inertia.zero += taken;
        if taken > 0 {
            stability.neutral.push("the whole shape".into());
        }
        stability
    }

    /// Everything that is known about a state, which was evaluated last.
    pub fn equilibrium(&mut self, c: &Corrected) -> Equilibrium {
        let raw = Balance {
            closure: c.balance.closure * self.unit,
            torque: c.balance.torque * self.unit,
            loads: c.balance.loads * self.unit,
            rounding: c.balance.rounding * self.unit,
        };
        let swept = self
            .system
            .swept_verdicts(self.problem.chain, &self.factors, None)
            .filter(|(_, s)| self.conservative || s.stable);
        if swept.is_none() && self.system.sweep.is_some() {
            let dense = self.densely(|own| {
                own.evaluate(&c.z);
                own.equilibrium(c)
            });
            self.evaluate(&c.z);
            return dense;
        }
        let mut equilibrium = self.system.equilibrium(
            self.problem.chain,
            &self.factors,
            self.coordinates(&c.z),
            self.wrench(&c.z),
            self.conservative,
            c.iterations,
            &raw,
            swept,
        );
        if let Some(family) = &self.family {
            // A family may go on while the whole end is held.
            let rows = self.balanced_jacobian();
            let (r, n) = (self.reactions(), self.coordinates_count());
            if (&rows * family.motions.rows(r, n)).amax() < 1e-6 * rows.amax() {
                let rank = column_space(&rows).ncols();
                equilibrium.stability = self.within_family(&rows, rank);
            }
        }
        equilibrium
    }
}
