//! Runs lists of postures in lanes.

use std::sync::Arc;

use pulp::{Simd, WithSimd};

use crate::batch::limb::loaded::Precision;
use crate::batch::limb::reach::{Joints, MOST_STEPS};
use crate::batch::limb::shape::Shape;
use crate::batch::limb::unloaded::ForwardPass;
use crate::batch::machine::group::{Group, Places};
use crate::batch::machine::loaded::{Machine, PlatformMass, bounded};
use crate::batch::numbers::instruction_set::InstructionSet;
use crate::batch::numbers::lanes::Lanes;
use crate::batch::numbers::symmetric::Symmetric;
use crate::batch::numbers::vectors::{carried, constant, select};
use crate::batch::plan::steps::Plan;
use crate::batch::status::Status;
use crate::batch::table::{BLOCK, Buffers};
use crate::spatial::{Directions, Pose, Wrench};

/// Task of one thread: as many postures as `status` has places.
#[expect(
    clippy::large_enum_variant,
    reason = "one for hundreds of postures, and used up where it is made"
)]
pub(crate) enum Job<'a> {
    Unloaded {
        plans: &'a [Plan],
        buffers: &'a Buffers,
        places: Places<'a>,
        stiffness: &'a mut [f64],
        jacobian: &'a mut [f64],
        commands: &'a mut [f64],
        status: &'a mut [Status],
    },
    /// Joints that lead to poses: limb after limb commands, passive joints; not numbers where none are found.
    Joints {
        nominal: &'a [Plan],
        poses: &'a [Pose],
        joints: &'a mut [f64],
    },
    /// Tool poses of a serial machine as it is drawn, at given commands, 12 numbers as [`Answers::tool`].
    Targets {
        plan: &'a Plan,
        commands: &'a [f64],
        targets: &'a mut [f64],
    },
    Loaded {
        nominal: &'a Arc<[Plan]>,
        actual: &'a Arc<[Plan]>,
        body: PlatformMass,
        gravity: [f64; 3],
        places: Places<'a>,
        wrenches: &'a [Wrench],
        /// Directions in which the tool shall be at the places under load, if they are to be
        /// corrected.
        directions: Option<Directions>,
        /// The postures lie along a path: each starts from the one before, in runs of one per lane.
        along: bool,
        precision: Precision,
        buffers: &'a Buffers,
        answers: Answers<'a>,
    },
}

/// Output of loaded postures, as in [`crate::batch::BatchEquilibrium`].
pub(crate) struct Answers<'a> {
    pub tool: &'a mut [f64],
    pub coordinates: &'a mut [f64],
    pub commands: &'a mut [f64],
    pub forces: &'a mut [f64],
    pub stiffness: &'a mut [f64],
    pub stability: &'a mut [f64],
    /// Commanded poses, 12 numbers as `tool`.
    pub targets: &'a mut [f64],
    /// Wrenches on the tips of all limbs, six numbers each, about the tip, base axes.
    pub wrenches: &'a mut [f64],
    /// See [`crate::batch::machine::kept`].
    pub correctors: &'a mut [f64],
    pub status: &'a mut [Status],
}

impl Job<'_> {
    /// Runs in the widest registers that the postures fill at least by half.
    pub fn run(self) {
        InstructionSet::of(self.len()).run(self);
    }

    fn len(&self) -> usize {
        match self {
            Self::Unloaded { status, .. } => status.len(),
            Self::Joints { poses, .. } => poses.len(),
            Self::Targets { plan, commands, .. } => commands.len() / plan.commands,
            Self::Loaded { answers, .. } => answers.status.len(),
        }
    }
}

impl WithSimd for Job<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        match self {
            Self::Unloaded {
                plans,
                buffers,
                places,
                stiffness,
                jacobian,
                commands,
                status,
            } => unloaded(
                simd,
                plans,
                buffers,
                places,
                [stiffness, jacobian, commands],
                status,
            ),
            Self::Joints {
                nominal,
                poses,
                joints,
            } => known(simd, nominal, poses, joints),
            Self::Targets {
                plan,
                commands,
                targets,
            } => aimed(simd, plan, commands, targets),
            Self::Loaded {
                nominal,
                actual,
                body,
                gravity,
                places,
                wrenches,
                directions,
                along,
                precision,
                buffers,
                mut answers,
            } => {
                let make = || Machine::new(simd, nominal, actual, body, gravity);
                let fits = |kept: &Machine<S>| kept.fits(nominal, actual);
                let mut machine = buffers.take_fitting(fits, make);
                machine.becomes(nominal, actual, body, gravity);
                if !answers.stability.is_empty() && machine.shapes.is_empty() {
                    machine.shapes = actual.iter().map(|a| Shape::new(simd, a)).collect();
                }
                machine.precision = precision;
                let count = answers.status.len();
                // Uses as many runs as a block has lanes, so that a run is the same on every instruction set.
                let run = if along { count.div_ceil(BLOCK) } else { 1 };
                for from in (0..count).step_by(S::F64_LANES * run) {
                    for first in from..count.min(from + run) {
                        let group = Group {
                            first,
                            stride: run,
                            count,
                        };
                        let wrench = group.wrench(simd, wrenches);
                        let start = match places {
                            Places::Joints { commands, each } => {
                                machine.start_at_joints(simd, &group, commands, each)
                            }
                            Places::Poses(poses) | Places::Known { poses, .. }
                                if along && first > from =>
                            {
                                let place = group.target(simd, poses);
                                machine.go_on(simd, place, &wrench, directions)
                            }
                            Places::Known {
                                poses,
                                joints,
                                standing,
                                deviations,
                                first,
                            } => {
                                let target = group.target(simd, poses);
                                let standing = standing.map(|s| (s, deviations));
                                machine.start_with(simd, &group, target, joints, standing, first)
                            }
                            Places::Poses(poses) => {
                                machine.start_at(simd, group.target(simd, poses))
                            }
                        };
                        machine.load = wrench;
                        let good = machine.converge(simd, &wrench, directions, start);
                        machine.answer(simd, &group, &wrench, good, &mut answers);
                    }
                }
                buffers.put(machine);
            }
        }
    }
}

impl<S: Simd> Machine<S> {
    /// Writes what was found to the places of these postures, those that are `good` as solved.
    #[inline(always)]
    fn answer(
        &mut self,
        simd: S,
        group: &Group,
        wrench: &[Lanes<S>; 6],
        mut good: Lanes<S>,
        answers: &mut Answers<'_>,
    ) {
        if !answers.targets.is_empty() {
            group.put(answers.targets, 0, &self.target.rotation);
            group.put(answers.targets, 9, &self.target.point);
        }
        if !answers.wrenches.is_empty() {
            for (i, limb) in self.limbs.iter().enumerate() {
                group.put(answers.wrenches, 6 * i, &limb.wrench);
            }
        }
        if !answers.correctors.is_empty() {
            self.keep_correctors(group, answers.correctors);
        }
        group.put(answers.tool, 0, &self.rotation);
        group.put(answers.tool, 9, &self.point);
        let (mut from, mut first) = (0, 0);
        for limb in &self.limbs {
            group.put(answers.coordinates, from, &limb.coordinates);
            group.put(answers.commands, first, &limb.commands);
            from += limb.coordinates.len();
            first += limb.commands.len();
        }
        self.actuator_forces(simd);
        group.put(answers.forces, 0, &self.forces);
        if !answers.stiffness.is_empty() {
            for (limb, plan) in self.limbs.iter_mut().zip(self.actual.iter()) {
                limb.frames(plan, &self.gravity);
            }
            let (k, regular) = self.tangent(simd);
            good = good.least_of(regular);
            group.put(answers.stiffness, 0, k.as_flattened());
            if !answers.stability.is_empty() {
                let (stability, regular) = self.stability(simd, &k);
                good = good.least_of(regular);
                group.put(answers.stability, 0, &stability);
            }
        }
        good = good.least_of(self.numbers(simd, wrench));
        // A posture that is no number is no start for the next one on a path.
        self.found = good;
        group.conclude(good, answers.status);
    }
}

/// Joints of the unloaded machine at its places, searched from home as [`Machine::start_at`] does.
#[inline(always)]
fn known<S: Simd>(simd: S, nominal: &[Plan], poses: &[Pose], joints: &mut [f64]) {
    let one = Lanes::new(simd, 1.0);
    let mut limbs: Vec<(ForwardPass<S>, Joints<S>)> = nominal
        .iter()
        .map(|plan| (ForwardPass::new(simd, plan), Joints::new(simd, plan)))
        .collect();
    for first in (0..poses.len()).step_by(S::F64_LANES) {
        let group = Group::of_neighbours(first, poses.len());
        let target = group.target(simd, poses);
        let mut from = 0;
        for (plan, (forward, own)) in nominal.iter().zip(&mut limbs) {
            own.home(simd, plan, one);
            let away = own.find(plan, forward, &target, MOST_STEPS, one);
            for numbers in [&mut own.commands, &mut own.passive] {
                for x in numbers.iter_mut() {
                    *x = select(away, one * f64::NAN, *x);
                }
                group.put(joints, from, numbers);
                from += numbers.len();
            }
        }
    }
}

/// Tool poses of a serial machine at given commands.
#[inline(always)]
fn aimed<S: Simd>(simd: S, plan: &Plan, commands: &[f64], targets: &mut [f64]) {
    let mut forward = ForwardPass::new(simd, plan);
    let mut own = vec![Lanes::new(simd, 0.0); plan.commands];
    let count = commands.len() / plan.commands;
    for first in (0..count).step_by(S::F64_LANES) {
        let group = Group::of_neighbours(first, count);
        group.commands(simd, commands, plan.commands, &mut own);
        forward.along(plan, false, plan.steps.len(), &own, &[]);
        group.put(targets, 0, &forward.rotation);
        group.put(targets, 9, &forward.point);
    }
}

/// Buffers of a machine without load: of every limb, and of a Jacobian whose columns are summed up.
struct Unloaded<S: Simd> {
    limbs: Vec<(ForwardPass<S>, Joints<S>)>,
    columns: Vec<Lanes<S>>,
}

#[inline(always)]
fn unloaded<S: Simd>(
    simd: S,
    plans: &[Plan],
    buffers: &Buffers,
    places: Places<'_>,
    [stiffness, jacobian, all_commands]: [&mut [f64]; 3],
    status: &mut [Status],
) {
    let zero = Lanes::new(simd, 0.0);
    let mut own = buffers.take(|| Unloaded {
        limbs: plans
            .iter()
            .map(|plan| (ForwardPass::new(simd, plan), Joints::new(simd, plan)))
            .collect(),
        columns: Vec::new(),
    });
    let Unloaded { limbs, columns } = &mut *own;
    let n = plans[0].coordinates;
    let summed = !jacobian.is_empty() && !plans[0].one_each;
    if summed {
        columns.resize(6 * n, zero);
    }
    let count = status.len();
    for first in (0..count).step_by(S::F64_LANES) {
        let group = Group::of_neighbours(first, count);
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
            Places::Poses(poses) | Places::Known { poses, .. } => {
                let target = group.target(simd, poses);
                for (plan, (forward, joints)) in plans.iter().zip(limbs.iter_mut()) {
                    let reached = joints.reach(simd, plan, forward, &target);
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
                    good = good.least_of(own.regular).least_of(reached);
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
            for (_, joints) in limbs.iter() {
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
                group.put(jacobian, 0, columns);
            }
        }
        group.conclude(good, status);
    }
    buffers.put(own);
}
