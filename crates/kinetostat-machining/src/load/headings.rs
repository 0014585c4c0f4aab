//! In which direction a cut goes at the ends of every move, and how far the load lags behind at a gentle corner.

use kinetostat_program::{Move, MoveKind, Path};
use nalgebra::{UnitQuaternion, Vector3};

use crate::cut::station::{SHORT_MM, heading};
use crate::load::law::ProgramLoad;

/// Heading of a move at its two ends, seen along z of the part frame (along the tool where the program turns it), rad, and how far the heading
/// of the load differs there because a corner is gentle.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Headings {
    /// Direction of the path around a move, part axes, for a move too short to have its own and for a rotation in place. It stays as it
    /// is in the part while the tool turns.
    pub around: Option<Vector3<f64>>,
    pub at_start: Option<f64>,
    pub at_end: Option<f64>,
    pub lag_start: f64,
    pub lag_end: f64,
}

/// Length of the path on either side that says in which direction the tool cuts there, mm: about a tooth's feed.
const AROUND_MM: f64 = 0.05;

/// Direction of the path around a move that is too short to have one; `None` for others, and where the path turns back.
fn around(path: &Path, move_index: usize) -> Option<Vector3<f64>> {
    let motion = &path.moves[move_index];
    if !motion.is_known_feed() || motion.length_mm() >= SHORT_MM {
        return None;
    }
    // From the middle of the move `AROUND_MM` back and on, as far as the cut goes.
    let reach = |moves: &mut dyn Iterator<Item = &Move>, back: bool| {
        let mut left = AROUND_MM - 0.5 * motion.length_mm();
        let mut place = if back { motion.start } else { motion.end };
        for m in moves.take_while(|m| m.is_known_feed()) {
            let length = m.length_mm();
            if length >= left {
                let share = left / length;
                return m.point(if back { 1.0 - share } else { share });
            }
            left -= length;
            place = if back { m.start } else { m.end };
        }
        place
    };
    let from = reach(&mut path.moves[..move_index].iter().rev(), true);
    let to = reach(&mut path.moves[move_index + 1..].iter(), false);
    let chord = to - from;
    chord.try_normalize(SHORT_MM)
}

fn wrap(angle: f64) -> f64 {
    let turn = std::f64::consts::TAU;
    angle - turn * (angle / turn).round()
}

/// Headings of all moves under loads that turn with the feed.
pub(crate) fn headings<'l>(
    path: &Path,
    load_of: impl Fn(usize) -> &'l ProgramLoad,
) -> Vec<Headings> {
    let mut headings = vec![Headings::default(); path.moves.len()];
    for (i, (h, m)) in headings.iter_mut().zip(&path.moves).enumerate() {
        if m.kind == MoveKind::Feed && load_of(i).turns() {
            h.around = around(path, i);
            h.at_start = heading_on(path, i, 0.0, h.around.or_else(|| m.tangent(0.0)));
            h.at_end = heading_on(path, i, 1.0, h.around.or_else(|| m.tangent(1.0)));
        }
    }
    for i in 1..headings.len() {
        let (Some(before), Some(after)) = (headings[i - 1].at_end, headings[i].at_start) else {
            continue;
        };
        let turn = wrap(after - before);
        if turn.abs() <= load_of(i).gentle_corner {
            headings[i - 1].lag_end = 0.5 * turn;
            headings[i].lag_start = -0.5 * turn;
        }
    }
    headings
}

/// The rotation that takes the part's z to the tool's direction by the shorter way, part axes: none in a program of positions.
pub(crate) fn tool_frame(path: &Path, move_index: usize, share: f64) -> UnitQuaternion<f64> {
    let Some(orientation) = path.moves[move_index].orientation(share) else {
        return UnitQuaternion::identity();
    };
    let direction = orientation * path.tool_axis;
    // Upside down every way is as short: about x.
    UnitQuaternion::rotation_between(&Vector3::z(), &direction).unwrap_or_else(|| {
        UnitQuaternion::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI)
    })
}

/// Heading of a direction (part axes) at a share of a move in the axes of [`tool_frame`], rad; `None` along the tool.
pub(crate) fn heading_on(
    path: &Path,
    move_index: usize,
    share: f64,
    direction: Option<Vector3<f64>>,
) -> Option<f64> {
    match path.moves[move_index].tool_turn {
        None => heading(direction),
        Some(_) => {
            let frame = tool_frame(path, move_index, share);
            heading(direction.map(|along| frame.inverse() * along))
        }
    }
}
