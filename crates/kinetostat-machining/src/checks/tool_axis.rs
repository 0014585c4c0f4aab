//! Whether the tool of a program that turns it lies across its cut.

use kinetostat_program::MoveKind;

use crate::checks::load::loads;
use crate::task::Task;
use crate::warning::{Warning, WarningCode};

/// Cosine of the angle between feed and tool from which on the tool is taken to go along its axis: 20 degrees.
const ALONG: f64 = 0.94;

/// Share of the feed path along the tool from which on it is no milling.
const MOST: f64 = 0.5;

/// A load that turns with the feed needs the tool's axis. Where most of the path lies along it, it is another axis of the
/// tool's frame, or a program that drills.
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
    let [x, y, z] = [0, 1, 2].map(|k| path.tool_axis[k]);
    Some(Warning::at_line(
        WarningCode::OddToolAxis,
        line,
        format!(
            "the tool goes along its own axis on {:.0} % of the path at feed, first here, and the force of milling then has no direction across it: is the tool's axis ({x}, {y}, {z}) of its frame? State it as tool_axis under [robot], from the tip to the holder",
            100.0 * along / all
        ),
    ))
}
