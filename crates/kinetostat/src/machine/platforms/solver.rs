//! Equilibrium of the platforms of a mechanism [R 6.21-6.30].
//!
//! Each limb is condensed to what it answers at its end, `F_i` and its tangent; the platforms are
//! solved; the limbs follow. One such step equals one Newton step of the whole flattened system, so
//! nothing is lost, and a limb that fails is named.
//!
//! ```text
//! W = sum T_i^T F_i,     T_i = [I, -hat(s_i); 0, I]
//! K = sum T_i^T K_i T_i + sum blkdiag(0, hat(f_i) hat(s_i))      (second sum: missing in [R 5.28])
//! ```
//!
//! A limb that starts at a moving platform loads it with everything that acts on the limb; that
//! reaction and its derivative come from six motions of the limb's base.

use nalgebra::{DMatrix, DVector, Matrix3, Vector3, Vector6};

use crate::chain::equilibrium::{System, balance, rounding};
use crate::chain::passive::balanced_jacobian;
use crate::chain::residual::Balance;
use crate::chain::scaling::{LEAST_LOAD, step_limit};
use crate::chain::stability::{ShapeStability, shape_stability};
use crate::chain::stiffness::{ChainStiffness, chain_stiffness, motions_of_end};
use crate::error::{Error, Result};
use crate::linalg::sparse::Sparse;
use crate::machine::inverse::graph::{GraphPosture, graph_inverse, graph_rates};
use crate::machine::inverse::limb::{LimbPosture, command_rates, inverse_kinematics};
use crate::machine::platforms::chain::ToolBalance;
use crate::machine::platforms::limb::Linear;
use crate::machine::platforms::step::{PlatformStep, Tangents};
use crate::machine::state::MechanismState;
use crate::model::chain::{Chain, Scale};
use crate::model::loads::load::Load;
use crate::model::mechanism::Mechanism;
use crate::settings::Settings;
use crate::spatial::{MotionKind, Pose, Twist, Wrench, hat, moved, pose_residual, shift_matrix};

/// How the unknowns of the platform equations are divided.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Unknowns {
    /// All platforms move; commands are given.
    Pose,
    /// The tool is held and its wrench follows; other platforms move.
    Held,
    /// The tool is held in the directions that are `true` and the nominal target moves there
    /// instead: compensation.
    Target([bool; 6]),
    /// The tool is held where [`PlatformSolver::guide`] says, and the wrenches that hold it there
    /// follow: a part of [`PlatformSolver::wrench`]. Everything else moves.
    Guided,
}

/// Conditions on the motion of the tool from a pose, and as many wrenches on it.
#[derive(Clone, Debug)]
pub(crate) struct Guide {
    /// Where the motion is counted from.
    pub from: Pose,
    /// Conditions `rows * motion = goals`, k x 6, base axes.
    pub rows: DMatrix<f64>,
    /// See `rows`, k.
    pub goals: DVector<f64>,
    /// Columns: wrenches about the tool's origin, base axes, 6 x k.
    pub hands: DMatrix<f64>,
}

impl Guide {
    /// No condition.
    pub fn none() -> Self {
        Self {
            from: Pose::identity(),
            rows: DMatrix::zeros(0, 6),
            goals: DVector::zeros(0),
            hands: DMatrix::zeros(6, 0),
        }
    }

    /// What the motion to `pose` lacks of the goals.
    pub fn lack(&self, pose: &Pose) -> DVector<f64> {
        &self.goals - &self.rows * pose_residual(pose, &self.from).0
    }

    /// Rows by the motion of the tool at `pose`: the logarithm is no sum.
    pub fn rows_at(&self, pose: &Pose) -> DMatrix<f64> {
        let turned = pose_residual(pose, &self.from).angular();
        let angle = turned.norm();
        let mut rows = self.rows.clone();
        if angle > 1e-9 {
            let cross = hat(&turned);
            let share = (1.0 - 0.5 * angle / (0.5 * angle).tan()) / (angle * angle);
            let by_turn = Matrix3::identity() - cross * 0.5 + cross * cross * share;
            let turns = rows.columns(3, 3) * by_turn;
            rows.columns_mut(3, 3).copy_from(&turns);
        }
        rows
    }
}

/// Where an iteration is.
struct Place {
    state: MechanismState,
    posture: Vec<LimbPosture>,
    nominal: Vec<Pose>,
    target: Pose,
    wrench: Wrench,
}

/// Corrections of less motion than this (rad, natural lengths) are judged by the residual after them,
/// larger ones by the motion that the same tangents still want.
const SMALL: f64 = 1e-2;

/// A mechanism's equilibrium being solved.
pub(crate) struct PlatformSolver<'m> {
    pub mechanism: &'m Mechanism,
    pub settings: Settings,
    /// Wrench on the tool, about its origin, base axes.
    pub wrench: Wrench,
    /// Dead wrenches on other platforms, about their origins, base axes.
    pub others: Vec<(usize, Wrench)>,
    /// Joints of the commanded, unloaded posture.
    pub posture: Vec<LimbPosture>,
    pub unknowns: Unknowns,
    pub guide: Guide,
    /// Pose of the tool for which the limbs are commanded, t0.
    pub target: Pose,
    /// Poses of all platforms for which the limbs are commanded.
    pub nominal: Vec<Pose>,
    /// Motion of the commands per motion of the nominal target at its origin, per limb, r x 6.
    pub rates: Vec<DMatrix<f64>>,
    pub state: MechanismState,
    pub factors: Vec<Vec<f64>>,
    /// What acts on every limb between its ends: gravity and its loads.
    pub loads: Vec<Vec<Load>>,
    pub linear: Vec<Linear>,
    /// Of a machine that is one chain: what its tool lacks, as it was linearised.
    pub balance: Option<ToolBalance>,
    /// Closure at the start, kept while the load grows.
    offsets: Vec<Twist>,
    /// Limbs from the base outwards, where every moving platform has a single limb to it; else none.
    tree: Vec<usize>,
    /// The tool is led to its place while the load grows, its limb after it.
    leads: bool,
    pub share: f64,
    /// See [`crate::Residual::rate`], of the limbs' wrenches and coordinates.
    pub rate: Option<f64>,
    pub length: f64,
    pub stiffness: f64,
}

/// Largest residuals of all limbs and platforms, balanced.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MechanismBalance {
    merit: f64,
    closure_m: f64,
    torque: f64,
    loads: f64,
    force: f64,
    forces: f64,
    /// What loads count as at least, see [`LEAST_LOAD`].
    least: f64,
    /// Largest unbalanced torque without what is rounding, see [`rounding`].
    exceeding: f64,
}

impl MechanismBalance {
    /// Closure in metres and unbalanced share.
    pub fn residual(&self, iterations: usize) -> crate::chain::residual::Residual {
        crate::chain::residual::Residual {
            closure_m: self.closure_m,
            torque: (self.torque / self.loads.max(self.least))
                .max(self.force / self.forces.max(self.least)),
            iterations,
            rate: None,
        }
    }
}

impl<'m> PlatformSolver<'m> {
    pub fn new(
        mechanism: &'m Mechanism,
        settings: Settings,
        posture: Vec<LimbPosture>,
        state: MechanismState,
        unknowns: Unknowns,
    ) -> Self {
        let limbs = &mechanism.limbs;
        let factors: Vec<Vec<f64>> = limbs
            .iter()
            .zip(&posture)
            .map(|(l, p)| balance(&l.actual, &p.coordinates))
            .collect();
        let linear = limbs
            .iter()
            .zip(&posture)
            .zip(&factors)
            .map(|((l, p), factors)| {
                let base = &state.platforms[l.from];
                // What follows from commands and from a moving base is asked of dense matrices.
                let dense = matches!(unknowns, Unknowns::Target(_)) || l.from != 0;
                let (x, commands) = (&p.coordinates, &p.commands);
                Linear::new(match dense {
                    true => System::new(&l.actual, base, x, commands, l.from != 0),
                    false => System::of_chain(&l.actual, base, x, commands, factors, None),
                })
            })
            .collect();
        let loads = (0..limbs.len()).map(|i| mechanism.acting(i)).collect();
        let Scale { length, stiffness } = mechanism.scale();
        Self {
            mechanism,
            settings,
            wrench: Wrench::zero(),
            others: Vec::new(),
            target: state.platforms[mechanism.tool],
            nominal: mechanism.platforms.iter().map(|p| p.home).collect(),
            posture,
            unknowns,
            guide: Guide::none(),
            rates: Vec::new(),
            state,
            factors,
            loads,
            linear,
            balance: None,
            offsets: vec![Twist::zero(); limbs.len()],
            tree: tree(mechanism),
            leads: false,
            share: 1.0,
            rate: None,
            length,
            stiffness,
        }
    }

    /// Arm from the reference point of `to` to the limb's tip at a state, base axes, m.
    pub fn arm(&self, limb: usize, at: &MechanismState) -> Vector3<f64> {
        let l = &self.mechanism.limbs[limb];
        at.platforms[l.to].rotation * l.platform_from_tip.translation.vector
    }

    /// Platforms go where their limbs lead: every one has a single limb, which alone says where.
    pub fn follows(&self) -> bool {
        let free = matches!(self.unknowns, Unknowns::Pose | Unknowns::Guided);
        free && !self.tree.is_empty() && !self.leads
    }

    /// Evaluates a limb at the present state.
    pub fn evaluate_limb(&mut self, i: usize) {
        let limb = &self.mechanism.limbs[i];
        let system = &mut self.linear[i].system;
        for _ in 0..2 {
            system.evaluate(
                &limb.actual,
                &self.state.platforms[limb.from],
                &self.posture[i].coordinates,
                &self.posture[i].commands,
                &self.loads[i],
                &self.state.coordinates[i],
                &self.state.wrenches[i],
                self.share,
            );
            if system.sweep.as_ref().is_none_or(|s| s.serial) {
                break;
            }
            system.make_dense();
        }
    }

    fn evaluate_limbs(&mut self) {
        if !self.follows() {
            (0..self.linear.len()).for_each(|i| self.evaluate_limb(i));
            return;
        }
        for k in 0..self.tree.len() {
            let i = self.tree[k];
            self.evaluate_limb(i);
            let limb = &self.mechanism.limbs[i];
            let tip = self.linear[i].system.kinematics.tip_pose();
            self.state.platforms[limb.to] = tip * limb.platform_from_tip.inverse();
        }
    }

    /// Evaluates every limb and the balance of every platform at the present state.
    pub fn evaluate(&mut self) -> (MechanismBalance, Vec<Wrench>) {
        let m = self.mechanism;
        self.evaluate_limbs();
        let (mut merit, mut closure_m, mut torque, mut loads, mut forces) =
            (0.0, 0.0_f64, 0.0_f64, 0.0_f64, 0.0_f64);
        let mut exceeding = 0.0_f64;
        // Wrench still missing on each platform, about its origin.
        let mut lack: Vec<Wrench> = m
            .platforms
            .iter()
            .zip(&self.state.platforms)
            .map(|(p, pose)| {
                let weight = m.gravity * (p.mass * self.share);
                Wrench::new(weight, (pose.rotation * p.centre_of_mass).cross(&weight))
            })
            .collect();
        lack[m.tool] = lack[m.tool] + self.wrench * self.share;
        let mut others = self.others.clone();
        for load in &m.platform_loads {
            load.wrenches(&self.state.platforms, &mut others);
        }
        for (platform, wrench) in others {
            lack[platform] = lack[platform] + wrench * self.share;
        }
        let root = self.stiffness.sqrt();
        let unit = [
            root,
            root,
            root,
            root * self.length,
            root * self.length,
            root * self.length,
        ];
        let size = |w: &Wrench| {
            w.0.iter()
                .zip(&unit)
                .map(|(x, u)| (x / u).powi(2))
                .sum::<f64>()
                .sqrt()
        };
        forces = lack.iter().skip(1).map(size).fold(forces, f64::max);
        for (i, limb) in m.limbs.iter().enumerate() {
            let arm = self.arm(i, &self.state);
            let (x, f) = (&self.state.coordinates[i], &self.state.wrenches[i]);
            let linear = &mut self.linear[i];
            let target = self.state.platforms[limb.to] * limb.platform_from_tip;
            let tip = linear.system.kinematics.tip_pose();
            linear.closure =
                Twist(pose_residual(&target, &tip).0 - self.offsets[i].0 * (1.0 - self.share));
            let b = measure(
                &limb.actual,
                &linear.system,
                &linear.closure,
                f,
                &self.factors[i],
            );
            merit += b.closure.powi(2) + b.torque.powi(2);
            closure_m = closure_m.max(b.closure / limb.actual.scale().stiffness.sqrt());
            torque = torque.max(b.torque);
            loads = loads.max(b.loads);
            exceeding = exceeding.max(b.exceeding());
            lack[limb.to] = lack[limb.to] + Wrench(-(shift_matrix(&arm).transpose() * f.0));
            if limb.from != 0 {
                let n = x.len() + limb.actual.actuators().len();
                let reaction = Vector6::from_fn(|k, _| linear.system.torque[n + k]);
                lack[limb.from] = lack[limb.from] + Wrench(reaction);
            }
            forces = forces.max(size(f));
        }
        let mut force = 0.0_f64;
        if self.unknowns == Unknowns::Guided {
            let missing = self.guide.lack(&self.state.platforms[m.tool]);
            let missing = missing.amax();
            merit += (missing * root).powi(2);
            closure_m = closure_m.max(missing);
        }
        for (k, w) in lack.iter().enumerate().skip(1) {
            // Whoever holds the tool supplies what it lacks.
            if self.unknowns != Unknowns::Held || k != m.tool {
                force = force.max(size(w));
                merit += size(w).powi(2);
            }
        }
        let balance = MechanismBalance {
            merit,
            closure_m,
            torque,
            loads,
            force,
            forces,
            least: LEAST_LOAD * root * self.length,
            exceeding,
        };
        (balance, lack)
    }

    fn converged(&self, b: &MechanismBalance) -> bool {
        let unit = self.stiffness.sqrt() * self.length;
        b.torque.is_finite()
            && b.closure_m <= self.settings.closure * self.length
            && b.exceeding <= self.settings.torque * b.loads + 1e-16 * unit
            && b.force <= self.settings.torque * b.forces + 1e-16 * unit
    }

    /// Commands every limb for the present nominal target; false where it cannot be reached.
    pub fn retarget(&mut self) -> bool {
        let m = self.mechanism;
        if m.platforms.len() > 2 {
            let start = GraphPosture {
                platforms: self.nominal.clone(),
                limbs: self.posture.clone(),
            };
            let Ok(found) = graph_inverse(m, &self.target, Some(&start)) else {
                return false;
            };
            (self.nominal, self.posture) = (found.platforms, found.limbs);
            return true;
        }
        for (i, limb) in m.limbs.iter().enumerate() {
            let tip = self.target * limb.platform_from_tip;
            let base = m.platforms[limb.from].home;
            match inverse_kinematics(&limb.nominal, &base, &tip, Some(&self.posture[i])) {
                Ok(found) => self.posture[i] = found,
                Err(_) => return false,
            }
        }
        self.nominal[m.tool] = self.target;
        true
    }

    /// Rates of the commands at the present posture.
    pub fn refresh_rates(&mut self) {
        self.nominal[self.mechanism.tool] = self.target;
        self.rates = rates_of(self.mechanism, &self.nominal, &self.posture);
    }

    /// Newton at one share of the load.
    pub fn solve(
        &mut self,
        share: f64,
        mut picard: usize,
    ) -> std::result::Result<(usize, MechanismBalance), (usize, MechanismBalance)> {
        self.share = share;
        self.rate = None;
        let mut before: Option<f64> = None;
        let (mut now, mut lack) = self.evaluate();
        // A tangent that gains this much in one step (squared) serves for the next step too.
        const STILL_GOOD: f64 = 1e-5;
        let mut fresh = true;
        for iteration in 0..self.settings.iterations {
            if self.converged(&now) && iteration > 0 {
                return Ok((iteration, now));
            }
            let here = self.state.clone();
            let old = (!fresh)
                .then(|| self.newton(&lack, &here, Tangents::Old))
                .flatten();
            let reused = old.is_some();
            let new = Tangents::New {
                with_hessian: iteration >= picard,
            };
            let Some((step, steps)) = old.or_else(|| self.newton(&lack, &here, new)) else {
                return Err((iteration, now));
            };
            let mut length = self.longest(&step, &steps);
            let extent = self.extent(steps.iter());
            let correction: f64 = steps
                .iter()
                .zip(&self.factors)
                .flat_map(|(step, units)| step.iter().zip(units))
                .map(|(change, unit)| (change / unit).powi(2))
                .sum();
            let start = self.place();
            // Where platforms go where their limbs lead, large corrections are judged as those of
            // chains. Limbs that constrain each other are judged by the residual, and stay on their branch.
            let by_motion = self.follows();
            loop {
                let reached = self.go(&start, &step, &steps, length);
                let merit = now.merit;
                let (next, missing) = self.evaluate();
                let better = next.merit <= merit * (1.0 - 0.1 * length);
                let lagged = match by_motion {
                    true => iteration + 1 < picard,
                    false => iteration < picard,
                };
                let fine = self.converged(&next) || lagged;
                let less = better && (extent < SMALL || !by_motion);
                let mut accepted = reached && (fine || less);
                // Rounding: no further progress is possible and the conditions nearly hold.
                let close = next.closure_m <= 100.0 * self.settings.closure * self.length
                    && next.torque <= 10.0 * self.settings.torque * next.loads
                    && next.force <= 10.0 * self.settings.torque * next.forces;
                if reached && !accepted && !better && close {
                    return Ok((iteration, next));
                }
                let mut shorter = 0.5 * length;
                if reached && !accepted && by_motion {
                    let again = self.newton(&missing, &start.state, Tangents::Old);
                    let bent = again.map_or(f64::INFINITY, |(_, again)| {
                        let off = again.iter().zip(&steps);
                        let off: Vec<_> = off.map(|(a, s)| a - s * (1.0 - length)).collect();
                        self.extent(off.iter())
                    });
                    accepted = bent <= 0.5 * length * extent;
                    let wanted = 0.5 * length * length * extent / bent;
                    shorter = wanted.max(0.1 * length).min(shorter);
                }
                if accepted {
                    let moved = length * correction.sqrt();
                    self.rate = before.filter(|b| *b > 0.0).map(|b| moved / b);
                    before = Some(moved);
                    fresh = iteration < picard || next.merit > STILL_GOOD * merit;
                    (now, lack) = (next, missing);
                    break;
                }
                if reused && by_motion {
                    // The tangents do not serve any more.
                    self.put(start);
                    (now, lack) = self.evaluate();
                    fresh = true;
                    break;
                }
                length = shorter;
                if length < 1e-3 {
                    self.put(start);
                    if iteration >= picard || !by_motion {
                        return Err((iteration, now));
                    }
                    // Loads lagged lead nowhere from here: Newton at once.
                    picard = 0;
                    (now, lack) = self.evaluate();
                    break;
                }
            }
        }
        if self.converged(&now) {
            Ok((self.settings.iterations, now))
        } else {
            Err((self.settings.iterations, now))
        }
    }

    /// Longest share of a step over which the linearisation says something.
    fn longest(&self, step: &PlatformStep, steps: &[DVector<f64>]) -> f64 {
        let mut length = 1.0_f64;
        for (limb, step) in self.mechanism.limbs.iter().zip(steps) {
            length = length.min(step_limit(&limb.actual, step.iter().skip(6).copied()));
        }
        // Platforms that follow their limbs go as far as those.
        let free = if self.follows() {
            &[]
        } else {
            &step.motions[..]
        };
        for motion in free.iter().chain([&step.target]) {
            length = length
                .min(0.5 / motion.angular().norm().max(1e-300))
                .min(0.5 * self.length / motion.linear().norm().max(1e-300));
        }
        length
    }

    /// Size of the motion of all limbs in a correction: root of the sum of squares of turns (rad) and
    /// slides (in natural lengths).
    fn extent<'v>(&self, steps: impl Iterator<Item = &'v DVector<f64>>) -> f64 {
        let limbs = self.mechanism.limbs.iter().zip(steps);
        limbs
            .flat_map(|(limb, step)| {
                let length = limb.actual.scale().length;
                let own = limb.actual.coordinates().iter().zip(step.iter().skip(6));
                own.map(move |(c, dx)| match c.kind {
                    MotionKind::Revolute => dx * dx,
                    MotionKind::Prismatic => (dx / length).powi(2),
                })
            })
            .sum::<f64>()
            .sqrt()
    }

    fn place(&self) -> Place {
        Place {
            state: self.state.clone(),
            posture: self.posture.clone(),
            nominal: self.nominal.clone(),
            target: self.target,
            wrench: self.wrench,
        }
    }

    fn put(&mut self, place: Place) {
        self.state = place.state;
        self.posture = place.posture;
        self.nominal = place.nominal;
        self.target = place.target;
        self.wrench = place.wrench;
    }

    /// Goes a share of a step from a place; `false` where the commands cannot follow.
    fn go(
        &mut self,
        from: &Place,
        step: &PlatformStep,
        steps: &[DVector<f64>],
        length: f64,
    ) -> bool {
        self.wrench = from.wrench + step.push * length;
        for (k, motion) in step.motions.iter().enumerate() {
            self.state.platforms[k + 1] =
                moved(&from.state.platforms[k + 1], &Twist(motion.0 * length));
        }
        for (i, step) in steps.iter().enumerate() {
            let start = &from.state.coordinates[i];
            self.state.wrenches[i].0 =
                from.state.wrenches[i].0 + length * step.fixed_view::<6, 1>(0, 0);
            for (j, x) in self.state.coordinates[i].iter_mut().enumerate() {
                *x = start[j] + length * step[6 + j];
            }
            for block in self.mechanism.limbs[i].actual.springs() {
                block.follow(start, self.share, &mut self.state.coordinates[i]);
            }
        }
        if step.target.0 == Vector6::zeros() {
            return true;
        }
        self.posture.clone_from(&from.posture);
        self.nominal.clone_from(&from.nominal);
        self.target = moved(&from.target, &Twist(step.target.0 * length));
        self.retarget()
    }

    /// As given, and failing that with loads and closures that grow from the unloaded posture.
    pub fn solve_robustly(&mut self) -> Result<crate::chain::residual::Residual> {
        let start = self.state.clone();
        // A state that carries load already is better than the report's first step from rest.
        let loaded = self.state.wrenches.iter().any(|w| *w != Wrench::zero());
        let picard = if loaded {
            0
        } else {
            self.settings.picard_steps
        };
        match self.solve(1.0, picard) {
            Ok((iterations, balance)) => Ok(self.residual(&balance, iterations)),
            Err((_, balance)) => {
                self.state = start;
                self.grow_load(&balance, 1.0)
            }
        }
    }

    /// Loads and closures grow from the limbs at rest, in steps up to the `longest` share; `first` is what one step
    /// lacked.
    pub fn grow_load(
        &mut self,
        first: &MechanismBalance,
        longest: f64,
    ) -> Result<crate::chain::residual::Residual> {
        let aside = crate::equilibrium::chain::aside(longest);
        for (i, limb) in self.mechanism.limbs.iter().enumerate() {
            self.state.coordinates[i] =
                crate::chain::scaling::nudged(&limb.actual, &self.posture[i].coordinates, aside);
            self.state.wrenches[i] = Wrench::zero();
        }
        self.share = 1.0;
        self.offsets.fill(Twist::zero());
        self.leads = self.unknowns == Unknowns::Guided;
        self.evaluate();
        self.offsets = self.linear.iter().map(|l| l.closure).collect();
        let (mut share, mut step, mut iterations) = (0.0_f64, longest.min(0.125), 0);
        let mut last = *first;
        while share < 1.0 {
            let kept = self.state.clone();
            let next = (share + step).min(1.0);
            match self.solve(next, 0) {
                Ok((spent, balance)) => {
                    iterations += spent;
                    share = next;
                    last = balance;
                    step = (1.5 * step).min(longest);
                }
                Err((spent, _)) => {
                    iterations += spent;
                    self.state = kept;
                    step *= 0.5;
                    if step < self.settings.smallest_load_step.max(1e-9) {
                        self.leads = false;
                        return Err(self.not_converged(iterations, share, first));
                    }
                }
            }
        }
        self.offsets.fill(Twist::zero());
        self.leads = false;
        Ok(self.residual(&last, iterations))
    }

    fn residual(
        &self,
        balance: &MechanismBalance,
        iterations: usize,
    ) -> crate::chain::residual::Residual {
        crate::chain::residual::Residual {
            rate: self.rate,
            ..balance.residual(iterations)
        }
    }

    pub fn not_converged(
        &self,
        iterations: usize,
        share: f64,
        balance: &MechanismBalance,
    ) -> Error {
        let residual = balance.residual(iterations);
        Error::NotConverged {
            place: format!("mechanism '{}'", self.mechanism.name),
            iterations,
            residual_position_m: residual.closure_m,
            residual_torque: residual.torque,
            load_factor: share,
            last: self.state.coordinates.concat(),
            limit: None,
        }
    }

    /// Exact tangents at the present state: evaluates, linearises and returns `K` of the platforms,
    /// 6P x 6P, together with the limbs' own systems for stiffness and stability.
    pub fn finish(&mut self) -> (Sparse, Vec<Wrench>) {
        self.share = 1.0;
        let (_, lack) = self.evaluate();
        self.linearise(true);
        for (linear, (limb, factors)) in self
            .linear
            .iter_mut()
            .zip(self.mechanism.limbs.iter().zip(&self.factors))
        {
            // A limb that cannot move in all directions has no regular system: its end apart from them.
            let swept = linear.system.sweep.is_some();
            if limb.from == 0 && !swept && linear.rigid.ncols() > 0 {
                let jacobian = balanced_jacobian(&linear.system, factors);
                let (_, answer) = motions_of_end(&limb.actual, &linear.system, factors, &jacobian);
                linear.solution.columns_mut(1, 6).copy_from(&answer);
            }
        }
        (self.tangents(&self.state).0, lack)
    }

    /// The moment of the wrench on the tool without the reactions of what guides it.
    pub fn dead_moment(&self, wrench: &Wrench) -> Vector3<f64> {
        let held = self.guide.hands.rows(3, 3);
        let held = crate::linalg::singular_values::SingularValues::of(&held);
        let mut moment = wrench.moment();
        for (column, value) in held.left.column_iter().zip(&held.values) {
            if *value > 1e-9 {
                moment -= column * column.dot(&wrench.moment());
            }
        }
        moment
    }

    /// System of a limb after [`Self::finish`].
    pub fn limb_system(&self, limb: usize) -> &System {
        &self.linear[limb].system
    }

    /// Stiffness at its tip and stability of its shape of a limb after [`Self::finish`].
    pub fn verdicts(&mut self, limb: usize) -> (ChainStiffness, ShapeStability) {
        let chain = &self.mechanism.limbs[limb].actual;
        // Wrench and coordinates per unit motion of the tip, (6 + n) x 6.
        let units = self.linear[limb].solution.columns(1, 6).into_owned();
        let system = &self.linear[limb].system;
        let conservative = self.mechanism.loads_conservative(limb);
        let found = system.swept_verdicts(chain, &self.factors[limb], Some(&units));
        if let Some(found) = found.filter(|(_, s)| conservative || s.stable) {
            return found;
        }
        let swept = system.sweep.is_some();
        if swept {
            self.linear[limb].system.make_dense();
            self.evaluate_limb(limb);
        }
        let (system, factors) = (&self.linear[limb].system, &self.factors[limb]);
        let units = (!swept).then_some(units);
        let stiffness = chain_stiffness(chain, system, factors, units);
        let stability = shape_stability(chain, system, factors, conservative);
        (stiffness, stability)
    }
}

/// Motion of every limb's commands per motion of the nominal tool (base axes, at its origin), r x 6.
pub(crate) fn rates_of(
    mechanism: &Mechanism,
    platforms: &[Pose],
    limbs: &[LimbPosture],
) -> Vec<DMatrix<f64>> {
    if mechanism.platforms.len() > 2 {
        let at = GraphPosture {
            platforms: platforms.to_vec(),
            limbs: limbs.to_vec(),
        };
        return graph_rates(mechanism, &at);
    }
    // The tip of a limb moves like the tool that it is fixed to.
    let rates = mechanism.limbs.iter().zip(limbs).map(|(l, p)| {
        let arm = platforms[l.to].rotation * l.platform_from_tip.translation.vector;
        let rates = command_rates(&l.nominal, &platforms[l.from], p) * shift_matrix(&arm);
        DMatrix::from_fn(rates.nrows(), 6, |i, j| rates[(i, j)])
    });
    rates.collect()
}

/// Limbs from the base outwards; none where a platform has another number of limbs to it than one.
fn tree(mechanism: &Mechanism) -> Vec<usize> {
    let mut placed = vec![false; mechanism.platforms.len()];
    placed[0] = true;
    let mut order = Vec::new();
    while let Some(next) = mechanism
        .limbs
        .iter()
        .position(|l| placed[l.from] && !placed[l.to])
    {
        placed[mechanism.limbs[next].to] = true;
        order.push(next);
    }
    if order.len() != mechanism.limbs.len() || placed.contains(&false) {
        order.clear();
    }
    order
}

fn measure(
    chain: &Chain,
    system: &System,
    closure: &Twist,
    wrench: &Wrench,
    factors: &[f64],
) -> Balance {
    let (torque, mut loads) = system.unbalanced_torques(factors);
    let mut gap = 0.0;
    for k in 0..6 {
        gap += (closure.0[k] * factors[k]).powi(2);
        loads = loads.max((wrench.0[k] / factors[k]).abs());
    }
    Balance {
        closure: gap.sqrt(),
        torque: torque.sqrt(),
        loads,
        rounding: rounding(chain, system, factors),
    }
}
