//! From lists of postures to lanes and back.

use pulp::{Simd, WithSimd};

use super::compensate;
use super::group::{Group, Places};
use super::instruction_set::InstructionSet;
use super::lanes::Lanes;
use super::machine::{Machine, bounded};
use super::plan::Plan;
use super::reach::Joints;
use super::shape::Shape;
use super::status::Status;
use super::symmetric::Symmetric;
use super::unloaded::ForwardPass;
use super::vectors::{carried, constant};
use crate::spatial::{Directions, Wrench};

/// What one thread does at a time: as many postures as `status` has places.
pub(super) enum Work<'a> {
    Unloaded {
        plans: &'a [Plan],
        places: Places<'a>,
        stiffness: &'a mut [f64],
        jacobian: &'a mut [f64],
        commands: &'a mut [f64],
        status: &'a mut [Status],
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
        directions: Option<Directions>,
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
    pub status: &'a mut [Status],
}

impl Work<'_> {
    /// In the widest registers that the postures fill at least by half.
    pub fn run(self) {
        InstructionSet::of(self.len()).run(self);
    }

    fn len(&self) -> usize {
        match self {
            Self::Unloaded { status, .. } => status.len(),
            Self::Loaded { answers, .. } => answers.status.len(),
        }
    }
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
                status,
            } => unloaded(simd, plans, places, [stiffness, jacobian, commands], status),
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
                let count = answers.status.len();
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
                        let off = machine.correct(simd, &aim, directions, good);
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
                    group.conclude(good, answers.status);
                }
            }
        }
    }
}

#[inline(always)]
fn unloaded<S: Simd>(
    simd: S,
    plans: &[Plan],
    places: Places<'_>,
    [stiffness, jacobian, all_commands]: [&mut [f64]; 3],
    status: &mut [Status],
) {
    let zero = Lanes::new(simd, 0.0);
    let mut limbs: Vec<(ForwardPass<S>, Joints<S>)> = plans
        .iter()
        .map(|plan| (ForwardPass::new(simd, plan), Joints::new(simd, plan)))
        .collect();
    let n = plans[0].coordinates;
    let summed = !jacobian.is_empty() && !plans[0].one_each;
    let mut columns = vec![zero; if summed { 6 * n } else { 0 }];
    let count = status.len();
    for first in (0..count).step_by(S::F64_LANES) {
        let group = Group { first, count };
        let mut good = Lanes::new(simd, 1.0);
        let mut sum = Symmetric::zero(simd);
        match places {
            Places::Joints { commands, each } => {
                let (forward, joints) = &mut limbs[0];
                group.commands(simd, commands, each, &mut joints.commands);
                let within = bounded(simd, &joints.commands);
                let steps = plans[0].steps.len();
                forward.along(&plans[0], true, steps, &joints.commands, &[]);
                let own = forward.stiffness(&plans[0]);
                good = own.regular.least_of(within);
                sum = own.matrix;
            }
            Places::Poses(poses) => {
                let target = group.target(simd, poses);
                for (plan, (forward, joints)) in plans.iter().zip(&mut limbs) {
                    joints.reach(simd, plan, forward, &target, false);
                    let own = match &plan.sphere {
                        Some(sphere) => {
                            let [x, y, z] = sphere.arm;
                            let arm = constant(simd, &[-x, -y, -z]);
                            let arm = carried(&target.rotation, &arm, &[zero; 3]);
                            forward.stiffness_at_sphere(plan, &arm)
                        }
                        None => forward.stiffness(plan),
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
            let (plan, forward) = (&plans[0], &limbs[0].0);
            columns.fill(zero);
            for (k, screw) in plan.screws.iter().enumerate() {
                let Some((own, ratio)) = screw.coordinate else {
                    continue;
                };
                let twist = forward.twist(plan, k);
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
        group.conclude(good, status);
    }
}
