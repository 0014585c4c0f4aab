//! Orientations and rotary axis angles that a written program commands along a piece.

use kinetostat_program::{Corrected, GreatCircle, Move, Path, RotaryTurn, ToolTurn};
use nalgebra::Vector3;

/// Commanded rotation of the tool along a piece; `None` in a program of positions.
pub(super) fn commanded_turn(path: &Path, written: &Corrected, index: usize) -> Option<ToolTurn> {
    let end = *written.orientations.get(index)?;
    let turn = path.moves[written.pieces[index].move_index]
        .tool_turn
        .as_ref()?;
    let start = match index.checked_sub(1) {
        Some(before) => written.orientations[before],
        None => turn.at(0.0),
    };
    Some(turn.with_ends(start, end))
}

pub(super) fn rotary(motion: &Move) -> Option<&RotaryTurn> {
    motion.tool_turn.as_ref()?.rotary.as_ref()
}

/// Great circle of the tool's axis between the angles at both ends of a piece as written; `None` if each axis turns
/// linearly.
pub(super) fn great_circle(motion: &Move, from: &[f64], to: &[f64]) -> Option<GreatCircle> {
    let own = rotary(motion).filter(|own| own.great_circle.is_some())?;
    let tool_axis = own.axes.tool_at_zero.inverse() * Vector3::z();
    let direction = own.axes.tool_direction_at(to, &tool_axis);
    GreatCircle::new(&own.axes, from, &direction).ok()
}

/// Angles of the rotary axes at both ends of a piece as written, deg; `None` if they are those of the program.
pub(super) fn commanded_angles(
    path: &Path,
    written: &Corrected,
    index: usize,
) -> Option<[Vec<f64>; 2]> {
    let own = rotary(&path.moves[written.pieces[index].move_index])?;
    let to = written.rotary_deg.get(index)?.clone();
    let before = index
        .checked_sub(1)
        .map(|before| &written.rotary_deg[before]);
    let before = before.filter(|before| before.len() == to.len());
    let from = before.cloned().unwrap_or_else(|| own.angles_deg(0.0));
    Some([from, to])
}
