//! Corrections that would turn the tool in motions in which it does not turn evenly: they are refused before anything is written.
//!
//! Reading refuses such motions where the program turns the tool ([`crate::path`]); what is written has to pass the
//! same question.

use kinetostat_program::{Plan, PlannedMove, WriteError as PathWriteError};
use nalgebra::UnitQuaternion;

use crate::model::motion::{Motion, MotionKind};
use crate::model::program::RobotProgram;
use crate::model::site::TurnsOtherwise;
use crate::model::site::not_evenly;
use crate::path::of_program::RobotPath;
use crate::text::line_words::in_words;
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
