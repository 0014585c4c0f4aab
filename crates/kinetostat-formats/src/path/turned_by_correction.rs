//! Angles of rotary axes whose words say how the tool stands, and corrections that would turn the tool in motions in which it does not turn
//! evenly: these are refused before anything is written.
//!
//! Reading refuses such motions where the program turns the tool ([`crate::path`]); what is written has to pass the
//! same question.

use kinetostat_program::{
    Knowledge, Move, Path, Plan, PlannedMove, PlannedPiece, RotaryTurn, StatedBy,
    WriteError as PathWriteError,
};
use nalgebra::{UnitQuaternion, Vector3};

use crate::model::motion::{Motion, MotionKind};
use crate::model::program::RobotProgram;
use crate::model::site::{TurnsOtherwise, not_evenly};
use crate::path::broken;
use crate::path::of_program::RobotPath;
use crate::text::number::in_words;
use crate::writing::divided::SAME_RAD;

/// The first motion that a correction turns and whose tool would stand otherwise between its ends, with the lines of all.
pub(crate) fn refuse_lost_orientation(
    program: &RobotProgram,
    path: &RobotPath,
    plan: &Plan<'_>,
) -> Result<(), PathWriteError> {
    let mut found: Vec<(usize, String, &str)> = Vec::new();
    let mut before: Option<(usize, Option<UnitQuaternion<f64>>)> = None;
    for ((number, own), planned) in path.motions.iter().zip(&path.path.moves).zip(plan.moves()) {
        let Some(motion) = program.motions.get(*number) else {
            continue;
        };
        let start = before.filter(|(before, _)| motion.follows == Some(*before));
        let start = start.and_then(|(_, orientation)| orientation);
        before = Some((*number, planned.pieces.last().and_then(|p| p.orientation)));
        let Some(otherwise) = motion.site.turns_otherwise else {
            continue;
        };
        match otherwise.evenly {
            Some(_) if stays_circle(motion, planned) => {
                if ends_turned(own.orientation(1.0), planned)
                    && let Some(why) = turns_others(program)
                {
                    let remedy = "write CirPathMode\\ObjectFrame before this circle where the others are to turn so, too";
                    found.push((motion.line, why, remedy));
                }
            }
            _ => found.extend(lost(motion, start, planned, otherwise)),
        }
    }
    found.sort_by_key(|(line, ..)| *line);
    let mut lines: Vec<usize> = found.iter().map(|(line, ..)| *line).collect();
    lines.dedup();
    let Some((line, reason, remedy)) = found.into_iter().next() else {
        return Ok(());
    };
    let all = match lines.len() {
        1 => String::new(),
        _ => format!(" (so it is on {})", in_words(&lines)),
    };
    Err(PathWriteError::Motion {
        line,
        reason: format!("{reason}{all}"),
        remedy: format!("{remedy}, or correct the position alone"),
    })
}

/// Reason why the orientation of a motion would be lost between its ends.
fn lost(
    motion: &Motion,
    start: Option<UnitQuaternion<f64>>,
    planned: &PlannedMove,
    otherwise: TurnsOtherwise,
) -> Option<(usize, String, &'static str)> {
    if motion.kind == MotionKind::Joint {
        return None;
    }
    let mut turn = 0.0_f64;
    let mut from = start;
    for to in planned.pieces.iter().map(|piece| piece.orientation) {
        for begin in [from, start].into_iter().flatten() {
            let angle = to.map_or(0.0, |to| begin.angle_to(&to));
            // NaN counts as a large turn.
            turn = if angle <= turn { turn } else { angle };
        }
        from = to;
    }
    let reason = not_evenly("the correction turns the tool", turn, otherwise)?;
    Some((motion.line, reason, otherwise.remedy))
}

/// True if a circle is written as circles.
fn stays_circle(motion: &Motion, planned: &PlannedMove) -> bool {
    let is_circle = matches!(motion.kind, MotionKind::Circular { .. });
    let via = |of: &PlannedMove| of.pieces.last().is_some_and(|last| last.via_mm.is_some());
    is_circle && (planned.pieces.len() == 1 || via(planned))
}

/// True if a piece ends in another orientation than its motion.
fn ends_turned(own: Option<UnitQuaternion<f64>>, planned: &PlannedMove) -> bool {
    let turned = planned.pieces.iter().filter_map(|piece| piece.orientation);
    let Some(own) = own else {
        return false;
    };
    turned.map(|to| to.angle_to(&own)).any(|by| by > SAME_RAD)
}

/// Other circles whose orientation the statement required by a circle would change: circles with unknown points, and those of routines that are in
/// none of the files.
fn turns_others(program: &RobotProgram) -> Option<String> {
    let turns = "the correction turns the tool on this circle, which needs CirPathMode\\ObjectFrame; behind it";
    let is_known = |motion: &&Motion| {
        let start = motion.follows.and_then(|index| program.motions.get(index));
        motion.has_known_way() && start.is_some_and(|start| start.target.pose().is_some())
    };
    let goes_by_mode = |motion: &&Motion| {
        let otherwise = motion.site.turns_otherwise;
        matches!(motion.kind, MotionKind::Circular { .. })
            && otherwise.is_some_and(|otherwise| otherwise.evenly.is_some())
    };
    let other = program.motions.iter().filter(goes_by_mode);
    if let Some(other) = other.into_iter().find(|motion| !is_known(motion)) {
        return Some(format!(
            "{turns} the circle of line {}, of which the text does not say all, would turn the tool otherwise than now",
            other.line
        ));
    }
    // Named outside calls are assumed not to move the tool.
    let mut computed = (program.outside_calls.iter()).filter(|call| call.name.is_none());
    let call = computed.next()?;
    Some(format!(
        "{turns} circles of what line {} calls, which is computed, would turn the tool otherwise than now",
        call.line
    ))
}

// A correction turns the tool; the axes turn so that it lies where it is wanted, and the turn about the tool is free: the law of
// G-code under G43.4.

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
    // NaN counts as a mismatch.
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
