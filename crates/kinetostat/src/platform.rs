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

use nalgebra::{DMatrix, DVector, Matrix6, Vector3, Vector6};

use crate::equilibrium::{Balance, LEAST_LOAD, System, balance, step_limit};
use crate::error::{Error, Result};
use crate::inverse::{LimbPosture, command_rates, inverse_kinematics};
use crate::loading::Load;
use crate::mechanism::Mechanism;
use crate::saddle::{Saddle, column_space, complement, rows_certainly_independent};
use crate::settings::Settings;
use crate::spatial::{Pose, Twist, Wrench, hat, moved, pose_residual, rotational, shift_matrix};
use crate::stiffness::balanced_jacobian;

/// Poses, coordinates and end wrenches of a mechanism: where an iteration starts and ends.
#[derive(Clone, Debug, PartialEq)]
pub struct MechanismState {
    /// Pose of every platform, the base included.
    pub platforms: Vec<Pose>,
    /// Coordinates of every limb, m or rad.
    pub coordinates: Vec<Vec<f64>>,
    /// Wrench on the tip of every limb, about it, base axes.
    pub wrenches: Vec<Wrench>,
}

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
}

/// A limb linearised about a state: balanced system solved for closure, motions of its end, of its
/// commands and of its base.
struct Linear {
    /// (6 + n) x (1 + 6 + r \[+ 6\]): wrench and coordinates.
    solution: DMatrix<f64>,
    /// Factors of the bordered system, kept while its tangent still serves.
    saddle: Option<Saddle>,
    /// Wrenches on the tip that the limb carries without any motion, 6 x k: the tip cannot move
    /// along them. Empty for a limb that can be strained in every direction.
    rigid: DMatrix<f64>,
    /// Rows of the reaction on a moving base before substitution: torque, d/dx, d/dF, d/dbase.
    system: System,
    closure: Twist,
}

impl Linear {
    /// Closure and unbalanced torques as first column.
    fn right_hand_side(&self, b: &mut DMatrix<f64>) {
        for k in 0..6 {
            b[(k, 0)] = self.closure.0[k];
        }
        for row in 0..self.system.spring_torque.len() {
            b[(6 + row, 0)] = -self.system.unbalanced(row);
        }
    }
}

/// See [`Linear::rigid`].
fn rigid_wrenches(system: &System, factors: &[f64]) -> DMatrix<f64> {
    let jacobian = balanced_jacobian(system, factors);
    if rows_certainly_independent(&jacobian) {
        return DMatrix::zeros(6, 0);
    }
    let mut blocked = complement(&column_space(&jacobian));
    for (mut row, factor) in blocked.row_iter_mut().zip(factors) {
        row *= *factor;
    }
    blocked
}

/// A mechanism's equilibrium being solved.
pub(crate) struct PlatformSolver<'m> {
    pub mechanism: &'m Mechanism,
    pub settings: Settings,
    /// Wrench on the tool, about its origin, base axes.
    pub wrench: Wrench,
    /// Joints of the commanded, unloaded posture.
    pub posture: Vec<LimbPosture>,
    pub unknowns: Unknowns,
    /// Pose of the tool for which the limbs are commanded, t0.
    pub target: Pose,
    /// Motion of the commands per motion of the nominal target, per limb, r x 6.
    pub rates: Vec<DMatrix<f64>>,
    pub state: MechanismState,
    factors: Vec<Vec<f64>>,
    loads: Vec<Load>,
    linear: Vec<Linear>,
    /// Closure at the start, kept while the load grows.
    offsets: Vec<Twist>,
    share: f64,
    length: f64,
    stiffness: f64,
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
}

impl MechanismBalance {
    /// Closure in metres and unbalanced share.
    pub fn residual(&self, iterations: usize) -> crate::equilibrium::Residual {
        crate::equilibrium::Residual {
            closure_m: self.closure_m,
            torque: (self.torque / self.loads.max(self.least))
                .max(self.force / self.forces.max(self.least)),
            iterations,
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
        let factors = limbs
            .iter()
            .zip(&posture)
            .map(|(l, p)| balance(&l.actual, &p.coordinates))
            .collect();
        let linear = limbs
            .iter()
            .zip(&posture)
            .map(|(l, p)| Linear {
                solution: DMatrix::zeros(0, 0),
                saddle: None,
                rigid: DMatrix::zeros(6, 0),
                system: System::new(
                    &l.actual,
                    &state.platforms[l.from],
                    &p.coordinates,
                    &p.commands,
                    l.from != 0,
                ),
                closure: Twist::zero(),
            })
            .collect();
        let loads = if mechanism.gravity == Vector3::zeros() {
            Vec::new()
        } else {
            vec![Load::Gravity(mechanism.gravity)]
        };
        let count = limbs.len() as f64;
        let length = limbs.iter().map(|l| l.actual.scale().length).sum::<f64>() / count;
        let stiffness = limbs
            .iter()
            .map(|l| l.actual.scale().stiffness)
            .sum::<f64>()
            / count;
        Self {
            mechanism,
            settings,
            wrench: Wrench::zero(),
            target: state.platforms[mechanism.tool],
            posture,
            unknowns,
            rates: Vec::new(),
            state,
            factors,
            loads,
            linear,
            offsets: vec![Twist::zero(); limbs.len()],
            share: 1.0,
            length,
            stiffness,
        }
    }

    /// Arm from the reference point of `to` to the limb's tip, base axes, m.
    fn arm(&self, limb: usize) -> Vector3<f64> {
        let l = &self.mechanism.limbs[limb];
        self.state.platforms[l.to].rotation * l.platform_from_tip.translation.vector
    }

    /// Evaluates every limb and the balance of every platform at the present state.
    fn evaluate(&mut self) -> (MechanismBalance, Vec<Wrench>) {
        let m = self.mechanism;
        let (mut merit, mut closure_m, mut torque, mut loads, mut forces) =
            (0.0, 0.0_f64, 0.0_f64, 0.0_f64, 0.0_f64);
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
            let arm = self.arm(i);
            let (x, f) = (&self.state.coordinates[i], &self.state.wrenches[i]);
            let base = &self.state.platforms[limb.from];
            let linear = &mut self.linear[i];
            linear.system.evaluate(
                &limb.actual,
                base,
                &self.posture[i].coordinates,
                &self.posture[i].commands,
                &self.loads,
                x,
                f,
                self.share,
            );
            let target = self.state.platforms[limb.to] * limb.platform_from_tip;
            let tip = linear.system.kinematics.tip_pose();
            linear.closure =
                Twist(pose_residual(&target, &tip).0 - self.offsets[i].0 * (1.0 - self.share));
            let b = measure(&linear.system, &linear.closure, f, &self.factors[i]);
            merit += b.closure.powi(2) + b.torque.powi(2);
            closure_m = closure_m.max(b.closure / limb.actual.scale().stiffness.sqrt());
            torque = torque.max(b.torque);
            loads = loads.max(b.loads);
            lack[limb.to] = lack[limb.to] + Wrench(-(shift_matrix(&arm).transpose() * f.0));
            if limb.from != 0 {
                let n = x.len() + limb.actual.actuators().len();
                let reaction = Vector6::from_fn(|k, _| linear.system.torque[n + k]);
                lack[limb.from] = lack[limb.from] + Wrench(reaction);
            }
            forces = forces.max(size(f));
        }
        let mut force = 0.0_f64;
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
        };
        (balance, lack)
    }

    fn converged(&self, b: &MechanismBalance) -> bool {
        let unit = self.stiffness.sqrt() * self.length;
        b.closure_m <= self.settings.closure * self.length
            && b.torque <= self.settings.torque * b.loads + 1e-16 * unit
            && b.force <= self.settings.torque * b.forces + 1e-16 * unit
    }

    /// Solves every limb's bordered system for closure, end, command and base motions.
    fn linearise(&mut self, with_hessian: bool) {
        for (linear, factors) in self.linear.iter_mut().zip(&self.factors) {
            let system = &linear.system;
            let n = system.spring_torque.len();
            let extra = system.kinematics.velocity_count() - n;
            let mut b = DMatrix::zeros(6 + n, 7 + extra);
            linear.right_hand_side(&mut b);
            for k in 0..6 {
                b[(k, 1 + k)] = 1.0;
                for j in 0..extra {
                    b[(k, 7 + j)] = -system.jacobian[(k, n + j)];
                }
            }
            if with_hessian {
                for row in 0..n {
                    for j in 0..extra {
                        b[(6 + row, 7 + j)] = -system.hessian[(row, n + j)];
                    }
                }
            }
            let saddle = Saddle::new(system.bordered(with_hessian), factors, factors);
            saddle.solve(&mut b);
            linear.rigid = rigid_wrenches(system, factors);
            linear.saddle = Some(saddle);
            linear.solution = b;
        }
    }

    /// New residuals with the tangent as it is.
    fn renew_residuals(&mut self) {
        for linear in &mut self.linear {
            let mut b = DMatrix::zeros(linear.solution.nrows(), 1);
            linear.right_hand_side(&mut b);
            if let Some(saddle) = &linear.saddle {
                saddle.solve(&mut b);
            }
            linear.solution.column_mut(0).copy_from(&b.column(0));
        }
    }

    /// `K_i`, 6 x 6, of a linearised limb at its tip.
    fn limb_stiffness(&self, limb: usize) -> Matrix6<f64> {
        self.linear[limb]
            .solution
            .fixed_view::<6, 6>(0, 1)
            .into_owned()
    }

    /// Tangent of the wrench on every moving platform by the motions of all moving platforms,
    /// 6P x 6P, and by the nominal target's motion, 6P x 6.
    fn tangents(&self) -> (DMatrix<f64>, DMatrix<f64>) {
        let m = self.mechanism;
        let p = m.platforms.len() - 1;
        let mut by_pose = DMatrix::zeros(6 * p, 6 * p);
        let mut by_target = DMatrix::zeros(6 * p, 6);
        let add = |matrix: &mut DMatrix<f64>, row: usize, column: usize, block: &Matrix6<f64>| {
            let mut view = matrix.view_mut((6 * (row - 1), column), (6, 6));
            view += block;
        };
        for (i, limb) in m.limbs.iter().enumerate() {
            let arm = self.arm(i);
            let t = shift_matrix(&arm);
            let k = self.limb_stiffness(i);
            let f = self.state.wrenches[i].force();
            let own = t.transpose() * k * t + rotational(&(hat(&f) * hat(&arm)));
            add(&mut by_pose, limb.to, 6 * (limb.to - 1), &own);
            let solution = &self.linear[i].solution;
            let r = limb.actual.actuators().len();
            if !self.rates.is_empty() {
                // Commands follow the nominal target, whose tip moves like the platform's.
                let sensitivity = solution.view((0, 7), (6, r)) * &self.rates[i] * t;
                let block = t.transpose() * sensitivity;
                add(
                    &mut by_target,
                    limb.to,
                    0,
                    &block.fixed_view::<6, 6>(0, 0).into_owned(),
                );
            }
            if limb.from != 0 {
                let base_columns = solution.view(
                    (0, 7 + r),
                    (6 + self.linear[i].system.spring_torque.len(), 6),
                );
                let by_base: Matrix6<f64> = base_columns.fixed_view::<6, 6>(0, 0).into_owned();
                let on_to = t.transpose() * by_base;
                add(&mut by_pose, limb.to, 6 * (limb.from - 1), &on_to);
                // Reaction on the base: rows of the extended Hessian and Jacobian.
                let system = &self.linear[i].system;
                let n = system.spring_torque.len();
                let rows = n + r;
                let by_x = system.hessian.view((rows, 0), (6, n));
                let by_f = system.jacobian.columns(rows, 6).transpose();
                let direct = system.hessian.view((rows, rows), (6, 6));
                let through = |columns: nalgebra::DMatrixView<'_, f64>| {
                    by_f.clone() * columns.rows(0, 6) + by_x * columns.rows(6, n)
                };
                let by_base = through(base_columns.as_view()) + direct;
                let by_end = through(solution.view((0, 1), (6 + n, 6)).as_view()) * t;
                add(
                    &mut by_pose,
                    limb.from,
                    6 * (limb.from - 1),
                    &-by_base.fixed_view::<6, 6>(0, 0),
                );
                add(
                    &mut by_pose,
                    limb.from,
                    6 * (limb.to - 1),
                    &-by_end.fixed_view::<6, 6>(0, 0),
                );
            }
        }
        // A weight keeps its direction while its lever arm turns.
        for (k, platform) in m.platforms.iter().enumerate().skip(1) {
            let weight = m.gravity * (platform.mass * self.share);
            let arm = self.state.platforms[k].rotation * platform.centre_of_mass;
            let block = -rotational(&(hat(&weight) * hat(&arm)));
            add(&mut by_pose, k, 6 * (k - 1), &block);
        }
        (by_pose, by_target)
    }

    /// Motions that no limb can follow: rows `N^T (motion of the tip)` over the platforms' motions,
    /// k x 6P, and what they must be, k.
    fn rigid_rows(&self) -> (DMatrix<f64>, DVector<f64>) {
        let m = self.mechanism;
        let p = m.platforms.len() - 1;
        let count = self.linear.iter().map(|l| l.rigid.ncols()).sum();
        let (mut rows, mut needed) = (DMatrix::zeros(count, 6 * p), DVector::zeros(count));
        let mut at = 0;
        for (i, limb) in m.limbs.iter().enumerate() {
            let linear = &self.linear[i];
            let k = linear.rigid.ncols();
            if k == 0 {
                continue;
            }
            let normal = linear.rigid.transpose();
            let t = shift_matrix(&self.arm(i));
            rows.view_mut((at, 6 * (limb.to - 1)), (k, 6))
                .copy_from(&(&normal * t));
            if limb.from != 0 {
                let first = linear.system.kinematics.velocity_count() - 6;
                let by_base = &normal * linear.system.jacobian.columns(first, 6);
                rows.view_mut((at, 6 * (limb.from - 1)), (k, 6))
                    .copy_from(&-by_base);
            }
            needed
                .rows_mut(at, k)
                .copy_from(&-(&normal * linear.closure.0));
            at += k;
        }
        (rows, needed)
    }

    /// One Newton step: motions of the platforms (6P), of the nominal target (6), and the wrenches
    /// that limbs carry rigidly.
    fn platform_step(&self, lack: &[Wrench]) -> Option<(Vec<Twist>, Twist, Vec<Wrench>)> {
        let m = self.mechanism;
        let p = m.platforms.len() - 1;
        if self.unknowns == Unknowns::Held && p == 1 {
            return Some((
                vec![Twist::zero()],
                Twist::zero(),
                vec![Wrench::zero(); m.limbs.len()],
            ));
        }
        let (mut a, by_target) = self.tangents();
        let mut b = DMatrix::zeros(6 * p, 1);
        for (k, w) in lack.iter().enumerate().skip(1) {
            b.view_mut((6 * (k - 1), 0), (6, 1)).copy_from(&w.0);
        }
        for (i, limb) in m.limbs.iter().enumerate() {
            let solution = &self.linear[i].solution;
            let t = shift_matrix(&self.arm(i));
            let change = t.transpose() * solution.fixed_view::<6, 1>(0, 0);
            let mut rows = b.view_mut((6 * (limb.to - 1), 0), (6, 1));
            rows -= change;
            if limb.from != 0 {
                let system = &self.linear[i].system;
                let n = system.spring_torque.len();
                let first = n + limb.actual.actuators().len();
                let reaction = system.jacobian.columns(first, 6).transpose()
                    * solution.view((0, 0), (6, 1))
                    + system.hessian.view((first, 0), (6, n)) * solution.view((6, 0), (n, 1));
                let mut rows = b.view_mut((6 * (limb.from - 1), 0), (6, 1));
                rows += reaction;
            }
        }
        let tool = 6 * (m.tool - 1);
        let held = match self.unknowns {
            Unknowns::Target(held) => held,
            _ => [false; 6],
        };
        for k in (0..6).filter(|&k| held[k]) {
            a.column_mut(tool + k).copy_from(&by_target.column(k));
        }
        if self.unknowns == Unknowns::Held {
            // The tool stays; the other platforms find their places.
            for k in 0..6 {
                let unit = if k < 3 {
                    1.0
                } else {
                    self.length * self.length
                };
                a.column_mut(tool + k).fill(0.0);
                a.row_mut(tool + k).fill(0.0);
                a[(tool + k, tool + k)] = self.stiffness * unit;
                b[(tool + k, 0)] = 0.0;
            }
        }
        let root = self.stiffness.sqrt();
        let mut scale: Vec<f64> = (0..6 * p)
            .map(|i| {
                if i % 6 < 3 {
                    1.0 / root
                } else {
                    1.0 / (root * self.length)
                }
            })
            .collect();
        let (mut rigid, needed) = self.rigid_rows();
        let count = rigid.nrows();
        if count > 0 {
            // What is held does not move; its rows ask nothing of it.
            let still = |k: usize| held[k] || self.unknowns == Unknowns::Held;
            for k in (0..6).filter(|&k| still(k)) {
                rigid.column_mut(tool + k).fill(0.0);
            }
            a = a.resize(6 * p + count, 6 * p + count, 0.0);
            a.view_mut((6 * p, 0), (count, 6 * p)).copy_from(&rigid);
            a.view_mut((0, 6 * p), (6 * p, count))
                .copy_from(&rigid.transpose());
            b = b.resize(6 * p + count, 1, 0.0);
            b.view_mut((6 * p, 0), (count, 1)).copy_from(&needed);
            scale.resize(6 * p + count, 1.0);
        }
        Saddle::new(a, &scale, &scale).solve(&mut b);
        if b.iter().any(|x| !x.is_finite()) {
            return None;
        }
        let mut motions: Vec<Twist> = (0..p)
            .map(|k| Twist(b.fixed_view::<6, 1>(6 * k, 0).into_owned()))
            .collect();
        let mut target = Twist::zero();
        for k in (0..6).filter(|&k| held[k]) {
            target.0[k] = motions[m.tool - 1].0[k];
            motions[m.tool - 1].0[k] = 0.0;
        }
        let mut at = 6 * p;
        let carried = self
            .linear
            .iter()
            .map(|linear| {
                let k = linear.rigid.ncols();
                let wrench = &linear.rigid * b.view((at, 0), (k, 1));
                at += k;
                Wrench(wrench.fixed_view::<6, 1>(0, 0).into_owned())
            })
            .collect();
        Some((motions, target, carried))
    }

    /// Changes of wrench and coordinates of every limb that follow from a platform step.
    fn limb_steps(
        &self,
        motions: &[Twist],
        target: &Twist,
        carried: &[Wrench],
    ) -> Vec<DVector<f64>> {
        let m = self.mechanism;
        let motion = |platform: usize| {
            if platform == 0 {
                Twist::zero()
            } else {
                motions[platform - 1]
            }
        };
        m.limbs
            .iter()
            .enumerate()
            .map(|(i, limb)| {
                let solution = &self.linear[i].solution;
                let rows = solution.nrows();
                let t = shift_matrix(&self.arm(i));
                let end = t * motion(limb.to).0;
                let mut step = solution.column(0) + solution.view((0, 1), (rows, 6)) * end;
                let mut wrench = step.rows_mut(0, 6);
                wrench += carried[i].0;
                let r = limb.actual.actuators().len();
                if !self.rates.is_empty() && r > 0 {
                    let commands = &self.rates[i] * t * target.0;
                    step += solution.view((0, 7), (rows, r)) * commands;
                }
                if limb.from != 0 {
                    step += solution.view((0, 7 + r), (rows, 6)) * motion(limb.from).0;
                }
                step
            })
            .collect()
    }

    /// Commands every limb for the present nominal target; false where it cannot be reached.
    pub fn retarget(&mut self) -> bool {
        for (i, limb) in self.mechanism.limbs.iter().enumerate() {
            let tip = self.target * limb.platform_from_tip;
            let base = self.mechanism.platforms[limb.from].home;
            match inverse_kinematics(&limb.nominal, &base, &tip, Some(&self.posture[i])) {
                Ok(found) => self.posture[i] = found,
                Err(_) => return false,
            }
        }
        true
    }

    /// Rates of the commands at the present posture.
    pub fn refresh_rates(&mut self) {
        self.rates = self
            .mechanism
            .limbs
            .iter()
            .zip(&self.posture)
            .map(|(l, p)| command_rates(&l.nominal, &self.mechanism.platforms[l.from].home, p))
            .collect();
    }

    /// Newton at one share of the load.
    pub fn solve(
        &mut self,
        share: f64,
        picard: usize,
    ) -> std::result::Result<(usize, MechanismBalance), (usize, MechanismBalance)> {
        self.share = share;
        let (mut now, mut lack) = self.evaluate();
        // A tangent that gains this much in one step (squared) serves for the next step too.
        const STILL_GOOD: f64 = 1e-5;
        let mut fresh = true;
        for iteration in 0..self.settings.iterations {
            if self.converged(&now) && iteration > 0 {
                return Ok((iteration, now));
            }
            if fresh {
                self.linearise(iteration >= picard);
                if matches!(self.unknowns, Unknowns::Target(_)) {
                    self.refresh_rates();
                }
            } else {
                self.renew_residuals();
            }
            let Some((motions, target, carried)) = self.platform_step(&lack) else {
                return Err((iteration, now));
            };
            let steps = self.limb_steps(&motions, &target, &carried);
            let mut length = 1.0_f64;
            for (limb, step) in self.mechanism.limbs.iter().zip(&steps) {
                length = length.min(step_limit(&limb.actual, step.iter().skip(6).copied()));
            }
            for motion in motions.iter().chain([&target]) {
                length = length
                    .min(0.5 / motion.angular().norm().max(1e-300))
                    .min(0.5 * self.length / motion.linear().norm().max(1e-300));
            }
            let start = (self.state.clone(), self.posture.clone(), self.target);
            let retargets = target.0 != Vector6::zeros();
            loop {
                for (k, motion) in motions.iter().enumerate() {
                    self.state.platforms[k + 1] =
                        moved(&start.0.platforms[k + 1], &Twist(motion.0 * length));
                }
                for (i, step) in steps.iter().enumerate() {
                    self.state.wrenches[i].0 =
                        start.0.wrenches[i].0 + length * step.fixed_view::<6, 1>(0, 0);
                    for (j, x) in self.state.coordinates[i].iter_mut().enumerate() {
                        *x = start.0.coordinates[i][j] + length * step[6 + j];
                    }
                }
                let reached = !retargets || {
                    self.target = moved(&start.2, &Twist(target.0 * length));
                    self.retarget()
                };
                let merit = now.merit;
                let (next, missing) = self.evaluate();
                let better = reached && next.merit <= merit * (1.0 - 0.1 * length);
                if better || (reached && (iteration < picard || self.converged(&next))) {
                    fresh = iteration < picard || next.merit > STILL_GOOD * merit;
                    (now, lack) = (next, missing);
                    break;
                }
                // Rounding: no further progress is possible and the conditions nearly hold.
                let close = next.closure_m <= 100.0 * self.settings.closure * self.length
                    && next.torque <= 10.0 * self.settings.torque * next.loads
                    && next.force <= 10.0 * self.settings.torque * next.forces;
                if reached && close {
                    return Ok((iteration, next));
                }
                length *= 0.5;
                if length < 1e-3 {
                    (self.state, self.posture, self.target) = start;
                    return Err((iteration, now));
                }
                if retargets {
                    self.posture.clone_from(&start.1);
                }
            }
        }
        if self.converged(&now) {
            Ok((self.settings.iterations, now))
        } else {
            Err((self.settings.iterations, now))
        }
    }

    /// As given, and failing that with loads and closures that grow from the unloaded posture.
    pub fn solve_robustly(&mut self) -> Result<crate::equilibrium::Residual> {
        let start = self.state.clone();
        // A state that carries load already is better than the report's first step from rest.
        let loaded = self.state.wrenches.iter().any(|w| *w != Wrench::zero());
        let picard = if loaded {
            0
        } else {
            self.settings.picard_steps
        };
        let first = match self.solve(1.0, picard) {
            Ok((iterations, balance)) => return Ok(balance.residual(iterations)),
            Err(failed) => failed,
        };
        self.state = start;
        for (i, limb) in self.mechanism.limbs.iter().enumerate() {
            self.state.coordinates[i] =
                crate::equilibrium::nudged(&limb.actual, &self.posture[i].coordinates, 1e-3);
            self.state.wrenches[i] = Wrench::zero();
        }
        self.share = 1.0;
        self.offsets.fill(Twist::zero());
        self.evaluate();
        self.offsets = self.linear.iter().map(|l| l.closure).collect();
        let (mut share, mut step, mut iterations) = (0.0_f64, 0.125_f64, 0);
        let mut last = first.1;
        while share < 1.0 {
            let kept = self.state.clone();
            let next = (share + step).min(1.0);
            match self.solve(next, 0) {
                Ok((spent, balance)) => {
                    iterations += spent;
                    share = next;
                    last = balance;
                    step *= 1.5;
                }
                Err((spent, _)) => {
                    iterations += spent;
                    self.state = kept;
                    step *= 0.5;
                    if step < self.settings.smallest_load_step {
                        return Err(self.not_converged(iterations, share, &first.1));
                    }
                }
            }
        }
        self.offsets.fill(Twist::zero());
        Ok(last.residual(iterations))
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
        }
    }

    /// Exact tangents at the present state: evaluates, linearises and returns `K` of the platforms,
    /// 6P x 6P, together with the limbs' own systems for stiffness and stability.
    pub fn finish(&mut self) -> (DMatrix<f64>, Vec<Wrench>) {
        self.share = 1.0;
        let (_, lack) = self.evaluate();
        self.linearise(true);
        (self.tangents().0, lack)
    }

    /// System and balance factors of a limb after [`Self::finish`].
    pub fn limb_system(&self, limb: usize) -> (&System, &[f64]) {
        (&self.linear[limb].system, &self.factors[limb])
    }

    /// Wrench and coordinates of a limb per unit motion of its tip, (6 + n) x 6, after
    /// [`Self::finish`].
    pub fn unit_motions(&self, limb: usize) -> DMatrix<f64> {
        self.linear[limb].solution.columns(1, 6).into_owned()
    }

    /// Natural length and stiffness of the mechanism.
    pub fn scale(&self) -> crate::chain::Scale {
        crate::chain::Scale {
            length: self.length,
            stiffness: self.stiffness,
        }
    }
}

fn measure(system: &System, closure: &Twist, wrench: &Wrench, factors: &[f64]) -> Balance {
    let (mut gap, mut torque, mut loads) = (0.0, 0.0, 0.0_f64);
    for k in 0..6 {
        gap += (closure.0[k] * factors[k]).powi(2);
        loads = loads.max((wrench.0[k] / factors[k]).abs());
    }
    for i in 0..system.spring_torque.len() {
        let s = factors[6 + i];
        torque += (system.unbalanced(i) * s).powi(2);
        loads = loads
            .max((system.torque[i] * s).abs())
            .max((system.spring_torque[i] * s).abs());
    }
    Balance {
        closure: gap.sqrt(),
        torque: torque.sqrt(),
        loads,
    }
}
