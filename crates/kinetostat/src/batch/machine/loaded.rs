//! A machine under load with the buffers of its limbs: from commands to equilibrium, several postures at once.

use std::sync::Arc;

use pulp::Simd;

use crate::batch::limb::loaded::{EXACT, LoadedLimb, Precision};
use crate::batch::limb::newton::Newton;
use crate::batch::limb::outwards::actuator_forces;
use crate::batch::limb::reach::{Joints, Target};
use crate::batch::limb::shape::Shape;
use crate::batch::limb::unloaded::ForwardPass;
use crate::batch::machine::corrector::AttachedLimb;
use crate::batch::numbers::lanes::Lanes;
use crate::batch::numbers::symmetric::Symmetric;
use crate::batch::numbers::vectors::{Mat3, Vec3, identity};
use crate::batch::plan::steps::Plan;

/// Commands (m, rad) are smaller than this where sines are exact for them.
pub(crate) const MOST_COMMAND: f64 = 1e5;

/// One where all commands are angles and lengths that sines are exact for.
#[inline(always)]
pub(crate) fn bounded<S: Simd>(simd: S, commands: &[Lanes<S>]) -> Lanes<S> {
    let (zero, one) = (Lanes::new(simd, 0.0), Lanes::new(simd, 1.0));
    let mut good = one;
    for x in commands {
        good = x.abs().where_less(one * MOST_COMMAND, good, zero);
    }
    good
}

/// Mass of the platform that carries the tool.
#[derive(Clone, Copy)]
pub(crate) struct PlatformMass {
    /// Centre of mass, m, axes of the tool.
    pub centre: [f64; 3],
    /// Mass, kg.
    pub mass: f64,
}

/// A machine with the buffers of its limbs.
pub(crate) struct Machine<S: Simd> {
    pub nominal: Arc<[Plan]>,
    pub actual: Arc<[Plan]>,
    pub passes: Vec<(ForwardPass<S>, ForwardPass<S>)>,
    pub joints: Vec<Joints<S>>,
    pub limbs: Vec<LoadedLimb<S>>,
    /// Buffers of Newton's iteration, made when needed.
    pub newton: Option<Newton<S>>,
    /// Each limb as the platform sees it.
    pub attached: Vec<AttachedLimb<S>>,
    /// Inverse of the unloaded stiffness of the platform.
    pub compliance: Symmetric<S>,
    pub body: PlatformMass,
    pub gravity: [f64; 3],
    /// Target of the unloaded machine for which `attached` and `compliance` were computed, and the smallest relative
    /// pivot there.
    pub compliance_at: Target<S>,
    pub regular: Lanes<S>,
    /// Precision of equilibria.
    pub precision: Precision,
    /// The wanted place, and where the tool is commanded.
    pub place: Target<S>,
    pub target: Target<S>,
    /// One in the lanes whose last posture was found.
    pub found: Lanes<S>,
    /// The wrench on the tool of the posture at hand.
    pub load: [Lanes<S>; 6],
    /// Change up to the last posture of a path.
    pub trend: Trend<S>,
    /// Rotation and place of the tool.
    pub rotation: Mat3<S>,
    pub point: Vec3<S>,
    /// Loads on all actuators, N or N m.
    pub forces: Vec<Lanes<S>>,
    /// Shapes of the limbs, if their stability is requested.
    pub shapes: Vec<Shape<S>>,
}

impl<S: Simd> Machine<S> {
    pub fn new(
        simd: S,
        nominal: &Arc<[Plan]>,
        actual: &Arc<[Plan]>,
        body: PlatformMass,
        gravity: [f64; 3],
    ) -> Self {
        let plans = || nominal.iter().zip(actual.iter());
        let zero = Lanes::new(simd, 0.0);
        let nowhere = Target {
            rotation: identity(simd),
            point: [zero; 3],
        };
        Self {
            nominal: Arc::clone(nominal),
            actual: Arc::clone(actual),
            passes: plans()
                .map(|(n, a)| (ForwardPass::new(simd, n), ForwardPass::new(simd, a)))
                .collect(),
            joints: nominal.iter().map(|n| Joints::new(simd, n)).collect(),
            limbs: actual.iter().map(|a| LoadedLimb::new(simd, a)).collect(),
            newton: None,
            attached: vec![AttachedLimb::new(simd); actual.len()],
            compliance: Symmetric::zero(simd),
            body,
            gravity,
            compliance_at: nowhere,
            regular: zero,
            precision: EXACT,
            place: nowhere,
            target: nowhere,
            found: zero,
            load: [zero; 6],
            trend: Trend::new(simd),
            rotation: identity(simd),
            point: [Lanes::new(simd, 0.0); 3],
            forces: vec![Lanes::new(simd, 0.0); actual.iter().map(|a| a.commands).sum()],
            shapes: Vec::new(),
        }
    }

    /// True if its buffers have the sizes that another machine of the same instruction set needs.
    pub fn fits(&self, nominal: &[Plan], actual: &[Plan]) -> bool {
        let alike = |ours: &[Plan], theirs: &[Plan]| {
            // Usually it is the machine itself.
            std::ptr::eq(ours, theirs)
                || ours.len() == theirs.len() && ours.iter().zip(theirs).all(|(a, b)| a.is_like(b))
        };
        alike(&self.nominal, nominal) && alike(&self.actual, actual)
    }

    /// Becomes another machine that it fits.
    pub fn becomes(
        &mut self,
        nominal: &Arc<[Plan]>,
        actual: &Arc<[Plan]>,
        body: PlatformMass,
        gravity: [f64; 3],
    ) {
        if !Arc::ptr_eq(&self.nominal, nominal) {
            self.nominal = Arc::clone(nominal);
        }
        if !Arc::ptr_eq(&self.actual, actual) {
            self.actual = Arc::clone(actual);
        }
        (self.body, self.gravity) = (body, gravity);
    }

    #[inline(always)]
    pub fn actuator_forces(&mut self, simd: S) {
        self.forces.fill(Lanes::new(simd, 0.0));
        let mut first = 0;
        for (limb, plan) in self.limbs.iter().zip(self.actual.iter()) {
            let own = &mut self.forces[first..first + plan.commands];
            actuator_forces(simd, plan, limb, own);
            first += plan.commands;
        }
    }

    /// One where the wrench and all answers are numbers, and squares of forces too.
    #[inline(always)]
    pub fn numbers(&self, simd: S, wrench: &[Lanes<S>; 6]) -> Lanes<S> {
        let (zero, one) = (Lanes::new(simd, 0.0), Lanes::new(simd, 1.0));
        let (mut good, mut all) = (one, zero);
        for x in wrench {
            good = x.abs().where_less(one * 1e100, good, zero);
        }
        for x in &self.point {
            all = x.times_plus(zero, all);
        }
        for x in &self.forces {
            all = x.times_plus(zero, all);
        }
        for limb in &self.limbs {
            for x in &limb.coordinates {
                all = x.times_plus(zero, all);
            }
        }
        good.least_of(all + 1.0)
    }

    /// One limb without passive joints: its tip goes where the wrench leads.
    pub fn is_serial(&self) -> bool {
        self.actual.len() == 1 && self.actual[0].passive.is_empty() && self.body.mass == 0.0
    }
}

/// State at the posture before.
pub(crate) struct Trend<S: Simd> {
    /// One in the lanes where it was found.
    pub known: Lanes<S>,
    pub place: Target<S>,
    pub load: [Lanes<S>; 6],
    /// Numbers of the posture at hand, in the order of `Machine::note_all`, and by how much they have changed since the one before.
    last: Vec<Lanes<S>>,
    change: Vec<Lanes<S>>,
}

impl<S: Simd> Trend<S> {
    pub fn new(simd: S) -> Self {
        let zero = Lanes::new(simd, 0.0);
        Self {
            known: zero,
            place: Target {
                rotation: identity(simd),
                point: [zero; 3],
            },
            load: [zero; 6],
            last: Vec::new(),
            change: Vec::new(),
        }
    }

    /// Marks the next posture as one without a neighbour.
    #[inline(always)]
    pub fn forget(&mut self, simd: S) {
        self.known = Lanes::new(simd, 0.0);
    }

    #[inline(always)]
    pub fn note(&mut self, index: &mut usize, numbers: &[Lanes<S>]) {
        for now in numbers {
            if *index == self.last.len() {
                self.last.push(*now);
                self.change.push(*now);
            }
            self.change[*index] = *now - self.last[*index];
            self.last[*index] = *now;
            *index += 1;
        }
    }

    /// Changes numbers by a share of their last change.
    #[inline(always)]
    pub fn go_on(&self, from: &mut usize, share: Lanes<S>, numbers: &mut [Lanes<S>]) {
        let zero = share.same(0.0);
        for x in numbers {
            let to = self.change[*from].times_plus(share, *x);
            // Numbers of a posture that was not found may be NaN.
            *x = zero.where_less(share, to, *x);
            *from += 1;
        }
    }
}
