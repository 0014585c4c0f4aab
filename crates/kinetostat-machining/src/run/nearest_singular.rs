//! Where a program comes nearest to a singular posture.

use kinetostat::Posture;
use kinetostat_program::Move;

use crate::near::{natural_length, near_singular};
use crate::postures::orientation::Orientation;
use crate::result::point::PointResult;
use crate::result::run_result::{NearSingularPlace, RunResult};
use crate::task::Task;

/// Postures of a part of a longer program, at least.
const OF_PART: usize = 16;

/// How many places are looked at: of a part as many of those of the whole as its length has a share in that.
fn postures(task: &Task<'_>) -> usize {
    let Some(part) = &task.path().part else {
        return RunResult::MAX_POSTURES;
    };
    let own = task.path().moves[part.moves.clone()].iter();
    let own_mm: f64 = own
        .filter(|motion| motion.is_known_feed())
        .map(Move::length_mm)
        .sum();
    let share = (own_mm / part.whole_feed_mm).min(1.0);
    // No number where nothing is cut.
    let share = if share.is_finite() { share } else { 1.0 };
    let postures = (share * RunResult::MAX_POSTURES as f64).ceil() as usize;
    postures.max(OF_PART)
}

/// The place nearest to a singular posture: ends of moves and places between them, evenly spread.
/// Places are compared by the tool's motion, rotations at the natural length.
pub(crate) fn nearest_singular(
    task: &Task<'_>,
    points: &[PointResult],
) -> Option<NearSingularPlace> {
    let stride = points.len().div_ceil(postures(task)).max(1);
    let length_mm = 1e3 * natural_length(task.mechanism);
    let orientation = Orientation {
        follows: task.placement.orientation_follows,
        load_turns: false,
    };
    let mut last: Option<Posture> = None;
    let mut found: Option<(f64, NearSingularPlace)> = None;
    for point in points.iter().step_by(stride) {
        let pose = point.wanted_pose(&task.placement);
        let mechanism = task.mechanism_on(point.line);
        let near = last
            .as_ref()
            .filter(|near| std::ptr::eq(near.mechanism(), mechanism));
        let posture = orientation.posture(mechanism, &pose, near);
        let Ok(posture) = posture else { continue };
        if let Some(near) = near_singular(&posture) {
            let far = near
                .distance_mm
                .max(near.rotation_deg.to_radians() * length_mm);
            if found.as_ref().is_none_or(|(least, _)| far < *least) {
                found = Some((
                    far,
                    NearSingularPlace {
                        line: point.line,
                        position_mm: point.position_mm,
                        posture: near,
                    },
                ));
            }
        }
        last = Some(posture);
    }
    found.map(|(_, place)| place)
}
