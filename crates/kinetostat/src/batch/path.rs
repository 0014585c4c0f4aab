//! Postures along a path, where starting each of them from home leads to the branch that a search from neighbour to
//! neighbour finds.
//!
//! The batch starts every posture from home. A program is continued from point to point instead, so that the machine
//! never changes its branch on the way. A chunk of a path has an answer here only if both are the same: its first
//! posture, and every one that is far from the one before, is the one that the general engine finds from home, the
//! others follow without a jump, and all lie within the limits of the actuators. `None` in all other cases: the caller
//! searches from neighbour to neighbour, which also has the words for points without an answer.
//!
//! Neighbours on a path are nearly the same problem. So a list is divided into as many runs as a block has lanes, one run
//! in each lane, and within its run a posture starts from the one before ([`crate::batch::machine::start`]). The runs depend on the length
//! of the list alone, so that the bits are the same on every instruction set and in every thread.

use std::f64::consts::{PI, TAU};

use crate::batch::assessed::{Way, numbers};
use crate::batch::compiled::Batch;
use crate::batch::equilibria::{BatchEquilibrium, Details};
use crate::batch::status::{Engine, Status};
use crate::model::chain::Role;
use crate::model::mechanism::Mechanism;
use crate::spatial::{Directions, MotionKind, Pose, Wrench};

/// A machine whose postures lie along a path.
pub struct AlongPath {
    mechanism: Mechanism,
    batch: Option<Batch>,
    /// Kernels find the stability, too.
    stability_by_kernels: bool,
    length: f64,
    compared: Compared,
}

/// Criteria for comparing neighbours.
struct Compared {
    /// Kind and limits of every actuator.
    actuators: Vec<(MotionKind, (f64, f64))>,
    /// Column and kind of every passive joint among the coordinates of all limbs.
    passive: Vec<(usize, MotionKind)>,
}

impl Compared {
    fn of(mechanism: &Mechanism) -> Self {
        let limbs = || mechanism.limbs().iter();
        let actuators = limbs().flat_map(|l| l.nominal.actuators());
        let everywhere = (f64::NEG_INFINITY, f64::INFINITY);
        let joints = limbs().flat_map(|l| l.nominal.coordinates()).enumerate();
        Self {
            actuators: actuators
                .map(|a| (a.kind, a.limits.unwrap_or(everywhere)))
                .collect(),
            passive: joints
                .filter(|(_, joint)| joint.role == Role::Passive)
                .map(|(column, joint)| (column, joint.kind))
                .collect(),
        }
    }
}

impl AlongPath {
    /// A joint that moves farther than this between neighbours (rad, or share of the natural length) may
    /// be on another branch.
    pub const JUMP: f64 = 0.1;
    /// A neighbour farther away than this (share of the machine's size) is no better than a start from rest.
    pub const NEAR: f64 = 0.05;

    /// Compiles a machine.
    #[must_use]
    pub fn new(mechanism: &Mechanism) -> Self {
        let batch = Batch::new(mechanism).along_path();
        // A machine of the general engine gains nothing: it is solved from neighbour to neighbour at once.
        let batch = (batch.engine() == Engine::Vectorised).then_some(batch);
        // One posture at home tells whether kernels find the stability.
        let home = mechanism.platforms()[mechanism.tool()].home;
        let assessed = batch.as_ref().and_then(|b| {
            b.equilibrium(&[home], &[Wrench::zero()], Details::Stability)
                .ok()
        });
        Self {
            mechanism: mechanism.clone(),
            stability_by_kernels: assessed.is_some_and(|j| j.status == [Status::Vectorised]),
            batch,
            length: mechanism.natural_length(),
            compared: Compared::of(mechanism),
        }
    }

    /// A machine whose postures depend on their neighbours, because the tool's orientation follows: every question is
    /// answered by `None`.
    #[must_use]
    pub fn by_neighbours(mechanism: &Mechanism) -> Self {
        Self {
            mechanism: mechanism.clone(),
            stability_by_kernels: false,
            batch: None,
            length: mechanism.natural_length(),
            compared: Compared::of(mechanism),
        }
    }

    /// The machine.
    #[must_use]
    pub fn mechanism(&self) -> &Mechanism {
        &self.mechanism
    }

    /// The poses to command so that the tool is at `poses` under `wrenches` in these directions (base axes
    /// `x y z rx ry rz`).
    #[must_use]
    pub fn targets(
        &self,
        poses: &[Pose],
        wrenches: &[Wrench],
        directions: Directions,
    ) -> Option<Vec<Pose>> {
        let batch = self.batch.as_ref()?;
        let found = batch.targets_under_load(poses, wrenches, directions).ok()?;
        self.continued(poses, &found.equilibrium)
            .then_some(found.targets)
    }

    /// Tool poses when commanded to `poses` under `wrenches`.
    #[must_use]
    pub fn rest(&self, poses: &[Pose], wrenches: &[Wrench]) -> Option<BatchEquilibrium> {
        let found = self
            .batch
            .as_ref()?
            .equilibrium(poses, wrenches, Details::Rest);
        found.ok().filter(|found| self.continued(poses, found))
    }

    /// Tool poses as by [`Self::rest`], with the stability ([`BatchEquilibrium::stability`]): in some of the places,
    /// and in between from a parabola where it is verified, to a ten-millionth.
    #[must_use]
    pub fn with_stability(&self, poses: &[Pose], wrenches: &[Wrench]) -> Option<BatchEquilibrium> {
        let batch = self.batch.as_ref().filter(|_| self.stability_by_kernels)?;
        let all_at_once = || {
            let found = batch.equilibrium(poses, wrenches, Details::Stability);
            found.ok().filter(|found| self.continued(poses, found))
        };
        let way = Way::of(poses, wrenches, self.length);
        if !way.could_save() {
            return all_at_once();
        }
        let mut found = self.rest(poses, wrenches)?;
        // The general engine solves what kernels do not decide, one after the other.
        let by_kernels = found.status.iter().all(|s| *s == Status::Vectorised);
        let evenly = by_kernels.then(|| {
            way.stabilities(|wanted| {
                let poses: Vec<Pose> = wanted.iter().map(|i| poses[*i]).collect();
                let wrenches: Vec<Wrench> = wanted.iter().map(|i| wrenches[*i]).collect();
                let some = batch
                    .equilibrium(&poses, &wrenches, Details::Stability)
                    .ok()?;
                let own = 0..wanted.len();
                own.map(|k| match some.status[k] {
                    Status::Vectorised => numbers(&some, k),
                    _ => None,
                })
                .collect()
            })
        });
        if let Some(stabilities) = evenly.flatten() {
            found.set_stabilities(&stabilities);
            return Some(found);
        }
        all_at_once()
    }

    /// All have an answer within the limits of the actuators, on the branch that a search from
    /// neighbour to neighbour follows.
    fn continued(&self, poses: &[Pose], found: &BatchEquilibrium) -> bool {
        let near = Self::NEAR * self.mechanism.size();
        (0..poses.len()).all(|i| {
            if !found.status[i].is_solved() || self.outside_limits(found, i) {
                return false;
            }
            let place = |i: usize| poses[i].translation.vector;
            if i > 0 && (place(i) - place(i - 1)).norm() < near {
                let (commands, coordinates) = (&found.commands, &found.coordinates);
                let last = |k: usize| commands.get(i - 1, k);
                return !self.jumps(found, i, last, |k| coordinates.get(i - 1, k));
            }
            let Ok(own) = self.mechanism.posture(&poses[i]) else {
                return false;
            };
            let limbs = own.limbs().iter();
            let coordinates = limbs.flat_map(|l| l.coordinates.iter().copied());
            let (commands, coordinates) = (own.commands(), coordinates.collect::<Vec<f64>>());
            !self.jumps(found, i, |k| commands[k], |k| coordinates[k])
        })
    }

    /// A command lies outside its actuator's limits.
    fn outside_limits(&self, found: &BatchEquilibrium, i: usize) -> bool {
        let mut all = self.compared.actuators.iter().enumerate();
        all.any(|(k, (_, (low, high)))| {
            let command = found.commands.get(i, k);
            command < *low || command > *high
        })
    }

    /// A command or a passive joint of a posture lies far from the one given of the same column.
    fn jumps(
        &self,
        found: &BatchEquilibrium,
        i: usize,
        command: impl Fn(usize) -> f64,
        coordinate: impl Fn(usize) -> f64,
    ) -> bool {
        let far = |kind: MotionKind, difference: f64| match kind {
            MotionKind::Prismatic => difference.abs() > Self::JUMP * self.length,
            MotionKind::Revolute => difference.abs() > Self::JUMP,
        };
        let mut commands = self.compared.actuators.iter().enumerate();
        if commands.any(|(k, (kind, _))| far(*kind, found.commands.get(i, k) - command(k))) {
            return true;
        }
        // A passive joint that has turned round is where it was.
        let turn = |d: f64| (d + PI).rem_euclid(TAU) - PI;
        self.compared.passive.iter().any(|(k, kind)| {
            let difference = found.coordinates.get(i, *k) - coordinate(*k);
            far(*kind, difference)
                && match kind {
                    MotionKind::Prismatic => true,
                    MotionKind::Revolute => far(*kind, turn(difference)),
                }
        })
    }
}
