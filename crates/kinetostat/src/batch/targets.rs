//! Tool poses of a serial machine as it is drawn, at given commands.

use crate::batch::compiled::{BLOCKS, Batch, in_parallel};
use crate::batch::equilibria::pose;
use crate::batch::machine::group::Places;
use crate::batch::machine::loaded::MOST_COMMAND;
use crate::batch::run::Job;
use crate::batch::table::{BLOCK, Table};
use crate::error::Result;
use crate::spatial::Pose;

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
