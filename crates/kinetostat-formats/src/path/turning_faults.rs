//! Motions in which the tool turns otherwise than a move of a path does, by line.

use crate::model::motion::{Motion, MotionKind};
use crate::model::program::RobotProgram;
use crate::model::site::not_evenly;
use crate::path::fault::{PathError, fault_at};

/// All motions whose tool turns, and not evenly. Where a motion begins at no known pose it has no way in a path, either.
pub(crate) fn turning_otherwise(program: &RobotProgram) -> Vec<PathError> {
    let fault = |motion: &Motion| {
        let otherwise = motion.site.turns_otherwise?;
        if motion.kind == MotionKind::Joint {
            return None;
        }
        let start = program.motions.get(motion.follows?)?;
        let frames = [start, motion].map(|motion| motion.work_object.known().copied());
        let [from, to] = [start, motion].map(|motion| Some(motion.target.pose()?.isometry()));
        let (from, to) = (from?, to?);
        let turn = match frames {
            [Some(before), Some(here)] => {
                (before.rotation * from.rotation).angle_to(&(here.rotation * to.rotation))
            }
            _ => from.rotation.angle_to(&to.rotation),
        };
        let reason = not_evenly("the tool turns", turn, otherwise)?;
        Some(fault_at(program, motion, reason, otherwise.remedy))
    };
    program.motions.iter().filter_map(fault).collect()
}
