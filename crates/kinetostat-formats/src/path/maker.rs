//! Motions of a program in the axes of its path.

use std::sync;

use kinetostat_program::RotaryAxes;
use nalgebra::{Isometry3, UnitQuaternion, Vector3};

use crate::model::motion::{Motion, MotionKind};
use crate::model::program::RobotProgram;
use crate::model::target::Target;
use crate::path::axis_angles::{AxesOfMotion, axes_of_motions};
use crate::path::axis_turns::axis_turns;
use crate::path::fault::{PathError, fault_at};
use crate::path::options::PathOptions;

/// The motions of a program, and what their moves need beside them.
pub(super) struct Maker<'a> {
    pub program: &'a RobotProgram,
    pub options: &'a PathOptions,
    /// Poses in the axes of the robot's base.
    pub in_base: bool,
    /// Orientation at the end of every motion, in axes of the path, if the program states a leaning tool axis alone.
    pub turns: Option<Vec<Option<UnitQuaternion<f64>>>>,
    /// Alternative to `turns`: motion of the machine's rotary axes.
    pub rotary: Option<(sync::Arc<RotaryAxes>, Vec<Option<AxesOfMotion>>)>,
    /// Direction from the tip to the holder, in axes of the tool.
    pub tool_axis: Vector3<f64>,
}

impl<'a> Maker<'a> {
    /// Maker for a program with one work object, or in the axes of the robot's base; `leaning` is the first motion whose tool leans, if the program
    /// states the tool axis alone, or angles of rotary axes.
    pub(super) fn of(
        program: &'a RobotProgram,
        options: &'a PathOptions,
        in_base: bool,
        leaning: Option<&Motion>,
    ) -> Result<Self, Vec<PathError>> {
        let mut maker = Self {
            program,
            options,
            in_base,
            turns: None,
            rotary: None,
            tool_axis: options.tool_axis,
        };
        let Some(leaning) = leaning else {
            return Ok(maker);
        };
        let is_rapid = |motion: &Motion| maker.is_rapid(motion);
        match &options.rotary {
            Some(_) if in_base => {
                let reason = "rotary axes of the machine turn the tool, and the program has several work objects";
                let remedy = "write one program for each work object";
                return Err(vec![fault_at(program, leaning, reason.to_owned(), remedy)]);
            }
            Some(rotary) => {
                let angles = axes_of_motions(program, rotary, is_rapid)?;
                maker.rotary = Some((sync::Arc::clone(rotary), angles));
                maker.tool_axis = rotary.tool_at_zero.inverse() * Vector3::z();
            }
            None => {
                let frame = |motion: &Motion| maker.frame_in_path(motion);
                maker.turns = Some(axis_turns(
                    program,
                    options.turn_about_axis,
                    options.tool_axis,
                    frame,
                    is_rapid,
                )?);
            }
        }
        Ok(maker)
    }

    /// Transformation from the axes of a motion's work object to those of the path.
    pub(super) fn frame_in_path(&self, motion: &Motion) -> Isometry3<f64> {
        match (self.in_base, motion.work_object.known()) {
            (true, Some(frame)) => *frame,
            _ => Isometry3::identity(),
        }
    }

    pub(super) fn pose_in_path(&self, motion: &Motion, target: &Target) -> Option<Isometry3<f64>> {
        Some(self.frame_in_path(motion) * target.pose()?.isometry())
    }

    /// Pose at the end of a motion; `None` if the end or the path to it is unknown.
    pub(super) fn end_in_path(&self, index: usize) -> Option<Isometry3<f64>> {
        let motion = &self.program.motions[index];
        if !motion.has_known_way() {
            return None;
        }
        let mut end = self.pose_in_path(motion, &motion.target)?;
        if let Some(turn) = self.turns.as_ref().and_then(|turns| turns[index]) {
            end.rotation = turn;
        }
        Some(end)
    }

    /// True if a motion positions the tool in air.
    pub(super) fn is_rapid(&self, motion: &Motion) -> bool {
        let fast = |limit: f64| {
            let fastest = motion.speed.text.eq_ignore_ascii_case("vmax");
            fastest || motion.speed.mm_per_s.is_some_and(|speed| speed >= limit)
        };
        // APT says it beside the motion, a machine's control in it.
        let said = self.program.language.is_rapid(&motion.speed.text);
        motion.kind == MotionKind::Joint
            || !motion.has_known_way()
            || said
            || self.options.rapid_from_mm_per_s.is_some_and(fast)
    }
}
