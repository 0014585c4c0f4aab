//! Motions of a robot's program that no other program can be made of.

use kinetostat_program::Knowledge;

use crate::making::fault::MakeError;
use crate::model::motion::{MotionKind, Runs};
use crate::model::program::RobotProgram;
use crate::path::of_program::RobotPath;

/// Motions that do not run exactly once.
pub(crate) fn not_once(program: &RobotProgram) -> Vec<MakeError> {
    let others = program
        .motions
        .iter()
        .filter(|motion| motion.runs != Runs::Once);
    let mut faults: Vec<MakeError> = others
        .map(|motion| {
            let reason = match motion.runs {
                Runs::OnCondition => "the motion is in a branch, or behind what may end the program or its routine before: whether it runs is not known",
                Runs::Elsewhere => "nothing in these files leads to this motion: it never runs (its routine is not called, a jump leaves it out, or the program ends before)",
                _ => "the motion is in a loop, or in a routine that is called more than once",
            };
            MakeError::at(
                motion.line,
                reason,
                "write its motions one after another, or take them out",
            )
        })
        .collect();
    faults.sort_by_key(|fault| fault.line);
    // A statement that runs several times gives several motions.
    faults.dedup();
    faults
}

/// Arcs whose way is not known: it depends on where they begin.
pub(crate) fn arcs_from_elsewhere(program: &RobotProgram, robot: &RobotPath) -> Vec<MakeError> {
    let moves = robot.path.moves.iter().zip(&robot.motions);
    let known = moves.filter(|(own, _)| own.known != Knowledge::Nothing);
    // To the first place the arm goes from wherever it is.
    let arcs = known.skip(1).filter(|(own, motion)| {
        let is_arc = program.motions.get(**motion).is_some_and(|motion| {
            matches!(
                motion.kind,
                MotionKind::Circular { .. } | MotionKind::Arc { .. }
            )
        });
        own.known == Knowledge::End && is_arc
    });
    arcs.map(|(own, _)| {
        MakeError::at(
            own.line,
            "where this arc begins, or the place on it, is not known: behind a routine that is not in these files, or a place that only the run knows",
            "write a motion to a stated place before the arc, or give the routine with the program",
        )
    })
    .collect()
}
