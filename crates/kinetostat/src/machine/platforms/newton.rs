//! Newton's iteration for the platforms of a mechanism under step control, directly or with loads that grow.

use nalgebra::{DVector, Matrix6, Vector6};

use crate::chain::residual::FoundBy;
use crate::chain::scaling::{aside, step_limit};
use crate::chain::system::Hessian;
use crate::error::{Error, Result};
use crate::machine::inverse::limb::LimbPosture;
use crate::machine::platforms::parts::{PlatformStep, Tangents, Unknowns};
use crate::machine::platforms::solver::{MechanismResiduals, PlatformSolver};
use crate::machine::state::MechanismState;
use crate::model::loads::load::lagged_steps;
use crate::spatial::{MotionKind, Pose, Twist, Wrench, hat, moved, rotational};

/// A step that was gone by some share of its length.
struct Trial {
    length: f64,
    /// Sum of the squared residuals before it.
    merit: f64,
    /// The loads' Hessian is left out: the step is taken as it is.
    lagged: bool,
}

/// Rating of a trial.
enum Rating {
    Accepted,
    /// No step makes it better, and it is as good as rounding lets it be.
    Rounding,
    /// The length to try next.
    Shorter(f64),
}

impl PlatformSolver<'_> {
    /// Newton at one share of the load; the first `picard` steps leave the loads' Hessian out.
    /// Returns iterations and the last residual, `Err` if it did not converge.
    pub fn solve(
        &mut self,
        share: f64,
        mut picard: usize,
    ) -> std::result::Result<(usize, MechanismResiduals), (usize, MechanismResiduals)> {
        self.share = share;
        self.rate = None;
        let mut before: Option<f64> = None;
        let (mut now, mut unbalanced) = self.evaluate();
        // A tangent that gains this much in one step (squared) serves for the next step too.
        const STILL_GOOD: f64 = 1e-5;
        let mut fresh = true;
        for iteration in 0..self.settings.iterations {
            if self.converged(&now) && iteration > 0 {
                return Ok((iteration, now));
            }
            let here = self.state.clone();
            let old = (!fresh)
                .then(|| self.newton(&unbalanced, &here, Tangents::Old))
                .flatten();
            let reused = old.is_some();
            let new = Tangents::New {
                hessian: Hessian::at(iteration, picard),
            };
            let Some((step, steps)) = old.or_else(|| self.newton(&unbalanced, &here, new)) else {
                return Err((iteration, now));
            };
            let mut length = self.longest(&step, &steps);
            let correction = self.correction(&steps);
            let start = self.place();
            let merit = now.merit;
            loop {
                let reached = self.go(&start, &step, &steps, length);
                let (next, missing) = self.evaluate();
                let trial = Trial {
                    length,
                    merit,
                    // The last of the report's own steps leads over to Newton where motion decides.
                    lagged: iteration + usize::from(self.follows()) < picard,
                };
                let next_length = match reached {
                    true => match self.rated(&trial, &start, &steps, &next, &missing) {
                        Rating::Accepted => None,
                        Rating::Rounding => return Ok((iteration, next)),
                        Rating::Shorter(length) => Some(length),
                    },
                    false => Some(0.5 * length),
                };
                let Some(shorter) = next_length else {
                    let moved = length * correction;
                    self.rate = before.filter(|b| *b > 0.0).map(|b| moved / b);
                    before = Some(moved);
                    fresh = iteration < picard || next.merit > STILL_GOOD * merit;
                    (now, unbalanced) = (next, missing);
                    break;
                };
                if reused && self.follows() {
                    // The tangents do not serve any more.
                    self.put(start);
                    (now, unbalanced) = self.evaluate();
                    fresh = true;
                    break;
                }
                length = shorter;
                if length < 1e-3 {
                    self.put(start);
                    if iteration >= picard || !self.follows() {
                        return Err((iteration, now));
                    }
                    // Loads lagged lead nowhere from here: Newton at once.
                    picard = 0;
                    (now, unbalanced) = self.evaluate();
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

    /// Rates a step of some length. If platforms follow their limbs, large corrections are rated as those of chains, by
    /// motion. Limbs that constrain each other are rated by the residual, and stay on their branch.
    fn rated(
        &mut self,
        trial: &Trial,
        start: &Iterate,
        steps: &[DVector<f64>],
        next: &MechanismResiduals,
        missing: &[Wrench],
    ) -> Rating {
        let length = trial.length;
        let by_motion = self.follows();
        let extent = self.extent(steps.iter());
        let better = next.merit <= trial.merit * (1.0 - 0.1 * length);
        if self.converged(next) || trial.lagged || better && (extent < SMALL || !by_motion) {
            return Rating::Accepted;
        }
        // Rounding: no further progress is possible and the conditions nearly hold.
        let close = next.closure_m <= 100.0 * self.settings.closure * self.length
            && next.torque <= 10.0 * self.settings.torque * next.loads
            && next.force <= 10.0 * self.settings.torque * next.forces;
        if !better && close {
            return Rating::Rounding;
        }
        let half = 0.5 * length;
        if !by_motion {
            return Rating::Shorter(half);
        }
        let again = self.newton(missing, &start.state, Tangents::Old);
        let bent = again.map_or(f64::INFINITY, |(_, again)| {
            let off = again.iter().zip(steps);
            let off: Vec<_> = off.map(|(a, s)| a - s * (1.0 - length)).collect();
            self.extent(off.iter())
        });
        if bent <= 0.5 * length * extent {
            return Rating::Accepted;
        }
        let wanted = 0.5 * length * length * extent / bent;
        Rating::Shorter(wanted.max(0.1 * length).min(half))
    }

    /// Size of a correction of all limbs' wrenches and coordinates, scaled.
    fn correction(&self, steps: &[DVector<f64>]) -> f64 {
        let own = steps.iter().zip(&self.scales);
        let squares = own
            .flat_map(|(step, units)| step.iter().zip(units))
            .map(|(change, unit)| (change / unit).powi(2));
        squares.sum::<f64>().sqrt()
    }

    /// Longest share of a step over which the linearisation says something.
    fn longest(&self, step: &PlatformStep, steps: &[DVector<f64>]) -> f64 {
        let mut length = 1.0_f64;
        for (limb, step) in self.mechanism.limbs().iter().zip(steps) {
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
        let limbs = self.mechanism.limbs().iter().zip(steps);
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

    pub(crate) fn place(&self) -> Iterate {
        Iterate {
            state: self.state.clone(),
            posture: self.posture.clone(),
            nominal: self.nominal.clone(),
            target: self.target,
            wrench: self.wrench,
        }
    }

    pub(crate) fn put(&mut self, place: Iterate) {
        self.state = place.state;
        self.posture = place.posture;
        self.nominal = place.nominal;
        self.target = place.target;
        self.wrench = place.wrench;
    }

    /// Goes a share of a step from a place; `false` where the commands cannot follow.
    pub(crate) fn go(
        &mut self,
        from: &Iterate,
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
            for block in self.mechanism.limbs()[i].actual.springs() {
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

    /// Solves as given, and failing that with loads and closures that grow from the unloaded posture.
    pub fn solve_robustly(&mut self) -> Result<crate::chain::residual::Residual> {
        let start = self.state.clone();
        // A state that carries load already is better than the report's first step from rest.
        let loaded = self.state.wrenches.iter().any(|w| *w != Wrench::zero());
        let picard = match loaded || !self.mechanism.platform_loads().is_empty() {
            true => 0,
            false => lagged_steps(self.loads.iter().flatten(), self.settings.picard_steps),
        };
        match self.solve(1.0, picard) {
            Ok((iterations, norms)) => Ok(self.residual(&norms, iterations)),
            Err((_, norms)) => {
                self.state = start;
                self.grow_load(&norms, 1.0)
            }
        }
    }

    /// Loads and closures grow from the limbs at rest, in steps up to the `longest` share; `first` is the
    /// residual after
    /// one step.
    pub fn grow_load(
        &mut self,
        first: &MechanismResiduals,
        longest: f64,
    ) -> Result<crate::chain::residual::Residual> {
        let aside = aside(longest);
        for (i, limb) in self.mechanism.limbs().iter().enumerate() {
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
                Ok((spent, norms)) => {
                    iterations += spent;
                    share = next;
                    last = norms;
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
        self.found_by = FoundBy::GrowingLoad;
        self.offsets.fill(Twist::zero());
        self.leads = false;
        Ok(self.residual(&last, iterations))
    }

    fn residual(
        &self,
        norms: &MechanismResiduals,
        iterations: usize,
    ) -> crate::chain::residual::Residual {
        crate::chain::residual::Residual {
            rate: self.rate,
            ..norms.residual(iterations)
        }
    }

    pub fn not_converged(
        &self,
        iterations: usize,
        share: f64,
        norms: &MechanismResiduals,
    ) -> Error {
        let residual = norms.residual(iterations);
        Error::NotConverged {
            place: self.mechanism.place(),
            iterations,
            residual_position_m: residual.closure_m,
            residual_torque: residual.torque,
            load_factor: share,
            last: self.state.coordinates.concat(),
            limit: None,
        }
    }
}

/// State of an iteration.
pub(crate) struct Iterate {
    pub(crate) state: MechanismState,
    posture: Vec<LimbPosture>,
    nominal: Vec<Pose>,
    target: Pose,
    wrench: Wrench,
}

/// Corrections of less motion than this (rad, natural lengths) are assessed by the residual after them,
/// larger ones by the motion that the same tangents still want.
const SMALL: f64 = 1e-2;

impl PlatformSolver<'_> {
    /// Contribution of a limb's force to the stiffness of the platform at its tip as the arm turns.
    pub fn turned_force(&self, limb: usize, at: &MechanismState) -> Matrix6<f64> {
        let f = at.wrenches[limb].force();
        rotational(&(hat(&f) * hat(&self.arm(limb, at))))
    }

    /// Adds the tangents of what acts on the platforms themselves, `-dW / d(motion)`.
    pub fn add_platform_loads(
        &self,
        at: &MechanismState,
        mut add: impl FnMut(usize, usize, &Matrix6<f64>),
    ) {
        let m = self.mechanism;
        // A weight keeps its direction while its lever arm turns.
        for (k, platform) in m.platforms().iter().enumerate().skip(1) {
            let weight = m.gravity() * (platform.mass * self.share);
            let arm = at.platforms[k].rotation * platform.centre_of_mass;
            let block = -rotational(&(hat(&weight) * hat(&arm)));
            add(k, k, &block);
        }
        let mut own = Vec::new();
        for load in m.platform_loads() {
            load.tangents(&at.platforms, &mut own);
        }
        for tangent in own {
            let block = tangent.matrix * -self.share;
            // The base does not move, nor does it matter what acts on it.
            if tangent.on > 0 && tangent.by > 0 {
                add(tangent.on, tangent.by, &block);
            }
        }
    }
}
