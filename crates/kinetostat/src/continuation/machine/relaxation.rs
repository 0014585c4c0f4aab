//! Equilibrium nearest to the commanded posture, on the way on which an under-constrained machine comes to rest.
//!
//! ```text
//! (K + lambda U) dt = W,   U the unit stiffness of a platform;   the potential falls in each step     (Levenberg, Marquardt)
//! ```
//!
//! Where limbs do not hold a platform in all directions, a Newton step along those is of any size. The damping bounds it, and
//! exceeds every negative stiffness, or the step would lead to a saddle. Steps
//! are rated by the potential: the unbalanced wrench grows across the narrow and curved valley in which the platform goes, the
//! potential does not.

use crate::chain::residual::{FoundBy, Residual};
use crate::chain::system::Hessian;
use crate::machine::equilibrium::potential;
use crate::machine::platforms::newton::Iterate;
use crate::machine::platforms::parts::{PlatformStep, Tangents, Unknowns};
use crate::machine::platforms::solver::{MechanismResiduals, PlatformSolver};
use crate::number::larger;
use crate::spatial::{Twist, Wrench, pose_residual};

/// Steps and trials, at most.
const TRIALS: usize = 500;

/// Trials after which a minimum that is flat to fourth order is near enough: there, each step takes a third of the way.
const FLAT: usize = 100;

/// Platforms of the largest machine: the effort of a step grows with their cube.
const MOST_PLATFORMS: usize = 20;

/// Trials in vain after which rounding is all that is left.
const IN_VAIN: usize = 25;

/// Newton steps by which the limbs follow their ends, at most.
const FOLLOWING: usize = 12;

/// Damping of the first step, by the machine's stiffness.
const FIRST: f64 = 1e-3;

/// Longest step of a platform, rad and natural lengths.
const STEP: f64 = 0.02;

/// Platforms that go farther (rad, natural lengths) lead to another equilibrium than the nearest.
const FARTHEST: f64 = 0.1;

/// Unbalanced wrench that is as good as none, by stiffness and length of the machine.
const NO_WRENCH: f64 = 1e-13;

impl PlatformSolver<'_> {
    /// Comes to rest near the present state under the whole load; `None` if there is no equilibrium nearby, if the loads
    /// have no potential, if there are too many platforms, or if every platform hangs on one limb, which holds nothing against others.
    pub(crate) fn relax(&mut self) -> Option<Residual> {
        let many = self.mechanism.platforms().len() > MOST_PLATFORMS;
        if many || self.follows() || self.is_one_chain() || self.unknowns != Unknowns::Pose {
            return None;
        }
        let home = self.state.platforms.clone();
        self.share = 1.0;
        let mut now = self.closed()?;
        let mut energy = potential(self)?;
        let (mut damping, mut in_vain) = (FIRST, 0);
        for trial in 0..TRIALS {
            let (residuals, unbalanced) = &now;
            let at_rest = in_vain.max(trial / FLAT) > 0 && self.is_at_rest(residuals);
            if trial > 0 && (self.converged(residuals) || at_rest) {
                self.found_by = FoundBy::Relaxation;
                return Some(residuals.residual(trial));
            }
            if in_vain > IN_VAIN {
                return None;
            }
            let start = self.place();
            self.damping = damping;
            let hessian = Hessian::Kept;
            let step = self.newton(unbalanced, &start.state, Tangents::New { hessian });
            self.damping = 0.0;
            match step.and_then(|(step, _)| self.tried(&start, &step, &now.0, energy)) {
                Some((next, lower)) => {
                    let platforms = home.iter().zip(&self.state.platforms);
                    let gone = platforms.map(|(from, to)| self.size(&pose_residual(to, from)));
                    if gone.fold(0.0, larger) > FARTHEST {
                        return None;
                    }
                    (now, energy) = (next, lower);
                    (damping, in_vain) = (0.1 * damping, 0);
                }
                None => {
                    self.put(start);
                    now = self.evaluate();
                    (damping, in_vain) = (10.0 * damping.max(1e-18), in_vain + 1);
                }
            }
        }
        None
    }

    /// The residuals and the potential after a step of the platforms, the limbs closed; `None` if that gains nothing.
    fn tried(
        &mut self,
        start: &Iterate,
        step: &PlatformStep,
        before: &MechanismResiduals,
        energy: f64,
    ) -> Option<((MechanismResiduals, Vec<Wrench>), f64)> {
        let size = step.motions.iter().map(|motion| self.size(motion));
        let largest = size.fold(0.0, larger);
        let length = (STEP / largest).min(1.0);
        let steps = self.limb_steps(step, &start.state);
        if !self.go(start, step, &steps, length) {
            return None;
        }
        let next = self.closed()?;
        let lower = potential(self)?;
        // Next to a large potential the last steps are below rounding.
        let rounding = 1e-15 * energy.abs();
        let better =
            lower < energy - rounding || lower <= energy + rounding && next.0.merit < before.merit;
        better.then_some((next, lower))
    }

    /// The limbs follow their ends, the platforms held.
    fn closed(&mut self) -> Option<(MechanismResiduals, Vec<Wrench>)> {
        let none = PlatformStep {
            motions: vec![Twist::zero(); self.mechanism.platforms().len() - 1],
            target: Twist::zero(),
            carried: vec![Wrench::zero(); self.mechanism.limbs().len()],
            push: Wrench::zero(),
        };
        let (mut now, mut unbalanced) = self.evaluate();
        for _ in 0..FOLLOWING {
            let before = now.closure_m;
            let start = self.place();
            self.linearise(Hessian::Kept);
            if self.linear.iter().any(|limb| limb.rigid.ncols() > 0) {
                return None;
            }
            let steps = self.limb_steps(&none, &start.state);
            self.go(&start, &none, &steps, 1.0);
            (now, unbalanced) = self.evaluate();
            if now.closure_m <= 1e-2 * self.settings.closure * self.length
                || now.closure_m >= 0.5 * before && self.is_closed(&now)
            {
                break;
            }
        }
        self.is_closed(&now).then_some((now, unbalanced))
    }

    fn is_closed(&self, b: &MechanismResiduals) -> bool {
        let none = NO_WRENCH * self.stiffness.sqrt() * self.length;
        b.closure_m <= 100.0 * self.settings.closure * self.length
            && b.exceeding <= 10.0 * self.settings.torque * b.loads + none
    }

    /// Next to nothing is unbalanced.
    fn is_at_rest(&self, b: &MechanismResiduals) -> bool {
        let none = NO_WRENCH * self.stiffness.sqrt() * self.length;
        self.is_closed(b) && b.force <= 10.0 * self.settings.torque * b.forces + none
    }

    /// Size of a platform's motion, rad and natural lengths.
    fn size(&self, motion: &Twist) -> f64 {
        (motion.angular().norm()).max(motion.linear().norm() / self.length)
    }
}
