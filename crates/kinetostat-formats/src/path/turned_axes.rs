//! Angles of rotary axes whose words say how the tool stands, and their correction.
//!
//! A correction turns the tool; the axes turn so that it lies where it is wanted, and the turn about the tool is free: the law of
//! G-code under G43.4.

use kinetostat_program::{
    Knowledge, Move, Path, Plan, PlannedPiece, RotaryTurn, StatedBy, WriteError as PathWriteError,
};
use nalgebra::Vector3;

use crate::path::fault::broken;

/// Axes of the tool nearer than this are one, rad.
const SAME_AXIS: f64 = 1e-9;

/// Angles as written may be off by so much, deg: Heidenhain programs have four digits.
const WRITTEN_DEG: f64 = 1e-4;

/// Rotary motion of a move that states the angles.
pub(crate) fn by_angles(motion: &Move) -> Option<&RotaryTurn> {
    let rotary = motion.tool_turn.as_ref()?.rotary.as_ref()?;
    (rotary.stated == StatedBy::Angles).then_some(rotary)
}

/// The angles at the end of a piece, deg: those of the program, or as the tool is turned there.
pub(crate) fn angles_of_piece(
    tool_axis: &Vector3<f64>,
    turn: &RotaryTurn,
    piece: &PlannedPiece,
) -> Vec<f64> {
    let own = turn.angles_deg(piece.share_to);
    let stands = turn.axes.tool_direction_at(&own, tool_axis);
    let Some(wanted) = piece.orientation.map(|turned| turned * tool_axis) else {
        return own;
    };
    match wanted.angle(&stands) < SAME_AXIS {
        true => own,
        false => turn.axes.angles_near(&wanted, tool_axis, &own).angles_deg,
    }
}

/// The angles of a piece that was read again; none of a motion that does not state them.
pub(crate) fn angles_as_written(
    path: &Path,
    index: usize,
    made: &Move,
    piece: &PlannedPiece,
) -> Result<Vec<f64>, PathWriteError> {
    let motion = &path.moves[index];
    let Some(turn) = by_angles(motion) else {
        return Ok(Vec::new());
    };
    let lost = || {
        let what = "the angles of its rotary axes are not known".to_owned();
        broken(motion.line, made.line, what)
    };
    let stands = by_angles(made).ok_or_else(lost)?;
    let wanted = angles_of_piece(&path.tool_axis, turn, piece);
    let both = stands.end_deg.iter().zip(&wanted);
    // Not a number is off, too.
    let near = both
        .into_iter()
        .all(|(is, wanted)| (is - wanted).abs() <= WRITTEN_DEG);
    match near && stands.end_deg.len() == wanted.len() {
        true => Ok(stands.end_deg.clone()),
        false => Err(broken(
            motion.line,
            made.line,
            "its rotary axes stand otherwise than was to be written".to_owned(),
        )),
    }
}

/// Refuses the loss of corrected angles: after such a cut, a rapid must restore the axes before a motion that does not account for them.
pub(crate) fn refuse_lost_turn(path: &Path, plan: &Plan<'_>) -> Result<(), PathWriteError> {
    let mut turned = false;
    for (motion, planned) in path.moves.iter().zip(plan.moves()) {
        let stated = by_angles(motion).filter(|_| motion.known != Knowledge::Nothing);
        let Some((turn, piece)) = stated.zip(planned.pieces.last()) else {
            if turned {
                return Err(PathWriteError::Motion {
                    line: motion.line,
                    reason: "the angles of the rotary axes are corrected up to here, and tool centre point control ends, or the place is not known, right behind the cut".to_owned(),
                    remedy: "let a rapid that retracts the tool stand between, or correct the position alone".to_owned(),
                });
            }
            continue;
        };
        turned = angles_of_piece(&path.tool_axis, turn, piece) != turn.angles_deg(piece.share_to);
    }
    Ok(())
}
