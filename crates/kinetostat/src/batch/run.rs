//! From lists of postures to lanes and back.

use pulp::{Arch, Simd, WithSimd};

use super::Found;
use super::actuators;
use super::compensate;
use super::eliminate::Eliminated;
use super::lanes::{self, Lanes, identity};
use super::loaded::{Held6, LoadedLimb, serial};
use super::newton::Newton;
use super::plan::Plan;
use super::reach::{Joints, Target};
use super::shape::Shape;
use super::symmetric::Symmetric;
use super::table::BLOCK;
use super::unloaded::Walk;
use crate::spatial::{Pose, Wrench};

/// Below this relative pivot a posture is solved alone: its rank has to be decided.
pub(super) const REGULAR: f64 = 1e-9;

/// Where the machine is commanded.
#[derive(Clone, Copy)]
pub(super) enum Places<'a> {
    Poses(&'a [Pose]),
    Joints { commands: &'a [f64], each: usize },
}

impl<'a> Places<'a> {
    pub fn len(&self) -> usize {
        match self {
            Self::Poses(poses) => poses.len(),
            Self::Joints { commands, each } => commands.len() / each,
        }
    }

    /// Without the first ones.
    pub fn from(&self, first: usize) -> Self {
        match *self {
            Self::Poses(poses) => Self::Poses(&poses[first..]),
            Self::Joints { commands, each } => Self::Joints {
                commands: &commands[first * each..],
                each,
            },
        }
    }
}

/// What one thread does at a time: as many postures as `found` has places.
pub(super) enum Work<'a> {
    Unloaded {
        plans: &'a [Plan],
        places: Places<'a>,
        stiffness: &'a mut [f64],
        jacobian: &'a mut [f64],
        commands: &'a mut [f64],
        found: &'a mut [Found],
    },
    Loaded {
        nominal: &'a [Plan],
        actual: &'a [Plan],
        body: ([f64; 3], f64),
        gravity: [f64; 3],
        places: Places<'a>,
        wrenches: &'a [Wrench],
        /// Directions in which the tool shall be at the places under load, if they are to be
        /// corrected.
        directions: Option<[bool; 6]>,
        answers: Answers<'a>,
    },
}

/// Where the numbers of loaded postures go, as in [`super::BatchEquilibrium`].
pub(super) struct Answers<'a> {
    pub tool: &'a mut [f64],
    pub coordinates: &'a mut [f64],
    pub commands: &'a mut [f64],
    pub forces: &'a mut [f64],
    pub stiffness: &'a mut [f64],
    pub verdicts: &'a mut [f64],
    /// Commanded poses, 12 numbers as `tool`.
    pub targets: &'a mut [f64],
    pub found: &'a mut [Found],
}

impl Work<'_> {
    /// In the widest registers that the postures fill at least by half: one posture costs as much in a
    /// wide register as eight.
    pub fn run(self) {
        #[cfg(test)]
        if let Some(set) = CHOSEN.get() {
            return set.dispatch(self);
        }
        #[cfg(target_arch = "x86_64")]
        if let Some(simd) = pulp::x86::V3::try_new() {
            match self.len() {
                0..=1 => return Simd::vectorize(simd, One(self)),
                2..=4 => return Simd::vectorize(simd, self),
                _ => {}
            }
        }
        Arch::new().dispatch(self);
    }

    #[cfg(target_arch = "x86_64")]
    fn len(&self) -> usize {
        match self {
            Self::Unloaded { found, .. } => found.len(),
            Self::Loaded { answers, .. } => answers.found.len(),
        }
    }
}

/// In single numbers, with the fused multiply-adds of the instruction set.
#[cfg(target_arch = "x86_64")]
struct One<'a>(Work<'a>);

#[cfg(target_arch = "x86_64")]
impl WithSimd for One<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        self.0.with_simd(pulp::Scalar);
    }
}

#[cfg(test)]
thread_local! {
    /// The instruction set that a test has chosen for its thread.
    pub(super) static CHOSEN: std::cell::Cell<Option<Arch>> = const { std::cell::Cell::new(None) };
}

impl WithSimd for Work<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        match self {
            Self::Unloaded {
                plans,
                places,
                stiffness,
                jacobian,
                commands,
                found,
            } => unloaded(simd, plans, places, [stiffness, jacobian, commands], found),
            Self::Loaded {
                nominal,
                actual,
                body,
                gravity,
                places,
                wrenches,
                directions,
                answers,
            } => {
                let mut machine = Machine::new(simd, nominal, actual, body, gravity);
                if !answers.verdicts.is_empty() {
                    machine.shapes = actual.iter().map(|a| Shape::new(simd, a)).collect();
                }
                let count = answers.found.len();
                for first in (0..count).step_by(S::F64_LANES) {
                    let group = Group { first, count };
                    let wrench = group.wrench(simd, wrenches);
                    machine.aim(simd, &places, &group);
                    let aim = machine.target;
                    let mut good;
                    let mut rounds = 0;
                    loop {
                        let aimed = matches!(places, Places::Poses(_));
                        good = machine.settle(simd, aimed, &wrench);
                        let Some(directions) = directions else {
                            break;
                        };
                        let off = machine.correct(simd, &aim, &directions, good);
                        rounds += 1;
                        if off.all_less(0.5) {
                            break;
                        }
                        if rounds == compensate::MOST_ROUNDS {
                            good = good * (off.same(1.0) - off);
                            break;
                        }
                    }
                    if !answers.targets.is_empty() {
                        group.put(answers.targets, 0, &machine.target.rotation);
                        group.put(answers.targets, 9, &machine.target.point);
                    }
                    group.put(answers.tool, 0, &machine.rotation);
                    group.put(answers.tool, 9, &machine.point);
                    let (mut from, mut first) = (0, 0);
                    for limb in &machine.limbs {
                        group.put(answers.coordinates, from, &limb.coordinates);
                        group.put(answers.commands, first, &limb.commands);
                        from += limb.coordinates.len();
                        first += limb.commands.len();
                    }
                    machine.actuator_forces(simd);
                    group.put(answers.forces, 0, &machine.forces);
                    if !answers.stiffness.is_empty() {
                        for (limb, plan) in machine.limbs.iter_mut().zip(actual) {
                            limb.frames(plan, &gravity);
                        }
                        let (k, regular) = machine.tangent(simd);
                        good = good.least_of(regular);
                        group.put(answers.stiffness, 0, k.as_flattened());
                        if !answers.verdicts.is_empty() {
                            let (verdict, regular) = machine.verdict(simd, &k);
                            good = good.least_of(regular);
                            group.put(answers.verdicts, 0, &verdict);
                        }
                    }
                    good = good.least_of(machine.numbers(simd, &wrench));
                    group.conclude(good, answers.found);
                }
            }
        }
    }
}

/// Postures side by side in one register.
struct Group {
    first: usize,
    count: usize,
}

impl Group {
    /// Posture in a lane; the last one fills up.
    #[inline(always)]
    fn item(&self, lane: usize) -> usize {
        (self.first + lane).min(self.count - 1)
    }

    /// One number of every posture: `numbers(item)[k]`.
    #[inline(always)]
    fn gather<S: Simd, T, const N: usize>(
        &self,
        simd: S,
        items: &[T],
        numbers: impl Fn(&T) -> [f64; N],
    ) -> [Lanes<S>; N] {
        let mut values = [[0.0; BLOCK]; N];
        for lane in 0..S::F64_LANES {
            let own = numbers(&items[self.item(lane)]);
            for k in 0..N {
                values[k][lane] = own[k];
            }
        }
        let mut out = [Lanes::new(simd, 0.0); N];
        for k in 0..N {
            out[k] = Lanes::load(simd, &values[k]);
        }
        out
    }

    #[inline(always)]
    fn wrench<S: Simd>(&self, simd: S, wrenches: &[Wrench]) -> [Lanes<S>; 6] {
        self.gather(simd, wrenches, |w| w.0.into())
    }

    /// Numbers of these postures into their places of a table.
    #[inline(always)]
    fn put<S: Simd>(&self, table: &mut [f64], from: usize, numbers: &[Lanes<S>]) {
        let width = table.len() / self.count.div_ceil(BLOCK) / BLOCK;
        let start = ((self.first / BLOCK) * width + from) * BLOCK;
        let block = &mut table[start..start + numbers.len() * BLOCK];
        let (places, _) = block.as_chunks_mut::<BLOCK>();
        let lane = self.first % BLOCK;
        for k in 0..numbers.len() {
            numbers[k].store(&mut places[k][lane..]);
        }
    }

    /// Marks the lanes whose least pivot or other measure of good is well above zero.
    #[inline(always)]
    fn conclude<S: Simd>(&self, good: Lanes<S>, found: &mut [Found]) {
        let mut values = [0.0; BLOCK];
        good.store(&mut values);
        for (own, good) in found[self.first..].iter_mut().zip(&values[..S::F64_LANES]) {
            if *good > REGULAR {
                *own = Found::Together;
            }
        }
    }

    #[inline(always)]
    fn target<S: Simd>(&self, simd: S, poses: &[Pose]) -> Target<S> {
        let [x, y, z, w] = self.gather(simd, poses, |p| p.rotation.coords.into());
        let point = self.gather(simd, poses, |p| p.translation.vector.into());
        let one = Lanes::new(simd, 1.0);
        let double = |a: Lanes<S>, b: Lanes<S>| a * b * 2.0;
        Target {
            rotation: [
                one - double(y, y) - double(z, z),
                double(x, y) - double(z, w),
                double(x, z) + double(y, w),
                double(x, y) + double(z, w),
                one - double(x, x) - double(z, z),
                double(y, z) - double(x, w),
                double(x, z) - double(y, w),
                double(y, z) + double(x, w),
                one - double(x, x) - double(y, y),
            ],
            point,
        }
    }

    #[inline(always)]
    fn commands<S: Simd>(&self, simd: S, from: &[f64], each: usize, to: &mut [Lanes<S>]) {
        for (k, x) in to.iter_mut().enumerate() {
            let mut values = [0.0; BLOCK];
            for lane in 0..S::F64_LANES {
                values[lane] = from[self.item(lane) * each + k];
            }
            *x = Lanes::load(simd, &values);
        }
    }
}

#[inline(always)]
fn unloaded<S: Simd>(
    simd: S,
    plans: &[Plan],
    places: Places<'_>,
    [stiffness, jacobian, all_commands]: [&mut [f64]; 3],
    found: &mut [Found],
) {
    let zero = Lanes::new(simd, 0.0);
    let mut limbs: Vec<(Walk<S>, Joints<S>)> = plans
        .iter()
        .map(|plan| (Walk::new(simd, plan), Joints::new(simd, plan)))
        .collect();
    let n = plans[0].coordinates;
    let summed = !jacobian.is_empty() && !plans[0].one_each;
    let mut columns = vec![zero; if summed { 6 * n } else { 0 }];
    let count = found.len();
    for first in (0..count).step_by(S::F64_LANES) {
        let group = Group { first, count };
        let mut good = Lanes::new(simd, 1.0);
        let mut sum = Symmetric::zero(simd);
        match places {
            Places::Joints { commands, each } => {
                let (walk, joints) = &mut limbs[0];
                group.commands(simd, commands, each, &mut joints.commands);
                let within = bounded(simd, &joints.commands);
                let steps = plans[0].steps.len();
                walk.along(&plans[0], true, steps, &joints.commands, &[]);
                let own = walk.stiffness(&plans[0]);
                good = own.regular.least_of(within);
                sum = own.matrix;
            }
            Places::Poses(poses) => {
                let target = group.target(simd, poses);
                for (plan, (walk, joints)) in plans.iter().zip(&mut limbs) {
                    joints.reach(simd, plan, walk, &target, false);
                    let own = match &plan.sphere {
                        Some(sphere) => {
                            let [x, y, z] = sphere.arm;
                            let arm = lanes::constant(simd, &[-x, -y, -z]);
                            let arm = lanes::carried(&target.rotation, &arm, &[zero; 3]);
                            walk.stiffness_at_sphere(plan, &arm)
                        }
                        None => walk.stiffness(plan),
                    };
                    sum.add(&own.matrix);
                    good = good.least_of(own.regular).least_of(joints.reached);
                }
            }
        }
        let mut numbers = [zero; 36];
        let mut all = zero;
        for i in 0..6 {
            for j in 0..6 {
                numbers[6 * i + j] = sum.get(i, j);
                all = sum.get(i, j).times_plus(zero, all);
            }
        }
        // A number that is none spoils the sum.
        good = good.least_of(all + 1.0);
        group.put(stiffness, 0, &numbers);
        if !all_commands.is_empty() {
            let mut own = 0;
            for (_, joints) in &limbs {
                group.put(all_commands, own, &joints.commands);
                own += joints.commands.len();
            }
        }
        if !jacobian.is_empty() {
            let (plan, walk) = (&plans[0], &limbs[0].0);
            columns.fill(zero);
            for (k, screw) in plan.screws.iter().enumerate() {
                let Some((own, ratio)) = screw.coordinate else {
                    continue;
                };
                let twist = walk.twist(plan, k);
                for row in 0..6 {
                    if summed {
                        let x = &mut columns[row * n + own];
                        *x = twist[row].times_plus(twist[row].same(ratio), *x);
                    } else {
                        group.put(jacobian, row * n + own, &[twist[row]]);
                    }
                }
            }
            if summed {
                group.put(jacobian, 0, &columns);
            }
        }
        group.conclude(good, found);
    }
}

/// One where all commands are angles and lengths that sines are exact for.
#[inline(always)]
fn bounded<S: Simd>(simd: S, commands: &[Lanes<S>]) -> Lanes<S> {
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
    walks: Vec<(Walk<S>, Walk<S>)>,
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
    pub rotation: lanes::Mat3<S>,
    pub point: lanes::Vec3<S>,
    /// Of the loads on all actuators, N or N m.
    forces: Vec<Lanes<S>>,
    /// Of the limbs, where verdicts are asked for.
    pub shapes: Vec<Shape<S>>,
}

impl<'a, S: Simd> Machine<'a, S> {
    fn new(
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
            walks: plans()
                .map(|(n, a)| (Walk::new(simd, n), Walk::new(simd, a)))
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
    fn actuator_forces(&mut self, simd: S) {
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
    fn numbers(&self, simd: S, wrench: &[Lanes<S>; 6]) -> Lanes<S> {
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
    fn aim(&mut self, simd: S, places: &Places<'_>, group: &Group) {
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
    fn settle(&mut self, simd: S, aimed: bool, wrench: &[Lanes<S>; 6]) -> Lanes<S> {
        let mut good = Lanes::new(simd, 1.0);
        if aimed {
            let limbs = self.nominal.iter().zip(&mut self.joints);
            for ((plan, joints), (walk, _)) in limbs.zip(&mut self.walks) {
                joints.reach(simd, plan, walk, &self.target, true);
                good = good.least_of(joints.reached);
            }
            (self.rotation, self.point) = (self.target.rotation, self.target.point);
        } else {
            // Where the commands lead the machine as it is drawn.
            let (plan, (walk, _)) = (&self.nominal[0], &mut self.walks[0]);
            let commands = &self.joints[0].commands;
            good = bounded(simd, commands);
            walk.along(plan, false, plan.steps.len(), commands, &[]);
            (self.rotation, self.point) = (walk.rotation, walk.point);
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
        for ((plan, joints), (_, walk)) in self.actual.iter().zip(&self.joints).zip(&mut self.walks)
        {
            walk.along(
                plan,
                true,
                plan.steps.len(),
                &joints.commands,
                &joints.passive,
            );
            let factors = walk.eliminated(plan);
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
