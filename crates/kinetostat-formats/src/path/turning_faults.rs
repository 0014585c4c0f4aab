//! Motions in which the tool turns otherwise than a move of a path does, by line.

use crate::model::motion::{Motion, MotionKind};
use crate::model::program::RobotProgram;
use crate::path::fault::{PathError, fault_at};

/// Turns below this are none, rad.
pub(crate) const TURN_RAD: f64 = 1e-5;

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
        // NaN is no small turn.
        let is_none = turn < TURN_RAD;
        (!is_none).then(|| {
            let reason = format!(
                "the tool turns by {:.3} deg, and {}",
                turn.to_degrees(),
                otherwise.reason
            );
            fault_at(program, motion, reason, otherwise.remedy)
        })
    };
    program.motions.iter().filter_map(fault).collect()
}
