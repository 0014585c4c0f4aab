//! At how many places of a program that is looked at which takes long at each.

use kinetostat_program::Move;

use crate::result::run_result::RunResult;
use crate::task::Task;

/// Places of a part of a longer program, at least.
const OF_PART: usize = 2;

/// Every how many of so many points one is looked at, so that there are [`RunResult::MAX_POSTURES`] places at most: of a part of a
/// longer program as many of them as its length has a share in that, and two at least.
pub(crate) fn every(task: &Task<'_>, points: usize) -> usize {
    points.div_ceil(places(task)).max(1)
}

fn places(task: &Task<'_>) -> usize {
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
    let places = (share * RunResult::MAX_POSTURES as f64).ceil() as usize;
    places.max(OF_PART)
}
