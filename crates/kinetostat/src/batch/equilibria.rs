//! Loaded postures: what is wanted of them, and where the answers go.

use nalgebra::Matrix6;

use crate::batch::compiled::{BLOCKS, Batch, LOADED_BLOCKS, in_parallel, left};
use crate::batch::limb::loaded::{ALONG_PATH, EXACT, FROM_DRAWN};
use crate::batch::limb::shape::springs;
use crate::batch::machine::group::{Places, Standing};
use crate::batch::machine::kept;
use crate::batch::machine::loaded::PlatformMass;
use crate::batch::plan::steps::Plan;
use crate::batch::run::{Answers, Job};
use crate::batch::status::{Engine, Status};
use crate::batch::table::{BLOCK, Table};
use crate::chain::residual::FoundBy;
use crate::chain::system::System;
use crate::compensation::target::target_under_load;
use crate::error::{Error, Result};
use crate::machine::equilibrium::MechanismEquilibrium;
use crate::machine::participation::NEARLY_RIGID_SPREAD;
use crate::machine::posture::Posture;
use crate::machine::state::MechanismState;
use crate::model::mechanism::Mechanism;
use crate::number::smaller;
use crate::spatial::{Directions, Pose, Wrench};

/// Loaded equilibrium of many postures.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct BatchEquilibrium {
    /// Pose of the tool, 12 numbers: rotation matrix (base from tool) row by row, position (m).
    pub tool: Table,
    /// Coordinates of all limbs (m, rad), limb after limb in their chains' order.
    pub coordinates: Table,
    /// Commands of all actuators (m, rad), in the mechanism's order, as [`Posture::commands`].
    pub commands: Table,
    /// Forces (N) or torques (N m) of the loads on all actuators, in the same order, as
    /// [`MechanismEquilibrium::actuator_forces`].
    pub actuator_forces: Table,
    /// Tangent stiffness of the tool, 36 numbers as in [`crate::batch::BatchStiffness`], NaN where it is infinite. Empty unless
    /// wanted.
    pub stiffness: Table,
    /// See [`Self::stability`]. Empty unless wanted: [`Details::Stability`].
    pub stability: Table,
    /// Outcome of each posture.
    pub status: Vec<Status>,
    /// Method by which each was found. Kernels find directly; with [`Details::Rest`] the scalar fallback does not
    /// record it, and it is [`FoundBy::Directly`] there too.
    pub found_by: Vec<FoundBy>,
    /// Engine that solves postures of this machine.
    pub engine: Engine,
}

/// Stability of an equilibrium, with its margins.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct PostureStability {
    /// Every limb keeps its shape and the platform its place, as [`MechanismEquilibrium::stable`].
    pub stable: bool,
    /// Force (N) per metre in the softest direction with the tool free to turn, as
    /// [`MechanismEquilibrium::stiffness_against_force`].
    pub stiffness_against_force: f64,
    /// Largest share of the way to buckling `mu` of all limbs, below 1 is stable, as
    /// [`MechanismEquilibrium::share_to_buckling`].
    pub share_to_buckling: Option<f64>,
}

/// Commanded poses of many postures, with the equilibria that they lead to.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct BatchTargets {
    /// Pose for which the machine is commanded, base from tool; NaN where
    /// `equilibrium.status` says [`Status::Unsolved`].
    pub targets: Vec<Pose>,
    /// The equilibrium of each, without stiffness and stability.
    pub equilibrium: BatchEquilibrium,
}

/// Requested details of the equilibria of many postures; each includes those before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Details {
    /// Tool poses, coordinates, wrenches and commands.
    Rest,
    /// The tangent stiffness at the tool, too.
    Stiffness,
    /// Stability, too, see [`BatchEquilibrium::stability`].
    Stability,
}

/// The answer of the general engine for one posture.
struct Scalar {
    target: Pose,
    tool: Pose,
    coordinates: Vec<f64>,
    commands: Vec<f64>,
    forces: Vec<f64>,
    stiffness: Vec<f64>,
    stability: Vec<f64>,
    found_by: FoundBy,
}

impl BatchEquilibrium {
    /// A command of a posture lies outside its actuator's limits.
    ///
    /// # Panics
    /// If the index is out of range, as for a slice.
    #[must_use]
    pub fn outside_limits(&self, mechanism: &Mechanism, posture: usize) -> bool {
        self.commands.outside_limits(mechanism, posture)
    }

    /// Room for so many postures; old numbers stay until they are written over.
    fn reset(&mut self, batch: &Batch, query: Details, count: usize) {
        let limbs = batch.mechanism.limbs();
        let coordinates = limbs.iter().map(|l| l.actual.coordinate_count()).sum();
        let commands = limbs.iter().map(|l| l.actual.actuators().len()).sum();
        let stiffness = if query >= Details::Stiffness { 36 } else { 0 };
        self.tool.reset(12, count);
        self.coordinates.reset(coordinates, count);
        self.commands.reset(commands, count);
        self.actuator_forces.reset(commands, count);
        self.stiffness.reset(stiffness, count);
        let stability = if query == Details::Stability { 3 } else { 0 };
        self.stability.reset(stability, count);
        self.engine = batch.engine();
        self.status.clear();
        self.status.resize(count, Status::Unsolved);
        self.found_by.clear();
        self.found_by.resize(count, FoundBy::Directly);
    }

    /// The stability of one posture; `None` if none was wanted or the posture was not found.
    ///
    /// # Panics
    /// If the index is out of range, as for a slice.
    #[must_use]
    pub fn stability(&self, posture: usize) -> Option<PostureStability> {
        if self.stability.width() == 0 || self.status[posture] == Status::Unsolved {
            return None;
        }
        let [stable, stiffness, share_to_buckling] =
            [0, 1, 2].map(|k| self.stability.get(posture, k));
        Some(PostureStability {
            stable: stable > 0.0,
            stiffness_against_force: stiffness,
            share_to_buckling: (!share_to_buckling.is_nan()).then_some(share_to_buckling),
        })
    }

    /// Takes the stability of all postures: stable (one or zero), stiffness, share to buckling or NaN.
    pub(crate) fn set_stabilities(&mut self, stabilities: &[[f64; 3]]) {
        self.stability.reset(3, stabilities.len());
        for (i, numbers) in stabilities.iter().enumerate() {
            self.stability.set_row(i, |k| numbers[k]);
        }
    }

    /// Pose of the tool of one posture, base from tool.
    ///
    /// # Panics
    /// If the index is out of range, as for a slice.
    #[must_use]
    pub fn tool_pose(&self, posture: usize) -> Pose {
        pose(&self.tool, posture)
    }

    fn tables(&mut self) -> [&mut Table; 6] {
        [
            &mut self.tool,
            &mut self.coordinates,
            &mut self.commands,
            &mut self.actuator_forces,
            &mut self.stiffness,
            &mut self.stability,
        ]
    }

    /// Takes one posture of another result of the same machine and question.
    fn take(&mut self, i: usize, other: &Self, from: usize) {
        let theirs = [
            &other.tool,
            &other.coordinates,
            &other.commands,
            &other.actuator_forces,
            &other.stiffness,
            &other.stability,
        ];
        for (own, theirs) in self.tables().into_iter().zip(theirs) {
            own.set_row(i, |k| theirs.get(from, k));
        }
        self.status[i] = other.status[from];
        self.found_by[i] = other.found_by[from];
    }

    fn set(&mut self, i: usize, answer: Option<&Scalar>) {
        let Some(answer) = answer else {
            for table in self.tables() {
                table.set_row(i, |_| f64::NAN);
            }
            return;
        };
        self.tool.set_row(i, numbers(&answer.tool));
        self.coordinates.set_row(i, |k| answer.coordinates[k]);
        self.commands.set_row(i, |k| answer.commands[k]);
        self.actuator_forces.set_row(i, |k| answer.forces[k]);
        self.stiffness.set_row(i, |k| answer.stiffness[k]);
        self.stability.set_row(i, |k| answer.stability[k]);
        self.status[i] = Status::Scalar;
        self.found_by[i] = answer.found_by;
    }
}

impl Scalar {
    fn resting(posture: &Posture, state: &MechanismState) -> Self {
        let mechanism = posture.mechanism();
        Self {
            target: *posture.target(),
            tool: state.platforms[mechanism.tool()],
            coordinates: state.coordinates.concat(),
            commands: posture.commands(),
            forces: forces(posture, state),
            stiffness: Vec::new(),
            stability: Vec::new(),
            found_by: FoundBy::Directly,
        }
    }

    fn with_stability(posture: &Posture, found: &MechanismEquilibrium) -> Self {
        let matrix = found.stiffness.finite_entries(&found.directions);
        Self {
            target: *posture.target(),
            tool: found.tool,
            coordinates: found.state.coordinates.concat(),
            commands: posture.commands(),
            forces: found.actuator_forces(),
            stiffness: (0..36).map(|k| matrix[(k / 6, k % 6)]).collect(),
            stability: vec![
                f64::from(u8::from(found.stable())),
                found.stiffness_against_force(),
                found.share_to_buckling().unwrap_or(f64::NAN),
            ],
            found_by: found.found_by,
        }
    }
}

/// Forces of the loads on the actuators at a state.
fn forces(posture: &Posture, state: &MechanismState) -> Vec<f64> {
    let mechanism = posture.mechanism();
    let limbs = mechanism.limbs().iter().enumerate();
    let own = limbs.flat_map(|(i, limb)| {
        let joints = &posture.limbs()[i];
        let base = &state.platforms[limb.from];
        let (at, commands) = (&joints.coordinates, &joints.commands);
        let mut system = System::new(&limb.actual, base, at, commands, limb.from != 0);
        system.evaluate(
            &limb.actual,
            base,
            at,
            commands,
            &mechanism.acting(i),
            &state.coordinates[i],
            &state.wrenches[i],
            1.0,
        );
        let first = limb.actual.coordinate_count();
        system.torque[first..first + limb.actual.actuators().len()].to_vec()
    });
    own.collect()
}

impl Batch {
    /// Equilibrium of the machine as it is, its tool commanded to `poses` and loaded by `wrenches`
    /// (one of each per posture; base axes, about the tool's origin).
    ///
    /// # Errors
    /// [`Error::Size`] if there are not as many wrenches as poses.
    pub fn equilibrium(
        &self,
        poses: &[Pose],
        wrenches: &[Wrench],
        details: Details,
    ) -> Result<BatchEquilibrium> {
        let mut out = BatchEquilibrium::default();
        self.equilibrium_into(poses, wrenches, details, &mut out)?;
        Ok(out)
    }

    /// Overwrites an existing result: a loop over blocks of postures allocates once.
    ///
    /// # Errors
    /// See [`Self::equilibrium`].
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Vector3, vector};
    /// # use kinetostat::*;
    /// # use kinetostat::batch::{Batch, BatchEquilibrium, Details};
    /// # let slide = |axis| ActuatorSpec::new(MotionKind::Prismatic, axis, 5e7); // N/m
    /// # let chain = Chain::builder("table")
    /// #     .actuator("x", slide(Vector3::x()))
    /// #     .actuator("y", slide(Vector3::y()))
    /// #     .build()?;
    /// # let table = Mechanism::serial(chain, Pose::identity(), Vector3::zeros())?;
    /// let batch = Batch::new(&table);
    /// let mut found = BatchEquilibrium::default();
    /// for block in 0..3 {
    ///     let at = |i: i32| Pose::translation(1e-3 * f64::from(100 * block + i), 0.2, 0.0); // m
    ///     let poses: Vec<Pose> = (0..100).map(at).collect();
    ///     let cutting = Wrench::new(vector![400.0, -250.0, 90.0], Vector3::zeros()); // N
    ///     batch.equilibrium_into(&poses, &vec![cutting; poses.len()], Details::Rest, &mut found)?;
    ///     for (i, pose) in poses.iter().enumerate() {
    ///         let gone = found.tool_pose(i).translation.vector - pose.translation.vector;
    ///         assert!((gone - vector![400.0, -250.0, 0.0] / 5e7).norm() < 1e-12, "the springs of its drives");
    ///     }
    /// }
    /// # Ok::<(), Error>(())
    /// ```
    pub fn equilibrium_into(
        &self,
        poses: &[Pose],
        wrenches: &[Wrench],
        details: Details,
        out: &mut BatchEquilibrium,
    ) -> Result<()> {
        self.loaded(&Places::Poses(poses), wrenches, details, out)
    }

    /// Solves a serial machine with its actuators commanded to `commands`.
    ///
    /// # Errors
    /// See [`Self::stiffness_at_joints`] and [`Self::equilibrium`].
    pub fn equilibrium_at_joints(
        &self,
        commands: &[f64],
        wrenches: &[Wrench],
        details: Details,
    ) -> Result<BatchEquilibrium> {
        let mut out = BatchEquilibrium::default();
        self.equilibrium_at_joints_into(commands, wrenches, details, &mut out)?;
        Ok(out)
    }

    /// Overwrites an existing result.
    ///
    /// # Errors
    /// See [`Self::equilibrium_at_joints`].
    pub fn equilibrium_at_joints_into(
        &self,
        commands: &[f64],
        wrenches: &[Wrench],
        details: Details,
        out: &mut BatchEquilibrium,
    ) -> Result<()> {
        self.loaded(&self.joints(commands)?, wrenches, details, out)
    }

    /// Compensation [R 7.7-7.13]: the poses to command so that the tool is at `poses` under
    /// `wrenches`, in the `directions` (base axes `x y z rx ry rz`) that are corrected, as
    /// [`target_under_load`] does; and where the tool is then.
    ///
    /// # Errors
    /// As [`Self::equilibrium`].
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Vector3, vector};
    /// # use kinetostat::*;
    /// # use kinetostat::batch::Batch;
    /// # let slide = |axis| ActuatorSpec::new(MotionKind::Prismatic, axis, 5e7); // N/m
    /// # let chain = Chain::builder("table")
    /// #     .actuator("x", slide(Vector3::x()))
    /// #     .actuator("y", slide(Vector3::y()))
    /// #     .build()?;
    /// # let table = Mechanism::serial(chain, Pose::identity(), Vector3::zeros())?;
    /// let poses: Vec<Pose> = (0..50).map(|i| Pose::translation(1e-3 * f64::from(i), 0.2, 0.0)).collect(); // m
    /// let forces = (0..50).map(|i| vector![400.0, -5.0 * f64::from(i), 90.0]); // N
    /// let wrenches: Vec<Wrench> = forces.map(|force| Wrench::new(force, Vector3::zeros())).collect();
    /// let plane = Directions::NONE.with(0).with(1);
    /// let answer = Batch::new(&table).targets_under_load(&poses, &wrenches, plane)?;
    /// for ((target, pose), wrench) in answer.targets.iter().zip(&poses).zip(&wrenches) {
    ///     let added = target.translation.vector - pose.translation.vector;
    ///     let (force, added) = (wrench.force().xy(), added.xy());
    ///     assert!((added + force / 5e7).norm() < 1e-12, "commanded against the force");
    /// }
    /// # Ok::<(), Error>(())
    /// ```
    pub fn targets_under_load(
        &self,
        poses: &[Pose],
        wrenches: &[Wrench],
        directions: Directions,
    ) -> Result<BatchTargets> {
        let places = Places::Poses(poses);
        self.as_many(&places, wrenches)?;
        let mut equilibrium = BatchEquilibrium::default();
        equilibrium.reset(self, Details::Rest, poses.len());
        let mut table = Table::default();
        table.reset(12, poses.len());
        // Rotations about some axes only do not add up: what they lead to depends on the way there.
        if (3..6).all(|k| directions[k] == directions[3]) {
            let wanted = Some(directions);
            let [tips, correctors] = &mut [(); 2].map(|()| Table::none(poses.len()));
            let beside = [&mut table, tips, correctors];
            self.solved(&places, wrenches, wanted, &mut equilibrium, beside);
        }
        let mut targets = poses.to_vec();
        for i in 0..poses.len() {
            if equilibrium.status[i] == Status::Vectorised {
                if directions[3] {
                    targets[i] = pose(&table, i);
                } else {
                    let place = nalgebra::Vector3::from_fn(|k, _| table.get(i, 9 + k));
                    targets[i].translation.vector = place;
                }
            }
        }
        let scalar = |i: usize| {
            let near = self.posture(&places, i)?;
            let state = near.rest_state();
            let (posture, state) =
                target_under_load(&near, &poses[i], &wrenches[i], directions, state)?;
            Ok(Scalar::resting(&posture, &state))
        };
        let nowhere = Pose::translation(f64::NAN, f64::NAN, f64::NAN);
        for (i, answer) in left(&equilibrium.status, scalar) {
            equilibrium.set(i, answer.as_ref());
            targets[i] = answer.map_or(nowhere, |a| a.target);
        }
        Ok(BatchTargets {
            targets,
            equilibrium,
        })
    }

    /// Kernels see all that a stability depends on: a redundant passive joint, which they lock, may be
    /// pushed out of line.
    fn stability_by_kernels(&self) -> bool {
        let whole = |plan: &Plan| plan.passive.len() + springs(plan) == plan.coordinates;
        self.actual
            .as_ref()
            .is_ok_and(|plans| plans.iter().all(whole))
    }

    /// Solves those postures that kernels can. Beside the equilibria: where they are commanded (12 numbers as of the tool),
    /// the wrenches on the tips of all limbs, and what corrects a pass there, each only where its table has columns.
    fn vectorised(
        &self,
        places: &Places<'_>,
        wrenches: &[Wrench],
        directions: Option<Directions>,
        out: &mut BatchEquilibrium,
        [targets, tips, correctors]: [&mut Table; 3],
    ) {
        let (Ok(nominal), Ok(actual)) = (&self.nominal, &self.actual) else {
            return;
        };
        let tool = &self.mechanism.platforms()[self.mechanism.tool()];
        let precision = match (self.along, places.have_a_start()) {
            (true, _) => ALONG_PATH,
            (false, true) => FROM_DRAWN,
            (false, false) => EXACT,
        };
        // Only the first posture of each lane's run on a path has no start from its neighbour.
        let blocks = if self.along { BLOCKS } else { LOADED_BLOCKS };
        let mut tables = [
            &mut out.tool,
            &mut out.coordinates,
            &mut out.commands,
            &mut out.actuator_forces,
            &mut out.stiffness,
            &mut out.stability,
            targets,
            tips,
            correctors,
        ]
        .map(|table| table.parts(blocks));
        let parts = out.status.chunks_mut(BLOCK * blocks).enumerate();
        let jobs = parts.map(|(k, status)| {
            let next = [0, 1, 2, 3, 4, 5, 6, 7, 8].map(|i| tables[i].next().unwrap_or_default());
            let [
                tool_out,
                coordinates,
                commands,
                forces,
                stiffness,
                stability,
                targets,
                tips,
                correctors,
            ] = next;
            Job::Loaded {
                nominal,
                actual,
                body: PlatformMass {
                    centre: tool.centre_of_mass.into(),
                    mass: tool.mass,
                },
                gravity: self.mechanism.gravity().into(),
                places: places.from(k * blocks * BLOCK),
                wrenches: &wrenches[k * blocks * BLOCK..],
                directions,
                along: self.along,
                precision,
                buffers: &self.buffers,
                answers: Answers {
                    tool: tool_out,
                    coordinates,
                    commands,
                    forces,
                    stiffness,
                    stability,
                    targets,
                    wrenches: tips,
                    correctors,
                    status,
                },
            }
        });
        in_parallel(jobs, places.len());
    }

    /// Leaves to the general engine what may be rigid in a direction, which it names.
    fn leave_nearly_rigid(&self, out: &mut BatchEquilibrium) {
        let length = self.mechanism.scale().length;
        let unit = |k: usize| if k % 6 < 3 { 1.0 } else { length };
        for (i, status) in out.status.iter_mut().enumerate() {
            if out.stiffness.width() == 0 || *status != Status::Vectorised {
                continue;
            }
            let scaled =
                Matrix6::from_fn(|r, c| out.stiffness.get(i, 6 * r + c) / (unit(r) * unit(c)));
            let diagonal = scaled.diagonal();
            if diagonal.max() > 1e-2 * NEARLY_RIGID_SPREAD * diagonal.min() {
                let values = (0.5 * (scaled + scaled.transpose())).symmetric_eigenvalues();
                let positive = values.iter().copied().filter(|x| *x > 0.0);
                if values.max() > NEARLY_RIGID_SPREAD * positive.fold(f64::INFINITY, smaller) {
                    *status = Status::Unsolved;
                }
            }
        }
    }

    /// Solves those postures that kernels can, as [`Self::vectorised`]; along a path, where most runs find no way from home to
    /// their first posture (half a turn of a wrist away), from what the general engine finds there.
    fn solved(
        &self,
        places: &Places<'_>,
        wrenches: &[Wrench],
        directions: Option<Directions>,
        out: &mut BatchEquilibrium,
        mut beside: [&mut Table; 3],
    ) {
        let [targets, tips, correctors] = &mut beside;
        self.vectorised(
            places,
            wrenches,
            directions,
            out,
            [targets, tips, correctors],
        );
        let left = out.status.iter().filter(|s| **s != Status::Vectorised);
        let (Places::Poses(poses), true, Ok(nominal)) = (places, self.along, &self.nominal) else {
            return;
        };
        if 2 * left.count() <= poses.len() {
            return;
        }
        let mut joints = Table::default();
        let width = nominal.iter().map(|p| p.commands + p.passive.len()).sum();
        joints.reset(width, poses.len());
        for (job, part) in poses.chunks(BLOCKS * BLOCK).enumerate() {
            for k in (0..part.len()).step_by(part.len().div_ceil(BLOCK)) {
                let posture = self.mechanism.posture(&part[k]).ok();
                let numbers = posture.map(|posture| joints_of(nominal, &posture));
                joints.set_row(job * BLOCKS * BLOCK + k, |i| {
                    numbers.as_ref().map_or(f64::NAN, |own| own[i])
                });
            }
        }
        let begun = Places::Known {
            poses,
            joints: &joints,
            standing: None,
            deviations: &[],
            first: 0,
        };
        self.vectorised(&begun, wrenches, directions, out, beside);
    }

    fn as_many(&self, places: &Places<'_>, wrenches: &[Wrench]) -> Result<()> {
        if wrenches.len() == places.len() {
            return Ok(());
        }
        Err(Error::Size {
            place: self.mechanism.place(),
            what: "wrenches",
            expected: places.len(),
            found: wrenches.len(),
        })
    }

    /// Equilibria that kernels find; the tool's numbers are NaN where they find nothing.
    pub(crate) fn standing(&self, places: &Places<'_>, wrenches: &[Wrench]) -> Result<Standing> {
        self.as_many(places, wrenches)?;
        let count = places.len();
        let mut out = BatchEquilibrium::default();
        out.reset(self, Details::Rest, count);
        let (mut tips, mut correctors) = (Table::default(), Table::default());
        tips.reset(6 * self.mechanism.limbs().len(), count);
        let width = self.actual.as_ref().map_or(0, |actual| kept::width(actual));
        correctors.reset(width, count);
        let beside = [&mut Table::none(count), &mut tips, &mut correctors];
        self.vectorised(places, wrenches, None, &mut out, beside);
        for i in 0..count {
            if out.status[i] != Status::Vectorised {
                out.tool.set_row(i, |_| f64::NAN);
            }
        }
        Ok(Standing {
            tool: out.tool,
            coordinates: out.coordinates,
            wrenches: tips,
            correctors,
            slopes: Vec::new(),
        })
    }

    /// Solves those that kernels left over from the start that was known, once more from the unloaded machine.
    fn once_more(
        &self,
        places: &Places<'_>,
        wrenches: &[Wrench],
        query: Details,
        out: &mut BatchEquilibrium,
    ) -> Result<()> {
        let Places::Known { poses, .. } = places else {
            return Ok(());
        };
        let all = 0..poses.len();
        let left: Vec<usize> = all
            .filter(|i| out.status[*i] != Status::Vectorised)
            .collect();
        if left.is_empty() {
            return Ok(());
        }
        let poses: Vec<Pose> = left.iter().map(|i| poses[*i]).collect();
        let wrenches: Vec<Wrench> = left.iter().map(|i| wrenches[*i]).collect();
        let mut found = BatchEquilibrium::default();
        self.loaded(&Places::Poses(&poses), &wrenches, query, &mut found)?;
        for (from, to) in left.into_iter().enumerate() {
            out.take(to, &found, from);
        }
        Ok(())
    }

    /// [`Posture::deflected_by`] for a posture of this machine, with its stability, by kernels alone: none where these do not decide it.
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Vector3, vector};
    /// # use kinetostat::{ActuatorSpec, Chain, Mechanism, MotionKind, Pose, Wrench, batch::Batch};
    /// # let slide = ActuatorSpec::new(MotionKind::Prismatic, Vector3::x(), 5e7); // N/m
    /// # let chain = Chain::builder("rail").actuator("x", slide).build()?;
    /// # let rail = Mechanism::serial(chain, Pose::identity(), Vector3::zeros())?;
    /// let pushed = Wrench::new(vector![500.0, 0.0, 0.0], Vector3::zeros()); // N
    /// let posture = rail.posture(&Pose::translation(0.1, 0.0, 0.0))?;
    /// if let Some(found) = Batch::new(&rail).deflected(&posture, &pushed) {
    ///     assert!((found.tool_pose(0).translation.x - 0.1 - 500.0 / 5e7).abs() < 1e-12);
    /// }
    /// # Ok::<(), kinetostat::Error>(())
    /// ```
    #[must_use]
    pub fn deflected(&self, posture: &Posture, wrench: &Wrench) -> Option<BatchEquilibrium> {
        let nominal = self.nominal.as_ref().ok()?;
        if !posture.others.is_empty() || !self.stability_by_kernels() {
            return None;
        }
        let numbers = joints_of(nominal, posture);
        let mut joints = Table::default();
        joints.reset(numbers.len(), 1);
        joints.set_row(0, |k| numbers[k]);
        let places = Places::Known {
            poses: &[posture.target],
            joints: &joints,
            standing: None,
            deviations: &[],
            first: 0,
        };
        let mut out = BatchEquilibrium::default();
        out.reset(self, Details::Stability, 1);
        let mut beside = [(); 3].map(|()| Table::none(1));
        self.vectorised(&places, &[*wrench], None, &mut out, beside.each_mut());
        self.leave_nearly_rigid(&mut out);
        (out.status == [Status::Vectorised]).then_some(out)
    }

    pub(crate) fn loaded(
        &self,
        places: &Places<'_>,
        wrenches: &[Wrench],
        query: Details,
        out: &mut BatchEquilibrium,
    ) -> Result<()> {
        self.as_many(places, wrenches)?;
        out.reset(self, query, places.len());
        if query != Details::Stability || self.stability_by_kernels() {
            let mut beside = [(); 3].map(|()| Table::none(places.len()));
            self.solved(places, wrenches, None, out, beside.each_mut());
            self.leave_nearly_rigid(out);
            if places.have_a_start() {
                return self.once_more(places, wrenches, query, out);
            }
        }
        let scalar = |i: usize| {
            let posture = self.posture(places, i)?;
            if query == Details::Rest {
                let state = posture.rest_under(&wrenches[i], posture.rest_state())?;
                return Ok(Scalar::resting(&posture, &state));
            }
            let found = posture.deflected_by(&wrenches[i])?;
            Ok(Scalar::with_stability(&posture, &found))
        };
        for (i, answer) in left(&out.status, scalar) {
            out.set(i, answer.as_ref());
        }
        Ok(())
    }
}

/// Commands and passive joints of a posture, limb after limb, as [`Places::Known`] has them.
fn joints_of(nominal: &[Plan], posture: &Posture) -> Vec<f64> {
    let limbs = nominal.iter().zip(posture.limbs());
    let each = limbs.flat_map(|(plan, own)| {
        let passive = plan.passive.iter().map(|i| own.coordinates[*i]);
        own.commands.iter().copied().chain(passive)
    });
    each.collect()
}

/// The 12 numbers of a pose.
fn numbers(pose: &Pose) -> impl Fn(usize) -> f64 + use<> {
    let (r, p) = (pose.rotation.to_rotation_matrix(), pose.translation.vector);
    move |k| if k < 9 { r[(k / 3, k % 3)] } else { p[k - 9] }
}

/// A pose among 12 numbers each.
pub(crate) fn pose(table: &Table, i: usize) -> Pose {
    let rotation = nalgebra::Matrix3::from_fn(|r, c| table.get(i, 3 * r + c));
    let place = nalgebra::Vector3::from_fn(|k, _| table.get(i, 9 + k));
    // Rounding of a rotation matrix, not a search for the nearest rotation.
    let rotation = nalgebra::Rotation3::from_matrix_unchecked(rotation);
    Pose::from_parts(place.into(), rotation.into())
}
