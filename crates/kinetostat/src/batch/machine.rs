//! A machine under load with the buffers of its limbs: from commands to equilibrium, several postures at once.

use pulp::Simd;

use super::actuators;
use super::eliminate::Eliminated;
use super::group::{Group, Places};
use super::lanes::Lanes;
use super::loaded::LoadedLimb;
use super::newton::Newton;
use super::plan::Plan;
use super::platform::Held6;
use super::reach::{Joints, Target};
use super::serial::serial;
use super::shape::Shape;
use super::symmetric::Symmetric;
use super::unloaded::ForwardPass;
use super::vectors::{Mat3, Vec3, identity};

/// One where all commands are angles and lengths that sines are exact for.
#[inline(always)]
pub(super) fn bounded<S: Simd>(simd: S, commands: &[Lanes<S>]) -> Lanes<S> {
    let (zero, one) = (Lanes::new(simd, 0.0), Lanes::new(simd, 1.0));
    let mut good = one;
    for x in commands {
        good = x.abs().where_less(one * 1e5, good, zero);
    }
    good
}

/// A machine with the buffers of its limbs.
pub(super) struct Machine<'a, S: Simd> {
    pub nominal: &'a [Plan],
    pub actual: &'a [Plan],
    passes: Vec<(ForwardPass<S>, ForwardPass<S>)>,
    joints: Vec<Joints<S>>,
    pub limbs: Vec<LoadedLimb<S>>,
    /// Made when it is needed.
    newton: Option<Newton<S>>,
    factors: Vec<Eliminated<S>>,
    /// Largest stiffness of each limb, N m: per share of the natural length, or per radian.
    stiffest: Vec<Lanes<S>>,
    /// Centre of mass (m, axes of the tool) and mass of the platform.
    pub body: ([f64; 3], f64),
    pub gravity: [f64; 3],
    /// Where the tool is commanded.
    pub target: Target<S>,
    /// Where the tool is.
    pub rotation: Mat3<S>,
    pub point: Vec3<S>,
    /// Of the loads on all actuators, N or N m.
    pub forces: Vec<Lanes<S>>,
    /// Of the limbs, where verdicts are asked for.
    pub shapes: Vec<Shape<S>>,
}

impl<'a, S: Simd> Machine<'a, S> {
    pub fn new(
        simd: S,
        nominal: &'a [Plan],
        actual: &'a [Plan],
        body: ([f64; 3], f64),
        gravity: [f64; 3],
    ) -> Self {
        let plans = || nominal.iter().zip(actual);
        Self {
            nominal,
            actual,
            passes: plans()
                .map(|(n, a)| (ForwardPass::new(simd, n), ForwardPass::new(simd, a)))
                .collect(),
            joints: nominal.iter().map(|n| Joints::new(simd, n)).collect(),
            limbs: actual.iter().map(|a| LoadedLimb::new(simd, a)).collect(),
            newton: None,
            factors: Vec::with_capacity(actual.len()),
            stiffest: Vec::with_capacity(actual.len()),
            body,
            gravity,
            target: Target {
                rotation: identity(simd),
                point: [Lanes::new(simd, 0.0); 3],
            },
            rotation: identity(simd),
            point: [Lanes::new(simd, 0.0); 3],
            forces: vec![Lanes::new(simd, 0.0); actual.iter().map(|a| a.commands).sum()],
            shapes: Vec::new(),
        }
    }

    #[inline(always)]
    pub fn actuator_forces(&mut self, simd: S) {
        self.forces.fill(Lanes::new(simd, 0.0));
        let mut first = 0;
        for (limb, plan) in self.limbs.iter().zip(self.actual) {
            let own = &mut self.forces[first..first + plan.commands];
            actuators::forces(simd, plan, limb, own);
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

    /// Commands the machine: its joints, or its tool.
    #[inline(always)]
    pub fn aim(&mut self, simd: S, places: &Places<'_>, group: &Group) {
        match *places {
            Places::Joints { commands, each } => {
                group.commands(simd, commands, each, &mut self.joints[0].commands);
            }
            Places::Poses(poses) => self.target = group.target(simd, poses),
        }
    }

    /// Lets the commanded machine settle, its joints found first if it is `aimed` at a pose of the
    /// tool: one in the lanes that are done.
    #[inline(always)]
    pub fn settle(&mut self, simd: S, aimed: bool, wrench: &[Lanes<S>; 6]) -> Lanes<S> {
        let mut good = Lanes::new(simd, 1.0);
        if aimed {
            let limbs = self.nominal.iter().zip(&mut self.joints);
            for ((plan, joints), (forward, _)) in limbs.zip(&mut self.passes) {
                joints.reach(simd, plan, forward, &self.target, true);
                good = good.least_of(joints.reached);
            }
            (self.rotation, self.point) = (self.target.rotation, self.target.point);
        } else {
            // Where the commands lead the machine as it is drawn.
            let (plan, (forward, _)) = (&self.nominal[0], &mut self.passes[0]);
            let commands = &self.joints[0].commands;
            good = bounded(simd, commands);
            forward.along(plan, false, plan.steps.len(), commands, &[]);
            (self.rotation, self.point) = (forward.rotation, forward.point);
        }
        for ((limb, plan), joints) in self.limbs.iter_mut().zip(self.actual).zip(&self.joints) {
            limb.start(plan, &joints.commands, &joints.passive);
        }
        if self.actual.len() == 1 && self.actual[0].passive.is_empty() && self.body.1 == 0.0 {
            let limb = &mut self.limbs[0];
            let done = serial(
                simd,
                &self.actual[0],
                limb,
                &mut self.newton,
                *wrench,
                &self.gravity,
            );
            (self.rotation, self.point) = (limb.rotation, limb.point);
            return good.least_of(done);
        }
        self.factors.clear();
        self.stiffest.clear();
        let mut sum = Symmetric::zero(simd);
        for ((plan, joints), (_, forward)) in
            self.actual.iter().zip(&self.joints).zip(&mut self.passes)
        {
            forward.along(
                plan,
                true,
                plan.steps.len(),
                &joints.commands,
                &joints.passive,
            );
            let factors = forward.eliminated(plan);
            let length = plan.length;
            let own = factors.stiffness(simd);
            sum.add(&own.matrix.scaled(1.0 / (length * length), 1.0 / length));
            good = good.least_of(own.regular);
            let mut most = own.matrix.get(0, 0);
            for k in 1..6 {
                most = most.max(own.matrix.get(k, k));
            }
            self.stiffest.push(most);
            self.factors.push(factors);
        }
        let (compliance, regular) = sum.inverse(simd);
        let mut held = Held6 {
            plans: self.actual,
            limbs: &mut self.limbs,
            factors: &self.factors,
            stiffest: &self.stiffest,
            compliance: &compliance,
            rotation: self.rotation,
            point: self.point,
            body: self.body,
            gravity: self.gravity,
        };
        let done = held.settle(simd, wrench);
        (self.rotation, self.point) = (held.rotation, held.point);
        good.least_of(regular).least_of(done)
    }
}
