//! Unloaded stiffness of many postures, and tool poses of a serial machine at given commands.

use crate::batch::compiled::{BLOCKS, Batch, in_parallel, left};
use crate::batch::equilibria::pose;
use crate::batch::machine::group::Places;
use crate::batch::machine::loaded::MOST_COMMAND;
use crate::batch::run::Job;
use crate::batch::status::{Engine, Status};
use crate::batch::table::{BLOCK, Table};
use crate::error::Result;
use crate::machine::posture::Posture;
use crate::model::kinematics::Kinematics;
use crate::model::mechanism::Mechanism;
use crate::spatial::Pose;

/// Unloaded stiffness of many postures.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct BatchStiffness {
    /// Cartesian stiffness of the tool at its origin, base axes, 36 numbers row by row (N/m, N/rad,
    /// N m/m, N m/rad), as [`crate::CartesianStiffness::finite_entries`]: NaN where it is infinite.
    pub stiffness: Table,
    /// Jacobian of a serial machine, 6 x n row by row: twist of the tool (m, rad, base axes, at its
    /// origin) per unit of every coordinate. Empty unless requested.
    pub jacobian: Table,
    /// Commands of all actuators (m, rad), in the mechanism's order, as [`Posture::commands`]. Empty
    /// where they were given.
    pub commands: Table,
    /// Outcome of each posture.
    pub status: Vec<Status>,
    /// Engine that solves postures of this machine.
    pub engine: Engine,
}

impl BatchStiffness {
    /// A command of a posture lies outside its actuator's limits.
    ///
    /// # Panics
    /// If the index is out of range, as for a slice.
    #[must_use]
    pub fn outside_limits(&self, mechanism: &Mechanism, posture: usize) -> bool {
        self.commands.outside_limits(mechanism, posture)
    }
}

impl Batch {
    /// Stiffness of the unloaded machine as drawn with the tool at each of the poses.
    #[must_use]
    pub fn stiffness(&self, poses: &[Pose]) -> BatchStiffness {
        let mut out = BatchStiffness::default();
        self.stiffness_into(poses, &mut out);
        out
    }

    /// Overwrites an existing result: a loop over blocks of postures allocates once.
    pub fn stiffness_into(&self, poses: &[Pose], out: &mut BatchStiffness) {
        self.unloaded(&Places::Poses(poses), false, out);
    }

    /// Stiffness of a serial machine with its actuators commanded to `commands` (m or rad, one after the other for each
    /// posture).
    ///
    /// # Errors
    /// [`Error::Size`](crate::Error::Size) if the numbers are no whole postures, [`Error::Model`](crate::Error::Model) for a machine of
    /// several limbs or with passive joints.
    pub fn stiffness_at_joints(&self, commands: &[f64]) -> Result<BatchStiffness> {
        let mut out = BatchStiffness::default();
        self.stiffness_at_joints_into(commands, &mut out)?;
        Ok(out)
    }

    /// Overwrites an existing result.
    ///
    /// # Errors
    /// See [`Self::stiffness_at_joints`].
    pub fn stiffness_at_joints_into(
        &self,
        commands: &[f64],
        out: &mut BatchStiffness,
    ) -> Result<()> {
        self.unloaded(&self.joints(commands)?, false, out);
        Ok(())
    }

    /// Solves like [`Self::stiffness_at_joints`], with the Jacobian of the tool by the coordinates.
    ///
    /// # Errors
    /// See [`Self::stiffness_at_joints`].
    pub fn stiffness_and_jacobian(&self, commands: &[f64]) -> Result<BatchStiffness> {
        let mut out = BatchStiffness::default();
        self.stiffness_and_jacobian_into(commands, &mut out)?;
        Ok(out)
    }

    /// Overwrites an existing result.
    ///
    /// # Errors
    /// See [`Self::stiffness_at_joints`].
    pub fn stiffness_and_jacobian_into(
        &self,
        commands: &[f64],
        out: &mut BatchStiffness,
    ) -> Result<()> {
        self.unloaded(&self.joints(commands)?, true, out);
        Ok(())
    }

    fn unloaded(&self, places: &Places<'_>, jacobian: bool, out: &mut BatchStiffness) {
        let count = places.len();
        let coordinates = self.mechanism.limbs()[0].nominal.coordinate_count();
        let width = if jacobian { 6 * coordinates } else { 0 };
        out.stiffness.reset(36, count);
        out.jacobian.reset(width, count);
        // Commands that were given are known.
        let commands = match places {
            Places::Poses(_) | Places::Known { .. } => self.commands(),
            Places::Joints { .. } => 0,
        };
        out.commands.reset(commands, count);
        out.engine = self.engine_unloaded();
        out.status.clear();
        out.status.resize(count, Status::Unsolved);
        if let Ok(nominal) = &self.nominal {
            let parts = out.stiffness.parts(BLOCKS);
            let jobs = parts
                .zip(out.jacobian.parts(BLOCKS))
                .zip(out.commands.parts(BLOCKS))
                .zip(out.status.chunks_mut(BLOCK * BLOCKS))
                .enumerate()
                .map(
                    |(k, (((stiffness, jacobian), commands), status))| Job::Unloaded {
                        plans: nominal,
                        buffers: &self.buffers,
                        places: places.from(k * BLOCKS * BLOCK),
                        stiffness,
                        jacobian,
                        commands,
                        status,
                    },
                );
            in_parallel(jobs, count);
        }
        let scalar = |i: usize| {
            let posture = self.posture(places, i)?;
            let found = posture.stiffness()?;
            let columns = jacobian.then(|| self.jacobian(&posture));
            let entries = found.cartesian.finite_entries(&found.directions);
            Ok((entries, columns, posture.commands()))
        };
        for (i, answer) in left(&out.status, scalar) {
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
            out.status[i] = Status::Scalar;
        }
    }

    /// Jacobian of a serial machine as drawn, unloaded, at the tool's origin.
    fn jacobian(&self, posture: &Posture) -> nalgebra::Matrix6xX<f64> {
        let limb = &self.mechanism.limbs()[0];
        let (base, own) = (
            &self.mechanism.platforms()[limb.from].home,
            &posture.limbs()[0],
        );
        let (x, commands) = (&own.coordinates, &own.commands);
        let at = Kinematics::new(&limb.nominal, base, x, commands);
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
}

impl Batch {
    /// Poses of the tool, base from tool, that `commands` lead a serial machine as it is drawn to, one row of commands after the
    /// other (m, rad). A row that leads nowhere has a pose of NaN.
    ///
    /// ```
    /// # use kinetostat::nalgebra::Vector3;
    /// # use kinetostat::*;
    /// # use kinetostat::batch::Batch;
    /// # let slide = |axis| ActuatorSpec::new(MotionKind::Prismatic, axis, 5e7); // N/m
    /// # let chain = Chain::builder("table")
    /// #     .actuator("x", slide(Vector3::x()))
    /// #     .actuator("y", slide(Vector3::y()))
    /// #     .build()?;
    /// # let table = Mechanism::serial(chain, Pose::identity(), Vector3::zeros())?;
    /// let found = Batch::new(&table).targets_at_joints(&[0.1, 0.2, 0.3, -0.4])?;
    /// assert_eq!(found[1].translation, Pose::translation(0.3, -0.4, 0.0).translation);
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`Self::stiffness_at_joints`].
    pub fn targets_at_joints(&self, commands: &[f64]) -> Result<Vec<Pose>> {
        let places = self.joints(commands)?;
        let count = places.len();
        let mut table = Table::default();
        let by_kernels = self.nominal.is_ok();
        if let Ok(nominal) = &self.nominal {
            table.reset(12, count);
            let each = BLOCKS * BLOCK * nominal[0].commands;
            let parts = table.parts(BLOCKS).zip(commands.chunks(each));
            let jobs = parts.map(|(targets, commands)| Job::Targets {
                plan: &nominal[0],
                commands,
                targets,
            });
            in_parallel(jobs, count);
        }
        let each = self.commands();
        let nowhere = Pose::translation(f64::NAN, f64::NAN, f64::NAN);
        let target = |i: usize| {
            let own = &commands[i * each..(i + 1) * each];
            if by_kernels && own.iter().all(|x| x.abs() < MOST_COMMAND) {
                return pose(&table, i);
            }
            let posture = self.posture(&Places::Joints { commands, each }, i);
            posture.map_or(nowhere, |posture| *posture.target())
        };
        Ok((0..count).map(target).collect())
    }
}
