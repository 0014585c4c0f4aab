//! Postures of a path solved by the vector kernels of the core, where their answer is the one that a search from
//! neighbour to neighbour finds.
//!
//! The batch starts every posture from home. A program is continued from point to point instead, so
//! that the machine never changes its branch on the way. A chunk is taken from the batch only if both
//! are the same: its first posture, and every one that is far from the one before, is the one that the
//! general engine finds from home, and the others follow without a jump. Everything else, limits and
//! points without an answer included, is left to the search point by point, which also has the words
//! for it.

use std::f64::consts::{PI, TAU};

use kinetostat::batch::{Batch, BatchEquilibrium, Found, Table};
use kinetostat::{Mechanism, MotionKind, Pose, Role, Wrench};

use crate::near::natural_length;
use crate::postures::neighbour::{NEAR, POSITIONS};

/// A joint that moves farther than this between neighbours (rad, or share of the natural length) may
/// be on another branch.
pub(crate) const JUMP: f64 = 0.1;

/// A machine with its batch, for postures that can be solved by vector kernels.
pub(crate) struct VectorisedPostures<'m> {
    mechanism: &'m Mechanism,
    batch: Option<Batch<'m>>,
    /// There are kernels for stiffness and stability of an equilibrium, too.
    with_stability: bool,
    length: f64,
}

impl<'m> VectorisedPostures<'m> {
    /// `follows`: the orientation follows, which is a matter of neighbours: no kernel is used.
    pub fn new(mechanism: &'m Mechanism, follows: bool) -> Self {
        let batch = (!follows).then(|| Batch::new(mechanism));
        let batch = batch.filter(|b| b.alone().is_none());
        // One posture at home shows whether there are kernels for it.
        let home = mechanism.platforms()[mechanism.tool()].home;
        let at_home = batch
            .as_ref()
            .and_then(|b| b.judged_equilibrium(&[home], &[Wrench::zero()]).ok());
        Self {
            mechanism,
            with_stability: at_home.is_some_and(|j| j.found == [Found::Together]),
            batch,
            length: natural_length(mechanism),
        }
    }

    pub fn mechanism(&self) -> &'m Mechanism {
        self.mechanism
    }

    /// The poses to command so that the tool is at `poses` under `wrenches`.
    pub fn targets(&self, poses: &[Pose], wrenches: &[Wrench]) -> Option<Vec<Pose>> {
        let batch = self.batch.as_ref()?;
        let found = batch.targets_under_load(poses, wrenches, POSITIONS).ok()?;
        self.continued(poses, &found.equilibrium)
            .then_some(found.targets)
    }

    /// Where the tool goes when commanded to `poses` under `wrenches`.
    pub fn rest(&self, poses: &[Pose], wrenches: &[Wrench]) -> Option<BatchEquilibrium> {
        let found = self.batch.as_ref()?.equilibrium(poses, wrenches, false);
        found.ok().filter(|found| self.continued(poses, found))
    }

    /// As [`Self::rest`], with stiffness and stability.
    pub fn with_stability(&self, poses: &[Pose], wrenches: &[Wrench]) -> Option<BatchEquilibrium> {
        let batch = self.batch.as_ref().filter(|_| self.with_stability)?;
        let found = batch.judged_equilibrium(poses, wrenches);
        found.ok().filter(|found| self.continued(poses, found))
    }

    /// All have an answer within the limits of the actuators, on the branch that a search from
    /// neighbour to neighbour follows.
    fn continued(&self, poses: &[Pose], found: &BatchEquilibrium) -> bool {
        let near = NEAR * self.mechanism.size();
        (0..poses.len()).all(|i| {
            if found.found[i] == Found::Not || outside_limits(self.mechanism, &found.commands, i) {
                return false;
            }
            let place = |i: usize| poses[i].translation.vector;
            if i > 0 && (place(i) - place(i - 1)).norm() < near {
                let last = (found.commands.row(i - 1), found.coordinates.row(i - 1));
                return self.no_jump(found, i, last.0, last.1);
            }
            let Ok(own) = self.mechanism.posture(&poses[i]) else {
                return false;
            };
            let passive = own
                .limbs()
                .iter()
                .flat_map(|l| l.coordinates.iter().copied());
            self.no_jump(found, i, own.commands().into_iter(), passive)
        })
    }

    /// No command and no passive joint of a posture lies far from those given.
    fn no_jump(
        &self,
        found: &BatchEquilibrium,
        i: usize,
        commands: impl Iterator<Item = f64>,
        coordinates: impl Iterator<Item = f64>,
    ) -> bool {
        let limbs = || self.mechanism.limbs().iter();
        let far = |kind: MotionKind, difference: f64| match kind {
            MotionKind::Prismatic => difference.abs() / self.length,
            MotionKind::Revolute => difference.abs(),
        };
        let actuators = limbs().flat_map(|l| l.nominal.actuators());
        let mut own = actuators.zip(found.commands.row(i).zip(commands));
        if own.any(|(a, (x, y))| far(a.kind, x - y) > JUMP) {
            return false;
        }
        let joints = limbs().flat_map(|l| l.nominal.coordinates());
        let mut own = joints.zip(found.coordinates.row(i).zip(coordinates));
        // A passive joint that has turned round is where it was.
        let turn = |d: f64| (d + PI).rem_euclid(TAU) - PI;
        !own.any(|(c, (x, y))| {
            let difference = match c.kind {
                MotionKind::Prismatic => x - y,
                MotionKind::Revolute => turn(x - y),
            };
            c.role == Role::Passive && far(c.kind, difference) > JUMP
        })
    }
}

/// A command of a posture of the batch lies outside its actuator's limits.
pub(crate) fn outside_limits(mechanism: &Mechanism, commands: &Table, i: usize) -> bool {
    let limbs = mechanism.limbs().iter();
    let mut own = limbs
        .flat_map(|l| l.nominal.actuators())
        .zip(commands.row(i));
    own.any(|(actuator, command)| {
        let limits = actuator.limits;
        limits.is_some_and(|(low, high)| command < low || command > high)
    })
}
