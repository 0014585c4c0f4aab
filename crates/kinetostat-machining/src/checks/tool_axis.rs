//! Check that the tool of a program with orientations lies across its cut, and points away from the machine.

use kinetostat::Directions;
use kinetostat::number::short;
use kinetostat_program::{Move, MoveKind};
use nalgebra::Vector3;

use crate::bounds::ToolGiven;
use crate::checks::load::loads;
use crate::task::Task;
use crate::warning::{Warning, WarningCode};

/// Cosine of the angle between feed and tool from which on the tool is taken to go along its axis: 20 degrees.
const ALONG: f64 = 0.94;

/// Share of the feed path along the tool from which on it is no milling.
const MOST: f64 = 0.5;

/// Flanges that lie less behind the tip are beside it, mm.
const LEAST_MM: f64 = 1e-3;

/// Warning if most of the path lies along the tool's axis, which a load that turns with the feed needs: it is another
/// axis of the tool's frame, or a program that drills.
pub(crate) fn odd_tool_axis(task: &Task<'_>) -> Option<Warning> {
    let path = task.path();
    let turns = loads(task).iter().any(|(_, load)| load.turns());
    if !turns || path.moves.iter().all(|motion| motion.tool_turn.is_none()) {
        return None;
    }
    let (mut all, mut along, mut first) = (0.0, 0.0, None);
    for (index, motion) in path.moves.iter().enumerate() {
        if motion.kind != MoveKind::Feed || !motion.is_known_feed() {
            continue;
        }
        let length = motion.length_mm();
        all += length;
        let direction = path.tool_direction(index, 0.5);
        let part = motion.tangent(0.5).map_or(0.0, |t| t.dot(&direction).abs());
        if part > ALONG {
            along += length;
            first.get_or_insert(motion.line);
        }
    }
    let line = first.filter(|_| along > MOST * all)?;
    // A component of rounding error is shown as zero.
    let [x, y, z] = [0, 1, 2].map(|k| match path.tool_axis[k].abs() < 1e-9 {
        true => "0".to_owned(),
        false => short(path.tool_axis[k]),
    });
    Some(Warning::at_line(
        WarningCode::OddToolAxis,
        line,
        format!(
            "the tool goes along its own axis on {:.0} % of the path at feed, first here, and the force of milling then has no direction across it: is the tool's axis ({x}, {y}, {z}) of its frame? State it as tool_axis under [robot], from the tip to the holder",
            100.0 * along / all
        ),
    ))
}

/// Warning of a flange on the wrong side of the tip: the axis of a tool points from its tip to its holder. The tool then
/// points into the ram: a wrong sign of its length, or of the flange's frame.
pub(crate) fn tip_behind_flange(task: &Task<'_>, tool: &ToolGiven) -> Option<Warning> {
    let path = task.path();
    let turned = path
        .moves
        .iter()
        .find(|motion| motion.tool_turn.is_some())?;
    let flange = tool.pose.inverse().translation.vector * 1e3;
    let along = flange.dot(&path.tool_axis);
    if along >= -LEAST_MM {
        return None;
    }
    let named = tool.number.map_or_else(String::new, |n| format!(" {n}"));
    Some(Warning::at_line(
        WarningCode::TipBehindFlange,
        turned.line,
        format!(
            "the tip of the tool{named} lies {} mm behind the flange, along the axis that the program gives the tool: it would point into the spindle. Turn z of the platform's home out of the spindle in the model, change the sign of the tool's z, or state the tool's axis (tool_axis under [robot], from the tip to the holder)",
            short(-along)
        ),
    ))
}

/// Warning if corrections of rotary axes are left out because the tool lies along one of them.
pub(crate) fn at_pole(task: &Task<'_>) -> Option<Warning> {
    if task.corrected != Directions::ALL {
        return None;
    }
    let path = task.path();
    let lies = |motion: &&Move| {
        let rotary = motion
            .tool_turn
            .as_ref()
            .and_then(|turn| turn.rotary.as_ref());
        let Some(rotary) = rotary.filter(|_| motion.is_known_feed()) else {
            return false;
        };
        let at_pole = |share: f64| {
            let angles = rotary.angles_deg(share);
            let none = Vector3::zeros();
            rotary.axes.turns_for(&angles, &path.tool_axis, &none).1
        };
        [0.0, 0.5, 1.0].into_iter().any(at_pole)
    };
    let mut moves = path.moves.iter().filter(lies);
    let line = moves.next()?.line;
    let more = match moves.count() {
        0 => String::new(),
        n => format!(" and in {n} more"),
    };
    Some(Warning::at_line(
        WarningCode::AtPole,
        line,
        format!(
            "the tool lies within 2 degrees of a rotary axis in this block{more}: turns about that axis are corrected in part, or not at all (nearer than 1 degree), and a tilt of the tool stays (the figures count it)"
        ),
    ))
}
