//! Places at which a program is evaluated as it is given, and those that the load requires.

use kinetostat::Wrench;
use kinetostat_program::{Knowledge, MoveKind, Path, Piece, Turn, Turning};

use crate::load::along_path::LoadAlongPath;
use crate::load::law::CornerLoad;
use crate::placement::Placement;
use crate::run::sites::site::{Programmed, Site, kind, spacing_mm, starts, stays};
use crate::task::Task;

/// Places at which a program is evaluated as it is given: ends and middles of all blocks, and their starts where the load jumps; of
/// blocks longer than a spacing those of their pieces; and inside the others where the load departs from the line between their ends.
struct OfPath<'a> {
    path: &'a Path,
    load: &'a LoadAlongPath<'a>,
    placement: &'a Placement,
    starts: Vec<f64>,
    programmed: Programmed,
}

impl<'a> OfPath<'a> {
    fn new(task: &'a Task<'_>, load: &'a LoadAlongPath<'a>) -> Self {
        let path = task.path();
        Self {
            path,
            load,
            placement: &task.placement,
            starts: starts(path),
            programmed: Programmed::new(path, spacing_mm(task)),
        }
    }

    /// Shares of a move in order, and which of them are ends.
    fn shares(&self, i: usize) -> Vec<(f64, bool)> {
        let motion = &self.path.moves[i];
        match (motion.known, motion.kind) {
            (Knowledge::Nothing, _) => Vec::new(),
            (Knowledge::End, _) | (_, MoveKind::Rapid) => vec![(1.0, true)],
            (Knowledge::Whole, MoveKind::Feed) if stays(motion) => Vec::new(),
            (Knowledge::Whole, MoveKind::Feed) => {
                let pieces = self.programmed.pieces(motion);
                let jumps = jumps(self.path, self.load, self.placement, i);
                let start = jumps.then_some((0.0, false)).into_iter();
                let mut shares: Vec<(f64, bool)> = start
                    .chain(self.programmed.shares(motion, pieces))
                    .collect();
                if pieces == 1 {
                    let inside = places_of_load(self.load, self.placement, i);
                    shares.extend(inside.into_iter().map(|share| (share, false)));
                    shares.sort_by(|a, b| a.0.total_cmp(&b.0));
                    shares.dedup_by(|later, first| later.0 == first.0);
                }
                shares
            }
        }
    }

    /// The place at a share of a move, with what acts there.
    fn site(&self, i: usize, share: f64, end: bool) -> Site {
        let motion = &self.path.moves[i];
        let desired = motion.point(share);
        Site {
            line: motion.line,
            move_index: i,
            kind: kind(motion),
            share,
            path_mm: self.starts[i] + share * motion.known_length_mm(),
            start_mm: self.starts[i],
            programmed: true,
            desired,
            commanded: desired,
            orientation: motion.orientation(share),
            commanded_orientation: motion.orientation(share),
            wrench: self.load.wrench(self.placement, i, share),
            end,
            ..Site::default()
        }
    }
}

/// The places of [`OfPath`], one after the other.
pub(crate) fn sites_of_path<'a>(
    task: &'a Task<'_>,
    load: &'a LoadAlongPath<'a>,
) -> impl Iterator<Item = Site> + 'a {
    let of_path = OfPath::new(task, load);
    task.path().own_moves().flat_map(move |i| {
        let shares = of_path.shares(i).into_iter();
        let sites = shares.map(|(share, end)| of_path.site(i, share, end));
        sites.collect::<Vec<_>>()
    })
}

/// Places at shares of moves, as the program is given; none on moves that lead nowhere, and the end of a rapid or of a move from
/// a place that the program does not state.
pub(crate) fn places_on_moves(
    task: &Task<'_>,
    load: &LoadAlongPath<'_>,
    chosen: &[(usize, f64)],
) -> Vec<Site> {
    let path = task.path();
    let of_path = OfPath::new(task, load);
    let site = |(index, share): &(usize, f64)| {
        let motion = &path.moves[*index];
        let share = match (motion.known, motion.kind) {
            (Knowledge::Nothing, _) => return None,
            (Knowledge::Whole, MoveKind::Feed) if stays(motion) => return None,
            (Knowledge::Whole, MoveKind::Feed) => *share,
            _ => 1.0,
        };
        Some(of_path.site(*index, share, share == 1.0))
    };
    chosen.iter().filter_map(site).collect()
}

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
