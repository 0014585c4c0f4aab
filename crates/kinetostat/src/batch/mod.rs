//! Many postures at once.
//!
//! A machine is compiled once into a [`Batch`]: per limb a list of steps with constants folded.
//! Kernels walk along the steps with several postures in each number, without a branch that
//! depends on a posture and without allocating; the widest vector instructions of the machine are
//! chosen at run time. A posture whose lane cannot go on (a singular place, an iteration that does
//! not contract) is solved once more alone, by the general engine, and so is every posture of a
//! machine with something that no kernel knows; see [`Batch::alone`].
//!
//! The answer of a posture depends on nothing but that posture: not on its neighbours, the number of
//! threads or the width of the vectors.

mod actuators;
mod apart;
mod compensate;
mod dual;
mod eliminate;
mod equilibria;
mod freed;
mod lanes;
mod law;
mod loaded;
mod models;
mod newton;
#[cfg(test)]
mod newton_tests;
mod plan;
mod reach;
mod run;
mod shape;
mod symmetric;
mod table;
mod tangent;
#[cfg(test)]
mod tests;
mod unloaded;
mod verdict;

use rayon::prelude::*;

use crate::error::{Error, Result};
use crate::machine::inverse::limb::LimbPosture;
use crate::machine::posture::Posture;
use crate::model::chain::Chain;
use crate::model::kinematics::{Kinematics, unloaded_tip};
use crate::model::mechanism::{Limb, Mechanism};
use crate::spatial::Pose;
pub use equilibria::{BatchEquilibrium, BatchTargets, Verdict};
pub use models::over_machines;
use plan::Plan;
use run::{Places, Work};
use table::BLOCK;
pub use table::Table;

/// Blocks of eight postures that a thread takes at a time.
const BLOCKS: usize = 32;

/// A machine compiled for many postures.
#[derive(Clone, Debug)]
pub struct Batch<'m> {
    mechanism: &'m Mechanism,
    /// Of every limb as drawn (unloaded) and as it is (loaded), or why there are none.
    nominal: std::result::Result<Vec<Plan>, String>,
    actual: std::result::Result<Vec<Plan>, String>,
}

/// How the answer of a posture was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Found {
    /// Together with others.
    Together,
    /// Alone, by the general engine.
    Alone,
    /// Not at all: the error that the general engine gives for this posture says why. Its numbers
    /// are not numbers.
    Not,
}

/// Unloaded stiffness of many postures.
#[derive(Clone, Debug, Default)]
pub struct BatchStiffness {
    /// Cartesian stiffness of the tool at its origin, base axes, 36 numbers row by row (N/m, N/rad,
    /// N m/m, N m/rad), as in [`crate::UnloadedStiffness`].
    pub stiffness: Table,
    /// Jacobian of a serial machine, 6 x n row by row: twist of the tool (m, rad, base axes, at its
    /// origin) per unit of every coordinate. Empty unless asked for.
    pub jacobian: Table,
    /// Commands of all actuators (m, rad), in the mechanism's order, as [`Posture::commands`]. Empty
    /// where they were given.
    pub commands: Table,
    /// How each was found.
    pub found: Vec<Found>,
}

impl<'m> Batch<'m> {
    /// Compiles a machine.
    #[must_use]
    pub fn new(mechanism: &'m Mechanism) -> Self {
        Self {
            mechanism,
            nominal: compiled(mechanism, |limb| &limb.nominal),
            actual: unburdened(mechanism).and_then(|()| compiled(mechanism, |limb| &limb.actual)),
        }
    }

    /// Why all loaded postures of this machine are solved alone, if they are.
    #[must_use]
    pub fn alone(&self) -> Option<&str> {
        self.actual.as_ref().err().map(String::as_str)
    }

    /// Why all unloaded postures of this machine are solved alone, if they are.
    #[must_use]
    pub fn alone_unloaded(&self) -> Option<&str> {
        self.nominal.as_ref().err().map(String::as_str)
    }

    /// Stiffness of the unloaded machine as drawn with the tool at each of the poses.
    #[must_use]
    pub fn stiffness(&self, poses: &[Pose]) -> BatchStiffness {
        let mut out = BatchStiffness::default();
        self.stiffness_into(poses, &mut out);
        out
    }

    /// The same into a result that is written over: a loop over blocks of postures allocates once.
    pub fn stiffness_into(&self, poses: &[Pose], out: &mut BatchStiffness) {
        self.unloaded(&Places::Poses(poses), false, out);
    }

    /// Stiffness, and Jacobian if asked for, of a serial machine with its actuators commanded to
    /// `commands` (m or rad, one after the other for each posture).
    ///
    /// # Errors
    /// [`Error::Size`] if the numbers are no whole postures, [`Error::Model`] for a machine of
    /// several limbs or with passive joints.
    pub fn stiffness_at_joints(&self, commands: &[f64], jacobian: bool) -> Result<BatchStiffness> {
        let mut out = BatchStiffness::default();
        self.stiffness_at_joints_into(commands, jacobian, &mut out)?;
        Ok(out)
    }

    /// The same into a result that is written over.
    ///
    /// # Errors
    /// As [`Self::stiffness_at_joints`].
    pub fn stiffness_at_joints_into(
        &self,
        commands: &[f64],
        jacobian: bool,
        out: &mut BatchStiffness,
    ) -> Result<()> {
        self.unloaded(&self.joints(commands)?, jacobian, out);
        Ok(())
    }

    fn joints<'a>(&self, commands: &'a [f64]) -> Result<Places<'a>> {
        let place = || format!("mechanism '{}'", self.mechanism.name());
        let limbs = self.mechanism.limbs();
        let serial = limbs.len() == 1
            && limbs[0]
                .nominal
                .indices_of(crate::model::chain::Role::Passive)
                .is_empty();
        if !serial {
            return Err(Error::model(
                place(),
                "commands alone lead to a pose in a serial machine without passive joints only",
            ));
        }
        let each = limbs[0].nominal.actuators().len();
        if each == 0 || !commands.len().is_multiple_of(each) {
            return Err(Error::Size {
                place: place(),
                what: "commands",
                expected: each * commands.len().div_ceil(each.max(1)),
                found: commands.len(),
            });
        }
        Ok(Places::Joints { commands, each })
    }

    /// Number of actuators.
    fn commands(&self) -> usize {
        let limbs = self.mechanism.limbs().iter();
        limbs.map(|l| l.nominal.actuators().len()).sum()
    }

    fn unloaded(&self, places: &Places<'_>, jacobian: bool, out: &mut BatchStiffness) {
        let count = places.len();
        let coordinates = self.mechanism.limbs()[0].nominal.coordinate_count();
        let width = if jacobian { 6 * coordinates } else { 0 };
        out.stiffness.reset(36, count);
        out.jacobian.reset(width, count);
        // Commands that were given are known.
        let commands = match places {
            Places::Poses(_) => self.commands(),
            Places::Joints { .. } => 0,
        };
        out.commands.reset(commands, count);
        out.found.clear();
        out.found.resize(count, Found::Not);
        if let Ok(nominal) = &self.nominal {
            let parts = out.stiffness.parts(BLOCKS);
            let works = parts
                .zip(out.jacobian.parts(BLOCKS))
                .zip(out.commands.parts(BLOCKS))
                .zip(out.found.chunks_mut(BLOCK * BLOCKS))
                .enumerate()
                .map(
                    |(k, (((stiffness, jacobian), commands), found))| Work::Unloaded {
                        plans: nominal,
                        places: places.from(k * BLOCKS * BLOCK),
                        stiffness,
                        jacobian,
                        commands,
                        found,
                    },
                );
            in_parallel(works, count);
        }
        let alone = |i: usize| {
            let posture = self.posture(places, i)?;
            let found = posture.stiffness()?;
            let columns = jacobian.then(|| self.jacobian(&posture));
            Ok((found.cartesian.matrix, columns, posture.commands()))
        };
        for (i, answer) in left(&out.found, alone) {
            let Some((matrix, columns, own)) = answer else {
                out.stiffness.set_row(i, |_| f64::NAN);
                out.jacobian.set_row(i, |_| f64::NAN);
                out.commands.set_row(i, |_| f64::NAN);
                continue;
            };
            out.stiffness.set_row(i, |k| matrix[(k / 6, k % 6)]);
            out.commands.set_row(i, |k| own[k]);
            if let Some(j) = columns {
                out.jacobian
                    .set_row(i, |k| j[(k / coordinates, k % coordinates)]);
            }
            out.found[i] = Found::Alone;
        }
    }

    /// Jacobian of a serial machine as drawn, unloaded, at the tool's origin.
    fn jacobian(&self, posture: &Posture<'_>) -> nalgebra::Matrix6xX<f64> {
        let limb = &self.mechanism.limbs()[0];
        let (base, own) = (
            &self.mechanism.platforms()[limb.from].home,
            &posture.limbs()[0],
        );
        let (x, commands) = (&own.coordinates, &own.commands);
        let at = Kinematics::new(&limb.nominal, base, x, commands, false);
        let mut j = at.jacobian(limb.nominal.tip());
        let tip = at.tip_pose();
        let tool = tip * limb.platform_from_tip.inverse();
        let arm = tool.translation.vector - tip.translation.vector;
        for mut twist in j.column_iter_mut() {
            let turn = twist.fixed_rows::<3>(3).into_owned();
            let mut linear = twist.fixed_rows_mut::<3>(0);
            linear += turn.cross(&arm);
        }
        j
    }

    fn posture(&self, places: &Places<'_>, i: usize) -> Result<Posture<'m>> {
        match places {
            Places::Poses(poses) => self.mechanism.posture(&poses[i]),
            Places::Joints { commands, each } => {
                let limb = &self.mechanism.limbs()[0];
                let joints = LimbPosture {
                    commands: commands[i * each..(i + 1) * each].to_vec(),
                    coordinates: limb.nominal.home_coordinates(),
                };
                let base = self.mechanism.platforms()[limb.from].home;
                let tip = unloaded_tip(&limb.nominal, &base, &joints.coordinates, &joints.commands);
                let target = tip * limb.platform_from_tip.inverse();
                self.mechanism.posture_from_joints(&target, vec![joints])
            }
        }
    }
}

fn in_parallel<'a>(works: impl Iterator<Item = Work<'a>>, count: usize) {
    if count <= BLOCKS * BLOCK {
        works.for_each(Work::run);
    } else {
        works
            .collect::<Vec<_>>()
            .into_par_iter()
            .for_each(Work::run);
    }
}

/// Nothing but weight acts on limbs and platforms, or what else.
fn unburdened(mechanism: &Mechanism) -> std::result::Result<(), String> {
    for (i, limb) in mechanism.limbs().iter().enumerate() {
        if !mechanism.loads(i).is_empty() {
            return Err(format!("'{}' bears loads of its own", limb.name));
        }
    }
    if !mechanism.platform_loads().is_empty() {
        return Err("a platform bears loads of its own".into());
    }
    Ok(())
}

/// Plans of all limbs, or why there are none.
fn compiled(
    mechanism: &Mechanism,
    chain: impl Fn(&Limb) -> &Chain,
) -> std::result::Result<Vec<Plan>, String> {
    if mechanism.platforms().len() != 2 {
        return Err("it has platforms between base and tool".into());
    }
    let tool = mechanism.tool();
    let limbs = mechanism.limbs().iter();
    limbs
        .map(|limb| {
            if limb.from != 0 || limb.to != tool {
                return Err(format!("'{}' does not lead from base to tool", limb.name));
            }
            Plan::new(chain(limb), &limb.platform_from_tip.inverse())
        })
        .collect()
}

/// Answers of those that were not found together; `None` where there is none.
fn left<T: Send>(
    found: &[Found],
    alone: impl Fn(usize) -> Result<T> + Sync,
) -> Vec<(usize, Option<T>)> {
    let left: Vec<usize> = (0..found.len())
        .filter(|i| found[*i] != Found::Together)
        .collect();
    // None or one calls no threads.
    if left.len() < 2 {
        return left.into_iter().map(|i| (i, alone(i).ok())).collect();
    }
    left.into_par_iter().map(|i| (i, alone(i).ok())).collect()
}
