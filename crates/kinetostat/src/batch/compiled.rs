//! A machine compiled for many postures, and what is done with those that kernels leave over.

use std::sync::Arc;

use crate::batch::machine::group::Places;
use crate::batch::numbers::instruction_set::has_kernels;
use crate::batch::plan::steps::Plan;
use crate::batch::run::Job;
use crate::batch::status::{Engine, NoKernel, Status};
use crate::batch::table::{BLOCK, Buffers};
use crate::error::{Error, Result};
use crate::machine::inverse::limb::LimbPosture;
use crate::machine::posture::Posture;
use crate::model::chain::Chain;
use crate::model::kinematics::unloaded_tip;
use crate::model::mechanism::{Limb, Mechanism};
use crate::parallel;

/// Blocks of eight postures that a thread takes at a time.
pub(crate) const BLOCKS: usize = 32;

/// Blocks of loaded postures that a thread takes at a time: each takes longer, and both cores then end at nearly the
/// same time.
pub(crate) const LOADED_BLOCKS: usize = 8;

/// A machine compiled for many postures.
///
/// ```
/// use kinetostat::batch::{Batch, Details};
/// use kinetostat::nalgebra::{Vector3, vector};
/// use kinetostat::{ActuatorSpec, BeamSection, Chain, Mechanism, MotionKind, Pose, Wrench};
///
/// let slide = |axis| ActuatorSpec::new(MotionKind::Prismatic, axis, 5e7); // N/m
/// let gantry = Chain::builder("gantry")
///     .actuator("x", slide(Vector3::x()))
///     .actuator("y", slide(Vector3::y()))
///     .link("column", &BeamSection::tube(2.1e11, 8.1e10, 0.2, 0.17), 0.4)
///     .build()?;
/// let gantry = Mechanism::serial(gantry, Pose::translation(0.4, 0.0, 0.0), Vector3::zeros())?;
/// let batch = Batch::new(&gantry);
///
/// let poses: Vec<Pose> = (0..100).map(|i| Pose::translation(0.4 + 1e-3 * f64::from(i), 0.1, 0.0)).collect();
/// let wrenches = vec![Wrench::new(vector![0.0, 0.0, 500.0], Vector3::zeros()); poses.len()]; // N
/// let found = batch.equilibrium(&poses, &wrenches, Details::Stiffness)?;
/// assert!(found.status.iter().all(|status| status.is_solved()));
/// assert!(found.tool_pose(99).translation.z > 0.0, "the force bends the column");
/// # Ok::<(), kinetostat::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Batch {
    pub(crate) mechanism: Mechanism,
    /// Plans of every limb as drawn (unloaded) and as it is (loaded), or the reason why there are none.
    pub(crate) nominal: std::result::Result<Arc<[Plan]>, NoKernel>,
    pub(crate) actual: std::result::Result<Arc<[Plan]>, NoKernel>,
    /// Loaded postures lie along a path: see [`crate::batch::path`].
    pub(crate) along: bool,
    /// Buffers of kernels that have run.
    pub(crate) buffers: Buffers,
}

impl Batch {
    /// Compiles a machine.
    #[must_use]
    pub fn new(mechanism: &Mechanism) -> Self {
        Self {
            mechanism: mechanism.clone(),
            nominal: compiled(mechanism, |limb| &limb.nominal),
            actual: unburdened(mechanism).and_then(|()| compiled(mechanism, |limb| &limb.actual)),
            along: false,
            buffers: Buffers::default(),
        }
    }

    /// Engine that solves loaded postures of this machine, with the reason.
    #[must_use]
    pub fn engine(&self) -> Engine {
        Engine::of(&self.actual)
    }

    /// Engine that solves unloaded postures of this machine, with the reason.
    #[must_use]
    pub fn engine_unloaded(&self) -> Engine {
        Engine::of(&self.nominal)
    }

    pub(crate) fn joints<'a>(&self, commands: &'a [f64]) -> Result<Places<'a>> {
        let place = || self.mechanism.place();
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

    /// Prepares for postures that lie along a path, each a start for the next: see [`crate::batch::path`].
    pub(crate) fn along_path(mut self) -> Self {
        self.along = true;
        self
    }

    /// Disables the kernels of the machine without load.
    pub(crate) fn without_unloaded_kernels(mut self) -> Self {
        self.nominal = Err(NoKernel::LoadedPlatform);
        self
    }

    /// Number of actuators.
    pub(crate) fn commands(&self) -> usize {
        let limbs = self.mechanism.limbs().iter();
        limbs.map(|l| l.nominal.actuators().len()).sum()
    }

    pub(crate) fn posture(&self, places: &Places<'_>, i: usize) -> Result<Posture> {
        match places {
            Places::Poses(poses) | Places::Known { poses, .. } => self.mechanism.posture(&poses[i]),
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

pub(crate) fn in_parallel<'a>(jobs: impl Iterator<Item = Job<'a>>, count: usize) {
    if count <= BLOCKS * BLOCK {
        jobs.for_each(Job::run);
    } else {
        parallel::map(jobs.collect(), Job::run);
    }
}

/// Checks that only weight acts on limbs and platforms; the error names another load.
pub(crate) fn unburdened(mechanism: &Mechanism) -> std::result::Result<(), NoKernel> {
    for (i, limb) in mechanism.limbs().iter().enumerate() {
        if !mechanism.loads(i).is_empty() {
            return Err(NoKernel::LoadedLimb(limb.name.clone()));
        }
    }
    if !mechanism.platform_loads().is_empty() {
        return Err(NoKernel::LoadedPlatform);
    }
    Ok(())
}

/// Plans of all limbs, or why there are none.
pub(crate) fn compiled(
    mechanism: &Mechanism,
    chain: impl Fn(&Limb) -> &Chain,
) -> std::result::Result<Arc<[Plan]>, NoKernel> {
    if !has_kernels() {
        return Err(NoKernel::Processor);
    }
    if mechanism.platforms().len() != 2 {
        return Err(NoKernel::PlatformsBetween);
    }
    let tool = mechanism.tool();
    let limbs = mechanism.limbs().iter();
    limbs
        .map(|limb| {
            if limb.from != 0 || limb.to != tool {
                return Err(NoKernel::OtherPlatforms(limb.name.clone()));
            }
            Plan::new(chain(limb), &limb.platform_from_tip.inverse())
        })
        .collect()
}

/// Answers of those that the kernels have left over; `None` where there is none.
pub(crate) fn left<T: Send>(
    status: &[Status],
    scalar: impl Fn(usize) -> Result<T> + Sync,
) -> Vec<(usize, Option<T>)> {
    let left: Vec<usize> = (0..status.len())
        .filter(|i| status[*i] != Status::Vectorised)
        .collect();
    // Fewer than two postures need no threads.
    if left.len() < 2 {
        return left.into_iter().map(|i| (i, scalar(i).ok())).collect();
    }
    parallel::map(left, |i| (i, scalar(i).ok()))
}
