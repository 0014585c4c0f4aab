//! Places along a path that the load requires.

use kinetostat::Wrench;
use kinetostat_program::{Path, Piece, Turn, Turning};

use crate::load::along_path::LoadAlongPath;
use crate::load::law::CornerLoad;
use crate::placement::Placement;

/// The load at the start of a move is another one than that before it, or a cut begins there.
pub(super) fn jumps(
    path: &Path,
    load: &LoadAlongPath<'_>,
    placement: &Placement,
    i: usize,
) -> bool {
    let Some(before) = i.checked_sub(1) else {
        return true;
    };
    if !path.moves[before].is_known_feed() {
        return true;
    }
    let before = load.wrench(placement, before, 1.0).0;
    let after = load.wrench(placement, i, 0.0).0;
    (after - before).norm() > 1e-6 * (before.norm() + after.norm())
}

/// Departure of the load from the straight line between the ends of a block, share of it, that is looked at.
const STRAIGHT: f64 = 1e-5;

/// Places inside a block at which a load is farthest from the line between its ends: at jumps of it or its slope and midway
/// between, and in the middle if it turns. Empty if it is linear.
pub(super) fn places_of_load(
    load: &LoadAlongPath<'_>,
    placement: &Placement,
    index: usize,
) -> Vec<f64> {
    if load.is_steady(index) {
        return Vec::new();
    }
    let mut shares = load.breaks(index);
    shares.retain(|share| *share > 0.0 && *share < 1.0);
    let [begin, middle, end] = [0.0, 0.5, 1.0].map(|share| load.wrench(placement, index, share).0);
    let turns = (middle - 0.5 * (begin + end)).norm() > STRAIGHT * (begin.norm() + end.norm());
    if shares.is_empty() && !turns {
        return shares;
    }
    shares.extend([0.0, 1.0]);
    shares.sort_by(f64::total_cmp);
    let between: Vec<f64> = shares.windows(2).map(|w| 0.5 * (w[0] + w[1])).collect();
    shares.extend(between);
    shares.retain(|share| *share > 0.0 && *share < 1.0);
    shares
}

/// The load on a corner step, as chosen and by the other reading.
pub(super) fn on_step(
    piece: &Piece,
    turn: &Turn,
    place: f64,
    load: &LoadAlongPath<'_>,
    placement: &Placement,
) -> (Wrench, Option<Wrench>) {
    let turning = Turning {
        from_move: turn.from_move,
        from_share: turn.from_share,
        to_share: turn.to_share,
        part: turn.part_from + place * (turn.part_to - turn.part_from),
    };
    let turns = load.turning_wrench(placement, piece.move_index, &turning);
    let along = piece.commanded_to - piece.commanded_from;
    let follows = load.wrench_towards(placement, piece.move_index, turn.to_share, &along);
    match load.load_of(piece.move_index).at_corners {
        CornerLoad::Turns => (turns, Some(follows)),
        CornerLoad::FollowsFeed => (follows, Some(turns)),
    }
}
