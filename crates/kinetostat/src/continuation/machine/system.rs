//! A machine as a system in equilibrium with one parameter: the motions of its tool and the load, everything else
//! condensed.
//!
//! ```text
//! q    motions of the tool in which it is free, and the driven one (logarithm of its motion from the nominal target)
//! f    factor of the load
//! G(q, f) = V^T (W(q) - W_dead - f P) = 0        W(q): wrench that holds the tool at q [R 6.21]
//! dG/dq = V^T K A(q) V,   dG/df = -V^T P         K: stiffness of the tool with everything else free; A: twist per dq
//! ```
//!
//! Along a curve everything that is condensed moves too: the corrector is Newton's iteration of all platforms and limbs
//! with one condition on the motion of the tool (`Guided`), so that the tool need not be stable while it is held. What
//! happens to condensed parts alone (a limb that buckles while the tool stands still) changes no sign of `det dG/dq`; it is
//! seen by their stability ([`CurveSystem::condensed_modes`]).

use std::sync::Arc;

use nalgebra::{DMatrix, DVector, Matrix3, Matrix6, Vector6};

use crate::chain::residual::{FoundBy, ResidualNorms};
use crate::continuation::curve::CurvePoint;
use crate::continuation::linear::curve_matrix::CurveMatrix;
use crate::continuation::linear::family::Family;
use crate::continuation::linear::tangent::{NullDirections, Whole};
use crate::continuation::machine::tool_conditions::ToolConditions;
use crate::continuation::machine::tool_stability::{MachineStability, condensed_modes};
use crate::continuation::settings::CurveSettings;
use crate::continuation::tracing::describe::{describe, tangent};
use crate::continuation::tracing::special_points::NO_RATE;
use crate::continuation::tracing::system::{Corrected, CurveSystem, Row, off_segment};
use crate::error::{Error, Result};
use crate::linalg::complement::complement;
use crate::machine::equilibrium::{LimbEquilibrium, MechanismEquilibrium};
use crate::machine::platforms::parts::Guide;
use crate::machine::state::MechanismState;
use crate::spatial::{Pose, Twist, Wrench, hat, moved};

/// Share of the machine's size by which a step may move the tool where the load's rate says nothing.
const STEP: f64 = 0.02;

/// Steps of the usual length that the unit of motions is long.
const STEPS: f64 = 20.0;

/// Rates of the load below this share of the machine's stiffness do not choose a unit: in a flat posture the sign of what
/// rounding leaves of them would be a limit of the load.
const SOFT: f64 = 1e-5;

/// Largest step as a share of the distance from the start of the curve.
const OF_DISTANCE: f64 = 0.1;

/// Largest rotation of the tool, rad: its logarithm ends at half a turn.
const LARGEST_TURN: f64 = 3.0;

/// Residual below which a machine with its tool held counts as in equilibrium; equations are in units in which each
/// one's largest derivative is one.
const CONVERGED: f64 = 1e-9;

/// Strains that differ by less are the same, rad and shares of the machine's length.
const SAME_STRAIN: f64 = 1e-5;

/// Distance from a step of a branch beyond which a shape is not on it, as a share of the step's change of strains.
const OFF_BRANCH: f64 = 0.3;

/// A limb whose share of the way to buckling differs from 1 by less is at its critical load: as exactly as a change of
/// stability is located.
const CRITICAL: f64 = 1e-3;

/// Pushes along a limb's critical mode whose largest component is 1 (rad, m), from which its new shape is looked for.
const PUSHES: [f64; 4] = [0.1, 0.03, 0.3, 0.01];

/// Largest distance of a new shape along the critical mode.
const FARTHEST_ARM: f64 = 0.7;

/// An equilibrium with its tool held at a state.
struct Solved {
    z: DVector<f64>,
    equilibrium: MechanismEquilibrium,
}

/// System of a machine's curve.
pub(crate) struct MachineSystem<'q, 'p> {
    conditions: &'q ToolConditions<'p>,
    /// Motions of the tool, scaled, orthonormal; the driven one last.
    motions: DMatrix<f64>,
    /// Metres per unit of a motion.
    length: f64,
    /// Load factor per unit.
    load: f64,
    /// Equations by combinations of the equilibrium of the tool in the motions, each in its unit.
    rows: DMatrix<f64>,
    /// Start of the curve.
    first: DVector<f64>,
    /// Result of the last evaluation.
    here: Solved,
    /// Start of the search for the next equilibrium, and the load factor there.
    near: (MechanismState, Wrench, f64),
    family: Option<Arc<Family>>,
}

impl<'q, 'p> MachineSystem<'q, 'p> {
    /// Starts with units from the first equilibrium and the load factor there; returns its state.
    pub fn start(
        conditions: &'q ToolConditions<'p>,
        first: &MechanismEquilibrium,
        factor: f64,
    ) -> (Self, DVector<f64>) {
        let here = Solved {
            z: DVector::zeros(0),
            equilibrium: first.clone(),
        };
        let mut system = Self {
            motions: motions_of(conditions),
            conditions,
            length: conditions.length,
            load: 1.0,
            rows: DMatrix::zeros(0, 0),
            first: DVector::zeros(0),
            here,
            near: (first.state.clone(), first.wrench, factor),
            family: None,
        };
        system.choose_units(first);
        let z = system.state(first, factor);
        system.here.z.clone_from(&z);
        system.first.clone_from(&z);
        (system, z)
    }

    /// Motions in usual steps, loads so that the curve starts at 45 degrees, equations by the principal stiffnesses.
    fn choose_units(&mut self, e: &MechanismEquilibrium) {
        let path = self.conditions;
        let (stiffness, push) = self.tangents(e);
        let n = push.len();
        let stiff = path.posture.mechanism.scale().stiffness;
        let own = ((&stiffness + stiffness.transpose()) * 0.5).symmetric_eigen();
        // Motion per load factor where nothing but the load acts, and its rate.
        let mut along = DVector::zeros(n);
        for (value, v) in own.eigenvalues.iter().zip(own.eigenvectors.column_iter()) {
            let size = value.abs().max(1e-12 * stiff);
            along += v * (v.dot(&push) / size);
        }
        let rate = match along.norm() > 0.0 {
            true => 1.0 / along.norm(),
            false => 0.0,
        };
        let settings = &path.settings;
        let width = settings.range.1 - settings.range.0;
        let change = settings.largest_change.unwrap_or(width / STEPS);
        let most = STEP * path.length;
        let driven = path.by_motion.then(|| self.displacement_per_motion());
        let step = match driven {
            Some(by) => change / by,
            None => change / rate.max(1e-300),
        };
        let step = if path.by_motion { step } else { step.min(most) };
        let step = if step.is_finite() && step > 0.0 {
            step
        } else {
            most
        };
        self.length = STEPS * step;
        let least = SOFT * stiff / push.norm().max(f64::MIN_POSITIVE);
        self.load = self.length * rate.max(least);
        let mut rows = own.eigenvectors.transpose();
        for (i, value) in own.eigenvalues.iter().enumerate() {
            let load = rows.row(i).transpose().dot(&push).abs() * self.load;
            let size = (value.abs() * self.length).max(load);
            let size = size.max(1e-12 * stiff * self.length);
            rows.row_mut(i).unscale_mut(size);
        }
        self.rows = rows;
    }

    /// Displacement (m, rad) per driven motion.
    fn displacement_per_motion(&self) -> f64 {
        let last = self.motions.ncols() - 1;
        let v = self.motions.column(last);
        let path = self.conditions;
        path.displacement(&path.unscaled(&Vector6::from_fn(|i, _| v[i])))
    }

    /// Position of the load factor among the unknowns.
    fn load_at(&self) -> usize {
        let n = self.motions.ncols();
        match self.conditions.by_motion {
            true => n - 1,
            false => n,
        }
    }

    /// Position of a motion among the unknowns.
    fn motion_at(&self, i: usize) -> usize {
        if i < self.load_at() { i } else { i + 1 }
    }

    /// Motions (m, scaled) of a direction of states, and its change of the load factor.
    fn physical(&self, z: &DVector<f64>) -> (DVector<f64>, f64) {
        let n = self.motions.ncols();
        let q = DVector::from_fn(n, |i, _| z[self.motion_at(i)] * self.length);
        (q, z[self.load_at()] * self.load)
    }

    fn state(&self, e: &MechanismEquilibrium, factor: f64) -> DVector<f64> {
        let path = self.conditions;
        let motion = path.scaled(&path.motion(&e.tool));
        let q = self.motions.transpose() * motion;
        let mut z = DVector::zeros(q.len() + 1);
        for i in 0..q.len() {
            z[self.motion_at(i)] = q[i] / self.length;
        }
        z[self.load_at()] = factor / self.load;
        z
    }

    /// The state of a known equilibrium; what is looked for next lies near it.
    pub fn place(&mut self, e: &MechanismEquilibrium) -> DVector<f64> {
        self.start_from(e);
        self.state(e, self.near.2)
    }

    /// Pose of the tool at some motions.
    fn pose(&self, q: &DVector<f64>) -> Pose {
        let path = self.conditions;
        let own = &self.motions * q;
        let own = path.unscaled(&Vector6::from_fn(|i, _| own[i]));
        moved(&path.posture.target, &Twist(own + path.displacement))
    }

    /// `V^T K A V` and `V^T P`: what the machine cannot do stays as it is.
    fn tangents(&self, e: &MechanismEquilibrium) -> (DMatrix<f64>, DVector<f64>) {
        let path = self.conditions;
        let v = &self.motions;
        let own = v.transpose() * path.possible(e, v);
        let possible = &own * own.transpose();
        let by_turn = twist_of_logarithm(&path.motion(&e.tool));
        let stiff = path.posture.mechanism.scale().stiffness;
        let k = v.transpose() * path.scaled_stiffness(e) * by_turn * v;
        let n = v.ncols();
        let rigid = DMatrix::identity(n, n) - &possible;
        let push = v.transpose() * path.unscaled(&path.pattern.0);
        (
            &possible * k * &possible + rigid * stiff,
            &possible * DVector::from_column_slice(push.as_slice()),
        )
    }

    /// `[dG/du dG/dlambda]` at an equilibrium with its tool held.
    fn matrix(&self, e: &MechanismEquilibrium) -> DMatrix<f64> {
        let (k, push) = self.tangents(e);
        let n = push.len();
        let k = &self.rows * k * self.length;
        let push = &self.rows * push * -self.load;
        let mut a = DMatrix::zeros(n, n + 1);
        for i in 0..n {
            a.set_column(self.motion_at(i), &k.column(i));
        }
        a.set_column(self.load_at(), &push);
        a
    }

    /// Residual at an equilibrium with its tool held, under a load factor.
    fn residual(&self, e: &MechanismEquilibrium, factor: f64) -> (DVector<f64>, ResidualNorms) {
        let path = self.conditions;
        let over = e.wrench.0 - path.dead.0 - path.pattern.0 * factor;
        let own = self.motions.transpose() * path.possible(e, &self.motions);
        let over = self.motions.transpose() * path.unscaled(&over);
        let over = &own * (own.transpose() * over);
        let residual = &self.rows * over;
        let norms = ResidualNorms {
            closure: e.residual.closure_m / path.length,
            torque: residual.norm(),
            loads: 1.0,
            rounding: 0.0,
        };
        (residual, norms)
    }

    /// The machine with its tool held where a state has it; from what was found last.
    fn hold(&mut self, z: &DVector<f64>) -> Option<&MechanismEquilibrium> {
        if self.here.z != *z {
            let path = self.conditions;
            let (q, _) = self.physical(z);
            let mut state = self.near.0.clone();
            state.platforms[path.posture.mechanism.tool()] = self.pose(&q);
            let mut guide = path.guide(None);
            let (held, n) = (guide.rows.nrows(), q.len());
            guide.rows = guide.rows.insert_rows(held, n, 0.0);
            guide.goals = guide.goals.clone().resize_vertically(held + n, 0.0);
            guide.hands = guide.hands.insert_columns(held, n, 0.0);
            for i in 0..n {
                let v = Vector6::from_fn(|k, _| self.motions[(k, i)]);
                let row = path.scaled(&v);
                let size = row.norm();
                guide.rows.set_row(held + i, &(row / size).transpose());
                guide.hands.set_column(held + i, &(row / size));
                guide.goals[held + i] = q[i] / size;
            }
            let found = path.converge(state, self.near.1, guide, false).ok();
            let (equilibrium, _) = found?;
            self.here = Solved {
                z: z.clone(),
                equilibrium,
            };
        }
        Some(&self.here.equilibrium)
    }

    /// The machine let go from a point, under a load.
    pub fn let_go(
        &mut self,
        from: &CurvePoint<MechanismEquilibrium>,
        load: f64,
    ) -> Option<CurvePoint<MechanismEquilibrium>> {
        self.resume(from);
        let row = match self.conditions.by_motion {
            true => Row::Conjugate(load),
            false => Row::Parameter(load),
        };
        let c = self.correct(&from.z, &row, 12)?;
        let t = tangent(self, &c.matrix, &from.tangent)?;
        Some(describe(self, &c, t.direction))
    }

    /// A limb's shape beside a point at which it becomes critical, to one side along its mode.
    fn arm(
        &mut self,
        at: &CurvePoint<MechanismEquilibrium>,
        limb: usize,
        sign: f64,
    ) -> Option<(DVector<f64>, MechanismEquilibrium)> {
        let mode = &at.equilibrium.limbs[limb].stability.mode;
        let longest = self.longest_step(&at.tangent, &self.conditions.settings);
        let steps = [0.1, 0.4].map(|share| share * longest);
        for (step, size) in steps.iter().flat_map(|h| PUSHES.map(|size| (*h, size))) {
            for z in [step, -step].map(|by| &at.z + &at.tangent * by) {
                self.start_from(&at.equilibrium);
                self.here.z = DVector::zeros(0);
                let Some(own) = self.hold(&z).cloned() else {
                    continue;
                };
                let pushed = self.near.0.coordinates[limb].iter_mut().zip(mode);
                pushed.for_each(|(x, m)| *x += sign * size * m);
                self.here.z = DVector::zeros(0);
                let Some(found) = self.hold(&z).cloned() else {
                    continue;
                };
                let (before, after) = (&own.limbs[limb], &found.limbs[limb]);
                let moved = after.coordinates.iter().zip(&before.coordinates);
                let along: f64 = moved.zip(mode).map(|((x, y), m)| sign * m * (x - y)).sum();
                let far = along > FARTHEST_ARM * mode.iter().map(|m| m * m).sum::<f64>();
                if along > 0.0 && !far && self.condensed_apart(&found, &own, &own) {
                    return Some((self.place(&found), found));
                }
            }
        }
        None
    }

    /// Equilibrium near a state under one condition on the motion, or at its load.
    fn converge(&self, z: &DVector<f64>, row: &Row<'_>) -> Result<(MechanismEquilibrium, f64)> {
        let path = self.conditions;
        let (q, factor) = self.physical(z);
        let mut state = self.near.0.clone();
        state.platforms[path.posture.mechanism.tool()] = self.pose(&q);
        let (near, factor_near) = (self.near.1, self.near.2);
        let by = |factor: f64| near + path.pattern * (factor - factor_near);
        let guide: (Guide, f64) = match (row, path.by_motion) {
            (Row::Plane(normal, _), _) => {
                let own = DVector::from_fn(q.len(), |i, _| normal[self.motion_at(i)]);
                let along = &self.motions * &own;
                let along = path.scaled(&Vector6::from_fn(|i, _| along[i]));
                match own.norm() > 1e-12 {
                    true => (path.guide(Some((&along, own.dot(&q)))), factor),
                    false => (path.guide(None), factor),
                }
            }
            (Row::Parameter(value), true) | (Row::Conjugate(value), false) => {
                (path.guide(Some((&path.pattern.0, *value))), factor)
            }
            (Row::Parameter(value), false) | (Row::Conjugate(value), true) => {
                (path.guide(None), *value)
            }
        };
        path.converge(state, by(guide.1), guide.0, false)
    }
}

impl CurveSystem for MachineSystem<'_, '_> {
    type Equilibrium = MechanismEquilibrium;

    fn count(&self) -> usize {
        self.motions.ncols()
    }

    fn is_load(&self) -> bool {
        !self.conditions.by_motion
    }

    fn sigma(&self) -> f64 {
        match self.conditions.by_motion {
            true => self.displacement_per_motion() * self.length,
            false => self.load,
        }
    }

    /// If the parameter is stationary (a flat posture under a load), its conjugate grows.
    fn points_forward(&self, t: &DVector<f64>) -> bool {
        let rate = t[self.count()];
        match rate.abs() > NO_RATE {
            true => rate > 0.0,
            false => self.conjugate_row(t).dot(t) >= 0.0,
        }
    }

    /// A flat posture: the load starts to move the tool where nothing holds it yet, not along what moves for nothing.
    fn start_where_still(&self, null: &DMatrix<f64>) -> DVector<f64> {
        let push = self.conjugate_row(&DVector::zeros(0));
        let along = null * (null.transpose() * &push);
        match along.norm() > 1e-9 * push.norm() {
            true => along.normalize(),
            false => null.column(0).into_owned(),
        }
    }

    /// A tool that has turned is elsewhere for the curve.
    fn full_turns(&self) -> Vec<f64> {
        vec![0.0; self.count() + 1]
    }

    fn start_from(&mut self, near: &MechanismEquilibrium) {
        let factor = self.conditions.factor(&near.wrench);
        self.near = (near.state.clone(), near.wrench, factor);
    }

    fn family(&self) -> Option<&Arc<Family>> {
        self.family.as_ref()
    }

    fn set_family(&mut self, family: Option<Arc<Family>>) {
        self.family = family;
    }

    /// Matrices are always dense here.
    fn set_dense(&mut self, _dense: bool) {}

    fn condensed_modes(found: &MechanismEquilibrium) -> usize {
        condensed_modes(found)
    }

    fn condensed_apart(
        &self,
        found: &MechanismEquilibrium,
        a: &MechanismEquilibrium,
        b: &MechanismEquilibrium,
    ) -> bool {
        let strains =
            |e: &MechanismEquilibrium| DVector::from_vec(self.conditions.spring_strains(e));
        let (found, a, b) = (strains(found), strains(a), strains(b));
        let step = (&b - &a).norm();
        off_segment(&found, &a, &b, &vec![0.0; a.len()]) > OFF_BRANCH * step + SAME_STRAIN
    }

    /// A limb at its critical load, pushed along its mode while the tool is held a little before or behind.
    fn condensed_arms(
        &mut self,
        at: &CurvePoint<MechanismEquilibrium>,
    ) -> Vec<[Option<(DVector<f64>, MechanismEquilibrium)>; 2]> {
        let critical = |limb: &LimbEquilibrium| {
            let share = limb.stability.share_to_buckling;
            !limb.stability.mode.is_empty() && share.is_some_and(|mu| (mu - 1.0).abs() < CRITICAL)
        };
        let limbs = at.equilibrium.limbs.iter().enumerate();
        let limbs: Vec<usize> = limbs.filter(|(_, l)| critical(l)).map(|(i, _)| i).collect();
        let arms = limbs
            .into_iter()
            .map(|i| [1.0, -1.0].map(|sign| self.arm(at, i, sign)));
        arms.collect()
    }

    fn evaluate(&mut self, z: &DVector<f64>) -> (DVector<f64>, ResidualNorms) {
        let (_, factor) = self.physical(z);
        match self.hold(z).cloned() {
            Some(e) => self.residual(&e, factor),
            None => {
                let nothing = DVector::from_element(self.count(), f64::NAN);
                let norms = ResidualNorms {
                    closure: f64::NAN,
                    torque: f64::NAN,
                    loads: 1.0,
                    rounding: 0.0,
                };
                (nothing, norms)
            }
        }
    }

    fn converged(&self, norms: &ResidualNorms) -> bool {
        norms.torque <= CONVERGED
    }

    fn linearised(&mut self, z: &DVector<f64>) -> (DVector<f64>, ResidualNorms, CurveMatrix) {
        let (residual, norms, matrix) = self.linearised_densely(z);
        (residual, norms, self.whole(matrix))
    }

    fn linearised_densely(
        &mut self,
        z: &DVector<f64>,
    ) -> (DVector<f64>, ResidualNorms, DMatrix<f64>) {
        let (residual, norms) = self.evaluate(z);
        let n = self.count();
        let matrix = match self.here.z == *z {
            true => self.matrix(&self.here.equilibrium),
            false => DMatrix::from_element(n, n + 1, f64::NAN),
        };
        (residual, norms, matrix)
    }

    fn gradient(&mut self, z: &DVector<f64>) -> DVector<f64> {
        let (_, _, matrix) = self.linearised_densely(z);
        matrix.column(self.count()).into_owned()
    }

    fn whole(&self, matrix: DMatrix<f64>) -> CurveMatrix {
        CurveMatrix::Dense(Whole {
            matrix,
            units: None,
        })
    }

    fn null_directions(&self, matrix: &DMatrix<f64>) -> NullDirections {
        NullDirections::of(matrix)
    }

    fn correct(&mut self, z: &DVector<f64>, row: &Row<'_>, _most: usize) -> Option<Corrected> {
        let (equilibrium, factor) = self.converge(z, row).ok()?;
        let z = self.state(&equilibrium, factor);
        let iterations = equilibrium.residual.iterations;
        let (_, norms) = self.residual(&equilibrium, factor);
        let matrix = self.whole(self.matrix(&equilibrium));
        self.near = (equilibrium.state.clone(), equilibrium.wrench, factor);
        self.here = Solved {
            z: z.clone(),
            equilibrium,
        };
        matrix.is_finite().then_some(Corrected {
            z,
            matrix,
            norms,
            iterations,
        })
    }

    fn followed(&self, _from: &DVector<f64>, to: DVector<f64>) -> DVector<f64> {
        to
    }

    /// Motion of the tool.
    fn motion(&self, direction: &DVector<f64>) -> Vec<f64> {
        let own = &self.motions * self.physical(direction).0;
        let own = Vector6::from_fn(|i, _| own[i]);
        self.conditions.unscaled(&own).iter().copied().collect()
    }

    fn size_of_motion(&self, motion: &DVector<f64>) -> f64 {
        motion.norm()
    }

    fn longest_step(&self, t: &DVector<f64>, _settings: &CurveSettings) -> f64 {
        let (moved, load) = self.physical(t);
        let (moved, load) = (moved.norm(), (load / self.load).abs());
        // A branch may move the tool where the start's own hardly did: steps grow with the distance.
        let away = self.physical(&(&self.here.z - &self.first)).0.norm();
        let far = (OF_DISTANCE * away).min(STEP * self.conditions.length);
        let most = (4.0 / STEPS * self.length).max(far);
        (most / moved.max(1e-300)).min(2.0 / load.max(1e-300))
    }

    fn beyond_angle(&self, found: &MechanismEquilibrium, largest: f64) -> bool {
        let turned = self.conditions.motion(&found.tool);
        turned.fixed_rows::<3>(3).norm() > largest.min(LARGEST_TURN)
    }

    fn conjugate(&self, z: &DVector<f64>) -> f64 {
        let path = self.conditions;
        let (q, factor) = self.physical(z);
        match path.by_motion {
            true => factor,
            false => path.displacement(&path.motion(&self.pose(&q))),
        }
    }

    fn conjugate_row(&self, _gradient: &DVector<f64>) -> DVector<f64> {
        let path = self.conditions;
        let n = self.count();
        let mut row = DVector::zeros(n + 1);
        if path.by_motion {
            row[self.load_at()] = self.load;
            return row;
        }
        let push = self.motions.transpose() * path.unscaled(&path.pattern.0);
        for i in 0..n {
            row[self.motion_at(i)] = push[i] * self.length;
        }
        row
    }

    fn natural_conjugate(&self, conjugate: f64) -> f64 {
        conjugate / self.conjugate_row(&DVector::zeros(0)).norm()
    }

    fn stability(&mut self, c: &Corrected, motion: bool) -> MachineStability {
        // If the tool cannot be held, the last equilibrium is the nearest one.
        let e = self.hold(&c.z).cloned();
        let e = e.as_ref().unwrap_or(&self.here.equilibrium);
        self.conditions.machine_stability(e, motion)
    }

    fn equilibrium(&mut self, _c: &Corrected) -> MechanismEquilibrium {
        MechanismEquilibrium {
            found_by: FoundBy::Continuation,
            ..self.here.equilibrium.clone()
        }
    }

    fn not_converged(&mut self, _z: &DVector<f64>, iterations: usize) -> Error {
        Error::NotConverged {
            place: self.conditions.posture.mechanism.place(),
            iterations,
            residual_position_m: self.here.equilibrium.residual.closure_m,
            residual_torque: self.here.equilibrium.residual.torque,
            load_factor: 0.0,
            last: self.near.0.coordinates.concat(),
            limit: None,
        }
    }
}

/// Motions in which the tool is free, and the driven one last, so that its displacement grows with it.
fn motions_of(path: &ToolConditions<'_>) -> DMatrix<f64> {
    if !path.by_motion {
        return path.motions.clone();
    }
    let inside = path.motions.transpose() * &path.free;
    let mut driven = &path.motions * complement(&inside);
    let first = Vector6::from_fn(|i, _| driven[(i, 0)]);
    if path.displacement(&path.unscaled(&first)) < 0.0 {
        driven *= -1.0;
    }
    let k = path.free.ncols();
    let mut all = path.free.clone().insert_column(k, 0.0);
    all.set_column(k, &driven.column(0));
    all
}

/// Twist of a tool per change of the logarithm of its motion: of the rotations it is no sum.
fn twist_of_logarithm(motion: &Vector6<f64>) -> Matrix6<f64> {
    let turned = motion.fixed_rows::<3>(3).into_owned();
    let angle = turned.norm();
    let mut all = Matrix6::identity();
    if angle > 1e-9 {
        let cross = hat(&turned);
        let by_turn = Matrix3::identity()
            + cross * ((1.0 - angle.cos()) / (angle * angle))
            + cross * cross * ((angle - angle.sin()) / angle.powi(3));
        all.fixed_view_mut::<3, 3>(3, 3).copy_from(&by_turn);
    }
    all
}
