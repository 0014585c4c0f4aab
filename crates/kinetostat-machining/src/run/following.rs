//! Motion of a tool whose orientation follows: its rotation along a path, and its jumps.

use nalgebra::{UnitQuaternion, Vector3};

use kinetostat::batch::AlongPath;

use crate::number::largest_angle;
use crate::postures::neighbour::NEAR;
use crate::result::point::PointResult;
use crate::result::summary::Summary;
use crate::task::Task;
use crate::warning::{Warning, WarningCode};

/// Rotation vector between two orientations, base axes, deg.
pub(crate) fn turn_deg(from: &UnitQuaternion<f64>, to: &UnitQuaternion<f64>) -> [f64; 3] {
    let turn = (to * from.inverse()).scaled_axis();
    turn.map(f64::to_degrees).into()
}

/// Neighbours on the path between which a tool whose orientation follows turns farther than the way
/// between them explains: the machine has changed its branch. The line of the second.
pub(crate) fn jump(task: &Task<'_>, points: &[PointResult]) -> Option<usize> {
    let near = NEAR * task.mechanism.size();
    points.windows(2).find_map(|pair| {
        let [a, b] = [pair[0].tool_turn_deg?, pair[1].tool_turn_deg?];
        let distance = Vector3::from(pair[1].position_mm) - Vector3::from(pair[0].position_mm);
        let distance = task.placement.to_metres(&distance).norm();
        let turn = (Vector3::from(b) - Vector3::from(a)).norm().to_radians();
        (distance < near && turn > AlongPath::JUMP).then_some(pair[1].line)
    })
}

/// Warnings about a tool whose orientation follows.
pub(crate) fn following(
    task: &Task<'_>,
    points: &[PointResult],
    summary: &Summary,
) -> Vec<Warning> {
    let code = WarningCode::OrientationFollows;
    let turns = summary.max_tool_turn_deg.map(|turn| {
        let text = format!(
            "the orientation follows: the tool turns by up to {} from the orientation it is kept near to",
            largest_angle(turn)
        );
        Warning::new(code, text)
    });
    let jumps = jump(task, points).map(|line| {
        let text = "the orientation of the tool jumps here: the machine would have to change its branch, or passes close to a singular posture";
        Warning::at_line(code, line, text)
    });
    turns.into_iter().chain(jumps).collect()
}
