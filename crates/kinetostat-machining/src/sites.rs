//! Where along a path, or along a written program, errors are looked at.

use kinetostat::Wrench;
use kinetostat_program::{
    Corrected, Curve, Knowledge, Move, MoveKind, Path, Piece, Turn, irregular,
};
use nalgebra::Vector3;

use crate::load::{CornerLoad, LoadAlongPath};
use crate::placement::Placement;
use crate::result::PointKind;

/// A place on the path with its load and, for a written program, what is commanded there.
#[derive(Clone, Debug)]
pub(crate) struct Site {
    pub line: usize,
    pub output_line: usize,
    pub kind: PointKind,
    pub share: f64,
    pub path_mm: f64,
    /// Where the tool should be, mm, program coordinates.
    pub desired: Vector3<f64>,
    /// What the written program commands, mm; the same without compensation.
    pub commanded: Vector3<f64>,
    pub wrench: Wrench,
    /// On a corner step, the load by the reading that was not chosen.
    pub other_wrench: Option<Wrench>,
    /// End of a piece (or block), where a full answer is wanted; otherwise its middle.
    pub end: bool,
}

/// Length of the path before every move, mm.
fn starts(path: &Path) -> Vec<f64> {
    let mut length = 0.0;
    path.moves
        .iter()
        .map(|m| {
            let start = length;
            length += known_length(m);
            start
        })
        .collect()
}

/// Straight blocks longer than this share of the path that is cut are looked at in more places.
const PIECES: f64 = 500.0;

fn longest_piece(path: &Path) -> f64 {
    let cut = path.moves.iter().filter(|m| m.kind == MoveKind::Feed);
    cut.map(known_length).sum::<f64>() / PIECES
}

/// A move from a place that the program does not tell has no length that counts.
fn known_length(motion: &Move) -> f64 {
    if motion.known == Knowledge::Whole {
        motion.length_mm()
    } else {
        0.0
    }
}

/// Ends and middles of all blocks, one after the other; arcs at every chord of `arc_tolerance_mm`.
pub(crate) fn of_path<'a>(
    path: &'a Path,
    load: &'a LoadAlongPath<'a>,
    placement: &'a Placement,
    arc_tolerance_mm: f64,
) -> impl Iterator<Item = Site> + 'a {
    let starts = starts(path);
    let longest = longest_piece(path);
    let moves = path.moves.iter().enumerate();
    moves.flat_map(move |(i, motion)| {
        let site = |share: f64, end: bool| {
            let desired = motion.point(share);
            Site {
                line: motion.line,
                output_line: 0,
                kind: kind(motion),
                share,
                path_mm: starts[i] + share * known_length(motion),
                desired,
                commanded: desired,
                wrench: load.wrench(placement, i, share),
                other_wrench: None,
                end,
            }
        };
        match (motion.known, motion.kind) {
            (Knowledge::Nothing, _) => Vec::new(),
            (Knowledge::End, _) | (_, MoveKind::Rapid) => vec![site(1.0, true)],
            (Knowledge::Whole, MoveKind::Feed) if motion.length_mm() == 0.0 => Vec::new(),
            (Knowledge::Whole, MoveKind::Feed) => {
                let pieces = match &motion.curve {
                    // Between the ends of a long block the load or the machine may differ much.
                    Curve::Line => (motion.length_mm() / longest).ceil().max(1.0) as usize,
                    Curve::Arc(arc) => arc.chords_within(arc_tolerance_mm),
                };
                let share = |k: usize, x: f64| (k as f64 + x) / pieces as f64;
                let both = |k| [site(share(k, 0.5), false), site(share(k, 1.0), true)];
                (0..pieces).flat_map(both).collect()
            }
        }
    })
}

/// Seed of the irregular places: the division of blocks has another, so that what it overlooked is not
/// overlooked here too.
const SEED: u64 = 4;

/// Share of the spacing below which a block that was not divided is straight in every respect.
const SHORT: f64 = 0.05;

/// Ends of all pieces of a written program and irregular places inside them, no farther apart than twice
/// `spacing_mm`, and the middles of pieces that are not very short, one after the other.
pub(crate) fn of_written<'a>(
    path: &'a Path,
    written: &'a Corrected,
    load: &'a LoadAlongPath<'a>,
    placement: &'a Placement,
    spacing_mm: f64,
) -> impl Iterator<Item = Site> + 'a {
    let starts = starts(path);
    let pieces = written.pieces.iter().enumerate();
    pieces.flat_map(move |(index, piece)| {
        let motion = &path.moves[piece.move_index];
        let mut sites = Vec::new();
        if !piece.corrected || motion.known == Knowledge::Nothing || motion.length_mm() == 0.0 {
            return sites;
        }
        let mut push = |place: f64, (wrench, other_wrench): (Wrench, Option<Wrench>), end: bool| {
            let share = piece.share_from + place * (piece.share_to - piece.share_from);
            sites.push(Site {
                line: motion.line,
                output_line: piece.output_line,
                kind: if piece.corner_step {
                    PointKind::Corner
                } else {
                    kind(motion)
                },
                share,
                path_mm: starts[piece.move_index] + share * known_length(motion),
                desired: motion.point(share),
                commanded: commanded(motion, piece, place),
                wrench,
                other_wrench,
                end,
            });
        };
        let inside = |k: usize| irregular(SEED, index as u64, k as u64);
        if let Some(turn) = piece.turn {
            for (place, end) in [(inside(0), false), (1.0, true)] {
                push(place, on_step(piece, &turn, place, load, placement), end);
            }
            return sites;
        }
        // Beside a jump of the load inside a move, the load is the one before it or after it: within
        // the micrometre in which it is located it steps, it does not turn gradually.
        let neighbour = |index: Option<usize>| {
            index
                .and_then(|index| written.pieces.get(index))
                .filter(|other| other.move_index == piece.move_index)
                .and_then(|other| other.turn)
        };
        let lowest = neighbour(index.checked_sub(1)).map_or(0.0, |turn| turn.to_share);
        let highest = neighbour(Some(index + 1)).map_or(1.0, |turn| turn.from_share);
        let at = |share: f64| {
            let share = share.max(lowest).min(highest);
            (load.wrench(placement, piece.move_index, share), None)
        };
        if motion.kind == MoveKind::Feed && motion.known == Knowledge::Whole {
            let length = motion.length_between_mm(piece.share_from, piece.share_to);
            let count = (length / spacing_mm).ceil().clamp(1.0, 1e4) as usize;
            let mut places: Vec<f64> = (0..count)
                .map(|k| (k as f64 + inside(k)) / count as f64)
                .collect();
            let divided = piece.share_from > 0.0 || piece.share_to < 1.0;
            if divided || length > SHORT * spacing_mm {
                // A piece leaves its block farthest near its middle; one of a short block that was not
                // divided does not leave it by anything that could be seen.
                places.push(0.5);
                places.sort_by(f64::total_cmp);
            }
            for place in places {
                let share = piece.share_from + place * (piece.share_to - piece.share_from);
                push(place, at(share), false);
            }
        }
        push(1.0, at(piece.share_to), true);
        sites
    })
}

/// The load on a corner step, as chosen and by the other reading.
fn on_step(
    piece: &Piece,
    turn: &Turn,
    place: f64,
    load: &LoadAlongPath<'_>,
    placement: &Placement,
) -> (Wrench, Option<Wrench>) {
    let part = turn.part_from + place * (turn.part_to - turn.part_from);
    let from = (turn.from_move, turn.from_share);
    let to = (piece.move_index, turn.to_share);
    let turns = load.turning_wrench(placement, from, to, part);
    let along = piece.commanded_to - piece.commanded_from;
    let follows = load.wrench_towards(placement, to.0, to.1, &along);
    match load.load_of(piece.move_index).at_corners {
        CornerLoad::Turns => (turns, Some(follows)),
        CornerLoad::FollowsFeed => (follows, Some(turns)),
    }
}

fn kind(motion: &Move) -> PointKind {
    match motion.kind {
        MoveKind::Rapid => PointKind::Rapid,
        MoveKind::Feed => PointKind::Feed,
    }
}

fn commanded(motion: &Move, piece: &Piece, place: f64) -> Vector3<f64> {
    if piece.kept_arc {
        return motion.point(place);
    }
    piece.commanded_from + (piece.commanded_to - piece.commanded_from) * place
}
