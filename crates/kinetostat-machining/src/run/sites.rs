//! Where along a path, or along a written program, errors are looked at.

use kinetostat::Wrench;
use kinetostat_program::{
    Corrected, Curve, GreatCircle, Knowledge, Move, MoveKind, Path, Piece, RotaryTurn, ToolTurn,
    Turn, irregular,
};
use nalgebra::{UnitQuaternion, Vector3};

use crate::load::along_path::LoadAlongPath;
use crate::load::law::CornerLoad;
use crate::near::natural_length;
use crate::placement::Placement;
use crate::result::point::PointKind;
use crate::task::Task;

/// A place on the path with its load and, for a written program, what is commanded there.
#[derive(Clone, Debug)]
pub(crate) struct Site {
    pub line: usize,
    /// Index of its move in the path.
    pub move_index: usize,
    pub output_line: usize,
    pub kind: PointKind,
    pub share: f64,
    pub path_mm: f64,
    /// Length of the path before its move, mm.
    pub start_mm: f64,
    /// One of the places at which a program is looked at however it is written ([`of_path`]).
    pub programmed: bool,
    /// Where the tool should be, mm, program coordinates.
    pub desired: Vector3<f64>,
    /// What the written program commands, mm; the same without compensation.
    pub commanded: Vector3<f64>,
    /// Orientation of the tool in the program, part axes from tool axes; `None` in a program of positions.
    pub orientation: Option<UnitQuaternion<f64>>,
    /// What the written program commands; the same without compensation, or where only the position is corrected.
    pub commanded_orientation: Option<UnitQuaternion<f64>>,
    /// Where the written program has the rotary axes, deg; none where it has them as the program.
    pub commanded_deg: Option<Vec<f64>>,
    pub wrench: Wrench,
    /// On a corner step, the load by the reading that was not chosen.
    pub other_wrench: Option<Wrench>,
    /// End of a piece (or block), where a full answer is wanted; otherwise its middle.
    pub end: bool,
}

impl Site {
    /// Where the program lies there.
    pub(crate) fn placement(&self, task: &Task<'_>) -> Placement {
        let motion = &task.path().moves[self.move_index];
        task.placement.on(motion, self.share)
    }

    /// Where it lies as the written program turns it.
    pub(crate) fn commanded_placement(&self, task: &Task<'_>) -> Placement {
        let motion = &task.path().moves[self.move_index];
        match (&self.commanded_deg, rotary(motion)) {
            (Some(angles), Some(rotary)) => task.placement.turned(Some(&rotary.axes.part(angles))),
            _ => self.placement(task),
        }
    }
}

/// Length of the path before every move, mm; of a part of a longer program counted from the beginning of that, for the moves
/// that are its own and those behind them.
pub(crate) fn starts(path: &Path) -> Vec<f64> {
    let own = path.own_moves();
    let before_mm = path.part.as_ref().map_or(0.0, |part| part.before_mm);
    let mut length = before_mm;
    let moves = path.moves.iter().enumerate();
    moves
        .map(|(index, m)| {
            if index <= own.start {
                length = before_mm;
            }
            let start = length;
            length += known_length(m);
            start
        })
        .collect()
}

/// Blocks longer than this share of the path that is cut are looked at in more places.
const PIECES: f64 = 500.0;

/// A move that turns the tool is looked at after so much of its turn, deg.
const TURN_DEG: f64 = 10.0;

/// Arcs are looked at where chords leave them by at most this, mm.
const ARC_MM: f64 = 0.01;

/// The places at which a program is looked at as it is given: the same whether and how it is written anew,
/// so that figures without compensation are the same in every run.
struct Programmed {
    longest_mm: f64,
    short_mm: f64,
}

impl Programmed {
    fn new(path: &Path, spacing_mm: f64) -> Self {
        let cut = path.moves.iter().filter(|m| m.kind == MoveKind::Feed);
        let length = match &path.part {
            Some(part) => part.whole_feed_mm,
            None => cut.map(known_length).sum::<f64>(),
        };
        Self {
            longest_mm: (length / PIECES).min(spacing_mm),
            short_mm: SHORT * spacing_mm,
        }
    }

    fn pieces(&self, motion: &Move) -> usize {
        let length = motion.length_mm();
        // Of a program that only turns all lengths are zero.
        let pieces = match length > 0.0 {
            true => (length / self.longest_mm).ceil().clamp(1.0, 1e6) as usize,
            false => 1,
        };
        let pieces = pieces.max(turns(motion, 1.0));
        match &motion.curve {
            Curve::Line => pieces,
            Curve::Arc(arc) => pieces.max(arc.chords_within(ARC_MM)),
        }
    }

    /// Ends and middles of equal pieces of a block at feed, as shares of it, and which of them are ends: between
    /// the ends of a long block the load or the machine may differ much. A very short one has no middle.
    fn shares(&self, motion: &Move) -> impl Iterator<Item = (f64, bool)> + use<> {
        let pieces = self.pieces(motion);
        let middles = pieces > 1 || motion.length_mm() > self.short_mm || motion.turns_in_place();
        (1..=2 * pieces)
            .filter(move |half| middles || half % 2 == 0)
            .map(move |half| (half as f64 / (2 * pieces) as f64, half % 2 == 0))
    }
}

/// Into how many parts a share of a move is divided by the turn of the tool in the part.
fn turns(motion: &Move, width: f64) -> usize {
    (motion.turn_deg() * width / TURN_DEG)
        .ceil()
        .clamp(1.0, 1e6) as usize
}

/// A move from a place that the program does not tell has no length that counts.
fn known_length(motion: &Move) -> f64 {
    if motion.known == Knowledge::Whole {
        motion.length_mm()
    } else {
        0.0
    }
}

/// A move from a known place that neither goes nor turns.
fn stays(motion: &Move) -> bool {
    motion.known == Knowledge::Whole && !motion.has_length() && !motion.turns_in_place()
}

/// The load at the start of a move is another one than that before it, or a cut begins there.
fn jumps(path: &Path, load: &LoadAlongPath<'_>, placement: &Placement, i: usize) -> bool {
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

/// Where a program is looked at as it is given: ends and middles of all blocks, and their starts where the load jumps; of blocks longer
/// than a spacing those of their pieces; and inside the others where the load departs from what their ends say.
struct OfPath<'a> {
    path: &'a Path,
    load: &'a LoadAlongPath<'a>,
    placement: &'a Placement,
    starts: Vec<f64>,
    programmed: Programmed,
}

impl<'a> OfPath<'a> {
    fn new(
        path: &'a Path,
        load: &'a LoadAlongPath<'a>,
        placement: &'a Placement,
        spacing_mm: f64,
    ) -> Self {
        Self {
            path,
            load,
            placement,
            starts: starts(path),
            programmed: Programmed::new(path, spacing_mm),
        }
    }

    /// Shares of a move, and which of them are ends.
    fn shares(&self, i: usize) -> Vec<(f64, bool)> {
        let motion = &self.path.moves[i];
        match (motion.known, motion.kind) {
            (Knowledge::Nothing, _) => Vec::new(),
            (Knowledge::End, _) | (_, MoveKind::Rapid) => vec![(1.0, true)],
            (Knowledge::Whole, MoveKind::Feed) if stays(motion) => Vec::new(),
            (Knowledge::Whole, MoveKind::Feed) => {
                let jumps = jumps(self.path, self.load, self.placement, i);
                let start = jumps.then_some((0.0, false));
                start
                    .into_iter()
                    .chain(self.programmed.shares(motion))
                    .collect()
            }
        }
    }

    /// The place at a share of a move, with what acts there.
    fn site(&self, i: usize, (share, end): (f64, bool)) -> Site {
        let motion = &self.path.moves[i];
        let desired = motion.point(share);
        Site {
            line: motion.line,
            move_index: i,
            output_line: 0,
            kind: kind(motion),
            share,
            path_mm: self.starts[i] + share * known_length(motion),
            start_mm: self.starts[i],
            programmed: true,
            desired,
            commanded: desired,
            orientation: motion.orientation(share),
            commanded_orientation: motion.orientation(share),
            commanded_deg: None,
            wrench: self.load.wrench(self.placement, i, share),
            other_wrench: None,
            end,
        }
    }

    /// All of them, one after the other.
    fn sites(self) -> impl Iterator<Item = Site> + 'a {
        let own = self.path.own_moves();
        own.flat_map(move |i| {
            let mut shares = self.shares(i);
            let motion = &self.path.moves[i];
            if motion.is_known_feed() && !shares.is_empty() && self.programmed.pieces(motion) == 1 {
                let inside = places_of_load(self.load, self.placement, i);
                shares.extend(inside.into_iter().map(|share| (share, false)));
                shares.sort_by(|a, b| a.0.total_cmp(&b.0));
                shares.dedup_by(|later, first| later.0 == first.0);
            }
            let sites = shares.into_iter().map(|place| self.site(i, place));
            sites.collect::<Vec<_>>()
        })
    }
}

/// The places of [`OfPath`], one after the other.
pub(crate) fn of_path<'a>(
    path: &'a Path,
    load: &'a LoadAlongPath<'a>,
    placement: &'a Placement,
    spacing_mm: f64,
) -> impl Iterator<Item = Site> + 'a {
    OfPath::new(path, load, placement, spacing_mm).sites()
}

/// Places at shares of moves, as the program is given; none on moves that lead nowhere, and the end of a rapid or of a move from
/// a place that the program does not state.
pub(crate) fn places_on_moves(
    task: &Task<'_>,
    load: &LoadAlongPath<'_>,
    chosen: &[(usize, f64)],
) -> Vec<Site> {
    let path = task.path();
    let of_path = OfPath::new(path, load, &task.placement, spacing_mm(task));
    let site = |(index, share): &(usize, f64)| {
        let motion = &path.moves[*index];
        let share = match (motion.known, motion.kind) {
            (Knowledge::Nothing, _) => return None,
            (Knowledge::Whole, MoveKind::Feed) if stays(motion) => return None,
            (Knowledge::Whole, MoveKind::Feed) => *share,
            _ => 1.0,
        };
        Some(of_path.site(*index, (share, share == 1.0)))
    };
    chosen.iter().filter_map(site).collect()
}

/// Seed of the irregular places: the division of blocks has another, so that what it overlooked is not
/// overlooked here too.
const SEED: u64 = 4;

/// Share of the spacing below which a block that was not divided is straight in every respect.
const SHORT: f64 = 0.05;

/// Ends of all pieces of a written program and irregular places inside them, no farther apart than twice
/// `spacing_mm`, the middles of pieces of divided blocks, and the places of the program as it is given
/// ([`of_path`] with the same spacing), one after the other; of blocks that were not divided the places where the load departs
/// from what their ends say. Blocks that are very short, were not divided and are under a steady load are all looked at where
/// they end, and inside as many as there is room for such pieces on their length, chosen without a pattern.
pub(crate) fn of_written<'a>(
    path: &'a Path,
    written: &'a Corrected,
    load: &'a LoadAlongPath<'a>,
    placement: &'a Placement,
    spacing_mm: f64,
) -> impl Iterator<Item = Site> + 'a {
    let starts = starts(path);
    let programmed = Programmed::new(path, spacing_mm);
    let pieces = written.pieces.iter().enumerate();
    // Before it the tool stands where nobody corrected it.
    let mut first = written.pieces.iter().position(|piece| piece.corrected);
    if !path.begins() {
        first = None;
    }
    pieces.flat_map(move |(index, piece)| {
        let motion = &path.moves[piece.move_index];
        let mut sites = Vec::new();
        if !piece.corrected || motion.known == Knowledge::Nothing || stays(motion) {
            return sites;
        }
        let width = piece.share_to - piece.share_from;
        let share_at = |place: f64| match place {
            1.0 => piece.share_to,
            _ => piece.share_from + place * width,
        };
        let turn = commanded_turn(path, written, index);
        let angles = commanded_angles(path, written, index);
        let circle = angles
            .as_ref()
            .and_then(|[from, to]| great_circle(motion, from, to));
        let mut push = |(place, share): (f64, f64),
                        (wrench, other_wrench): (Wrench, Option<Wrench>),
                        (end, programmed): (bool, bool)| {
            let commanded_deg: Option<Vec<f64>> = angles.as_ref().map(|[from, to]| {
                if let (Some(circle), Some(rotary), true) =
                    (&circle, rotary(motion), place > 0.0 && place < 1.0)
                {
                    return circle.angles_at(&rotary.axes, place);
                }
                let both = from.iter().zip(to);
                both.map(|(from, to)| from + (to - from) * place).collect()
            });
            sites.push(Site {
                line: motion.line,
                move_index: piece.move_index,
                output_line: piece.output_line,
                kind: match piece.corner_step {
                    true if piece.turn.is_some_and(|turn| turn.is_entry(path)) => PointKind::Entry,
                    true if Some(index) == first => PointKind::Entry,
                    true => PointKind::Corner,
                    false => kind(motion),
                },
                share,
                path_mm: starts[piece.move_index] + share * known_length(motion),
                start_mm: starts[piece.move_index],
                programmed,
                desired: motion.point(share),
                commanded: piece.commanded(motion, place),
                orientation: motion.orientation(share),
                // In G-code the words of rotary axes say it.
                commanded_orientation: match (&turn, &commanded_deg, rotary(motion)) {
                    (Some(turn), ..) => Some(turn.at(place)),
                    (None, Some(angles), Some(rotary)) => Some(rotary.axes.tool(angles)),
                    _ => motion.orientation(share),
                },
                commanded_deg,
                wrench,
                other_wrench,
                end,
            });
        };
        let number = (written.pieces_before() + index) as u64;
        let inside = |k: usize| irregular(SEED, number, k as u64);
        if let Some(turn) = piece.turn {
            // A load that does not turn with the step leaves it farthest where it begins or ends.
            for (place, end) in [(0.0, false), (inside(0), false), (1.0, true)] {
                let step = on_step(piece, &turn, place, load, placement);
                push((place, share_at(place)), step, (end, false));
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
        // At the end of a move every program is looked at.
        let mut at_end = piece.share_to >= 1.0;
        if motion.is_known_feed() {
            let length = motion.length_between_mm(piece.share_from, piece.share_to);
            let count = (length / spacing_mm).ceil().clamp(1.0, 1e4) as usize;
            let count = count.max(turns(motion, width).min(10_000));
            let count = match (&motion.curve, piece.is_fitted()) {
                // In each chord that would have been written, were it straight, an arc is looked at.
                (Curve::Arc(arc), true) => {
                    count.max((arc.chords_within(ARC_MM) as f64 * width).ceil() as usize)
                }
                _ => count,
            };
            let divided = piece.share_from > 0.0 || piece.share_to < 1.0;
            let is_line = motion.curve == Curve::Line;
            // What the load does inside a block shows at no end of it.
            let is_one = programmed.pieces(motion) == 1;
            let load_inside = match divided && !is_one {
                true => Vec::new(),
                false => places_of_load(load, placement, piece.move_index),
            };
            let is_passed_over = is_line
                && !divided
                && load_inside.is_empty()
                && inside(count) * programmed.short_mm > length;
            let count = if is_passed_over { 0 } else { count };
            let mut places: Vec<(f64, f64, bool)> = (0..count)
                .map(|k| (k as f64 + inside(k)) / count as f64)
                .map(|place| (place, share_at(place), false))
                .collect();
            if divided {
                // A piece leaves its block farthest near its middle; one of a block that was not
                // divided is looked at where the program is.
                places.push((0.5, share_at(0.5), false));
            }
            let of_load = load_inside.into_iter().map(|share| (share, is_one));
            if piece.share_from == 0.0 && jumps(path, load, placement, piece.move_index) {
                places.push((0.0, 0.0, true));
            }
            let of_program = programmed.shares(motion).map(|(share, _)| (share, true));
            for (share, programmed) in of_program.chain(of_load) {
                at_end |= programmed && share == piece.share_to;
                if share > piece.share_from && share < piece.share_to {
                    places.push(((share - piece.share_from) / width, share, programmed));
                }
            }
            places.sort_by(|a, b| a.1.total_cmp(&b.1).then(b.2.cmp(&a.2)));
            places.dedup_by(|later, first| later.1 == first.1);
            for (place, share, programmed) in places {
                push((place, share), at(share), (false, programmed));
            }
        }
        push((1.0, piece.share_to), at(piece.share_to), (true, at_end));
        sites
    })
}

/// Departure of the load from the straight line between the ends of a block, share of it, that is looked at.
const STRAIGHT: f64 = 1e-5;

/// Where a load inside a block is farthest from what its ends say: where it or its slope jumps and midway between, and in the
/// middle where it turns. None where it goes evenly from one end to the other.
fn places_of_load(load: &LoadAlongPath<'_>, placement: &Placement, index: usize) -> Vec<f64> {
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

/// How the written program turns the tool along a piece; none in a program of positions.
fn commanded_turn(path: &Path, written: &Corrected, index: usize) -> Option<ToolTurn> {
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

fn rotary(motion: &Move) -> Option<&RotaryTurn> {
    motion.tool_turn.as_ref()?.rotary.as_ref()
}

/// On which the tool's axis goes between the angles at both ends of a piece as written; none where each axis turns evenly.
fn great_circle(motion: &Move, from: &[f64], to: &[f64]) -> Option<GreatCircle> {
    let own = rotary(motion).filter(|own| own.great_circle.is_some())?;
    let tool_axis = own.axes.tool_at_zero.inverse() * Vector3::z();
    let direction = own.axes.tool_direction_at(to, &tool_axis);
    GreatCircle::new(&own.axes, from, &direction).ok()
}

/// Where the rotary axes stand at both ends of a piece as written, deg; none where they stand as in the program.
fn commanded_angles(path: &Path, written: &Corrected, index: usize) -> Option<[Vec<f64>; 2]> {
    let own = rotary(&path.moves[written.pieces[index].move_index])?;
    let to = written.rotary_deg.get(index)?.clone();
    let before = index
        .checked_sub(1)
        .map(|before| &written.rotary_deg[before]);
    let before = before.filter(|before| before.len() == to.len());
    let from = before.cloned().unwrap_or_else(|| own.angles_deg(0.0));
    Some([from, to])
}

fn kind(motion: &Move) -> PointKind {
    match motion.kind {
        MoveKind::Rapid => PointKind::Rapid,
        MoveKind::Feed => PointKind::Feed,
    }
}

/// Where a written program is looked at.
pub(crate) fn sites_of_written<'s>(
    task: &'s Task<'_>,
    load: &'s LoadAlongPath<'s>,
    written: &'s Corrected,
) -> impl Iterator<Item = Site> + 's {
    of_written(
        task.path(),
        written,
        load,
        &task.placement,
        spacing_mm(task),
    )
}

/// Length from which on a block is looked at in more places, mm of the program.
pub(crate) fn spacing_mm(task: &Task<'_>) -> f64 {
    SPACING * 1e3 * natural_length(task.mechanism) / task.placement.scale
}

/// Share of the natural length after which a long piece is looked at in one more place.
const SPACING: f64 = 1.0 / 16.0;
