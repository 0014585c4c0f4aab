//! Places at which a written program is evaluated.

use kinetostat::Wrench;
use kinetostat_program::{
    Corrected, Curve, GreatCircle, Knowledge, Move, Path, Piece, ToolTurn, irregular,
};

use crate::load::along_path::LoadAlongPath;
use crate::placement::Placement;
use crate::result::point::PointKind;
use crate::run::sites::of_path::{jumps, on_step, places_of_load};
use crate::run::sites::site::{
    ARC_MM, Programmed, Site, commanded_angles, commanded_turn, great_circle, kind, rotary,
    spacing_mm, starts, stays, turns,
};
use crate::task::Task;

/// Seed of the irregular places: the division of blocks has another, so that what it overlooked is not
/// overlooked here too.
const SEED: u64 = 4;

/// Ends of all pieces of a written program and irregular places inside them, no farther apart than twice the spacing,
/// the middles of pieces of divided blocks, and the places of the program as it is given
/// ([`crate::run::sites::of_path::sites_of_path`]), one after the other; of blocks that were not divided the
/// places where the load departs from what their ends say. Blocks that are very short, were not divided and are under a steady
/// load are all looked at where they end, and inside as many as there is room for such pieces on their length, chosen without a
/// pattern.
pub(crate) fn sites_of_written<'s>(
    task: &'s Task<'_>,
    load: &'s LoadAlongPath<'s>,
    written: &'s Corrected,
) -> impl Iterator<Item = Site> + 's {
    let path = task.path();
    // Before it the tool stands where nobody corrected it.
    let first = written.pieces.iter().position(|piece| piece.corrected);
    let spacing_mm = spacing_mm(task);
    let of_written = OfWritten {
        path,
        written,
        load,
        placement: &task.placement,
        spacing_mm,
        starts: starts(path),
        programmed: Programmed::new(path, spacing_mm),
        first: first.filter(|_| path.begins()),
    };
    let pieces = written.pieces.iter().enumerate();
    pieces.flat_map(move |(index, piece)| of_written.sites(index, piece))
}

struct OfWritten<'a> {
    path: &'a Path,
    written: &'a Corrected,
    load: &'a LoadAlongPath<'a>,
    placement: &'a Placement,
    spacing_mm: f64,
    starts: Vec<f64>,
    programmed: Programmed,
    /// The first piece that is corrected, at the beginning of a program.
    first: Option<usize>,
}

impl OfWritten<'_> {
    /// The places on a piece.
    fn sites(&self, index: usize, piece: &Piece) -> Vec<Site> {
        let motion = &self.path.moves[piece.move_index];
        if !piece.corrected || motion.known == Knowledge::Nothing || stays(motion) {
            return Vec::new();
        }
        let along = AlongPiece::new(self, index);
        let inside = |k: usize| {
            let number = (self.written.pieces_before() + index) as u64;
            irregular(SEED, number, k as u64)
        };
        if let Some(turn) = piece.turn {
            // A load that does not turn with the step leaves it farthest where it begins or ends.
            let places = [(0.0, false), (inside(0), false), (1.0, true)];
            let on = places.map(|(place, end)| {
                let (wrench, other) = on_step(piece, &turn, place, self.load, self.placement);
                along.site(&along.spot(place), wrench, other, end)
            });
            return on.into();
        }
        // At the end of a move every program is looked at.
        let mut end = Spot {
            programmed: piece.share_to >= 1.0,
            ..along.spot(1.0)
        };
        let mut spots = Vec::new();
        if motion.is_known_feed() {
            spots = self.inside(&along, &mut end, inside);
        }
        let [lowest, highest] = self.beside_steps(index, piece);
        let site = |spot: &Spot, is_end: bool| {
            let share = spot.share.max(lowest).min(highest);
            let wrench = self.load.wrench(self.placement, piece.move_index, share);
            along.site(spot, wrench, None, is_end)
        };
        let mut sites: Vec<Site> = spots.iter().map(|spot| site(spot, false)).collect();
        sites.push(site(&end, true));
        sites
    }

    /// Shares of the move between which the load of a piece is taken. Next to a jump of the load inside a move, the load is
    /// the one before it or after it: within the micrometre in which it is located it steps, it does not turn gradually.
    fn beside_steps(&self, index: usize, piece: &Piece) -> [f64; 2] {
        let step = |index: Option<usize>| {
            let beside = index.and_then(|index| self.written.pieces.get(index));
            let of_move = beside.filter(|other| other.move_index == piece.move_index);
            of_move.and_then(|other| other.turn)
        };
        [
            step(index.checked_sub(1)).map_or(0.0, |turn| turn.to_share),
            step(Some(index + 1)).map_or(1.0, |turn| turn.from_share),
        ]
    }

    /// The places on a piece at feed before its end, in order.
    fn inside(
        &self,
        along: &AlongPiece<'_>,
        end: &mut Spot,
        inside: impl Fn(usize) -> f64,
    ) -> Vec<Spot> {
        let AlongPiece { piece, motion, .. } = along;
        let divided = piece.share_from > 0.0 || piece.share_to < 1.0;
        // Variations of the load inside a block do not show at its ends.
        let pieces = self.programmed.pieces(motion);
        let is_one = pieces == 1;
        let of_load = match divided && !is_one {
            true => Vec::new(),
            false => places_of_load(self.load, self.placement, piece.move_index),
        };
        let count = self.count(along);
        let is_passed_over = motion.curve == Curve::Line
            && !divided
            && of_load.is_empty()
            && inside(count) * self.programmed.short_mm > along.length_mm;
        let count = if is_passed_over { 0 } else { count };
        let mut spots: Vec<Spot> = (0..count)
            .map(|k| along.spot((k as f64 + inside(k)) / count as f64))
            .collect();
        if divided {
            // A piece leaves its block farthest near its middle; one of a block that was not
            // divided is looked at where the program is.
            spots.push(along.spot(0.5));
        }
        if piece.share_from == 0.0 && jumps(self.path, self.load, self.placement, piece.move_index)
        {
            spots.push(Spot {
                programmed: true,
                ..along.spot(0.0)
            });
        }
        let of_program = self.programmed.shares(motion, pieces);
        let of_program = of_program.map(|(share, _)| (share, true));
        let of_load = of_load.into_iter().map(|share| (share, is_one));
        for (share, programmed) in of_program.chain(of_load) {
            end.programmed |= programmed && share == piece.share_to;
            if share > piece.share_from && share < piece.share_to {
                spots.push(Spot {
                    place: (share - piece.share_from) / along.width,
                    share,
                    programmed,
                });
            }
        }
        let order = |a: &Spot, b: &Spot| b.programmed.cmp(&a.programmed);
        spots.sort_by(|a, b| a.share.total_cmp(&b.share).then(order(a, b)));
        spots.dedup_by(|later, first| later.share == first.share);
        spots
    }

    /// Number of irregular places on a piece.
    fn count(&self, along: &AlongPiece<'_>) -> usize {
        let AlongPiece { piece, motion, .. } = along;
        let by_length = (along.length_mm / self.spacing_mm).ceil();
        let count = by_length.clamp(1.0, 1e4) as usize;
        let count = count.max(turns(motion, along.width).min(10_000));
        match (&motion.curve, piece.is_fitted()) {
            // In each chord that would have been written, were it straight, an arc is looked at.
            (Curve::Arc(arc), true) => {
                count.max((arc.chords_within(ARC_MM) as f64 * along.width).ceil() as usize)
            }
            _ => count,
        }
    }
}

/// A place on a piece.
pub(super) struct Spot {
    /// Share of the piece.
    pub place: f64,
    /// Share of its move.
    pub share: f64,
    /// See [`Site::programmed`].
    pub programmed: bool,
}

/// A piece with what is commanded along it.
pub(super) struct AlongPiece<'a> {
    pub piece: &'a Piece,
    pub motion: &'a Move,
    /// Share of its move that it is.
    pub width: f64,
    /// Length on a move at feed, mm.
    pub length_mm: f64,
    kind: PointKind,
    start_mm: f64,
    turn: Option<ToolTurn>,
    angles: Option<[Vec<f64>; 2]>,
    circle: Option<GreatCircle>,
}

impl<'a> AlongPiece<'a> {
    /// Piece `index` of a written program.
    fn new(of_written: &OfWritten<'a>, index: usize) -> Self {
        let OfWritten { path, written, .. } = *of_written;
        let piece = &written.pieces[index];
        let motion = &path.moves[piece.move_index];
        let angles = commanded_angles(path, written, index);
        let ends = angles.as_ref();
        Self {
            piece,
            motion,
            width: piece.share_to - piece.share_from,
            length_mm: match motion.is_known_feed() {
                true => motion.length_between_mm(piece.share_from, piece.share_to),
                false => 0.0,
            },
            kind: match piece.corner_step {
                true if piece.turn.is_some_and(|turn| turn.is_entry(path)) => PointKind::Entry,
                true if Some(index) == of_written.first => PointKind::Entry,
                true => PointKind::Corner,
                false => kind(motion),
            },
            start_mm: of_written.starts[piece.move_index],
            turn: commanded_turn(path, written, index),
            circle: ends.and_then(|[from, to]| great_circle(motion, from, to)),
            angles,
        }
    }

    /// A place of its own at a share of the piece.
    pub fn spot(&self, place: f64) -> Spot {
        Spot {
            place,
            share: match place {
                1.0 => self.piece.share_to,
                _ => self.piece.share_from + place * self.width,
            },
            programmed: false,
        }
    }

    /// Commanded angles of the rotary axes at a share of the piece, deg.
    fn degrees(&self, place: f64) -> Option<Vec<f64>> {
        let [from, to] = self.angles.as_ref()?;
        if let (Some(circle), Some(rotary), true) = (
            &self.circle,
            rotary(self.motion),
            place > 0.0 && place < 1.0,
        ) {
            return Some(circle.angles_at(&rotary.axes, place));
        }
        let both = from.iter().zip(to);
        Some(both.map(|(from, to)| from + (to - from) * place).collect())
    }

    /// A place with the load there, as chosen and by the other reading.
    pub fn site(
        &self,
        spot: &Spot,
        wrench: Wrench,
        other_wrench: Option<Wrench>,
        end: bool,
    ) -> Site {
        let (piece, motion) = (self.piece, self.motion);
        let &Spot {
            place,
            share,
            programmed,
        } = spot;
        let commanded_deg = self.degrees(place);
        Site {
            line: motion.line,
            move_index: piece.move_index,
            output_line: piece.output_line,
            kind: self.kind,
            share,
            path_mm: self.start_mm + share * motion.known_length_mm(),
            start_mm: self.start_mm,
            programmed,
            desired: motion.point(share),
            commanded: piece.commanded(motion, place),
            orientation: motion.orientation(share),
            // In G-code the words of rotary axes say it.
            commanded_orientation: match (&self.turn, &commanded_deg, rotary(motion)) {
                (Some(turn), ..) => Some(turn.at(place)),
                (None, Some(angles), Some(rotary)) => Some(rotary.axes.tool(angles)),
                _ => motion.orientation(share),
            },
            commanded_deg,
            wrench,
            other_wrench,
            end,
        }
    }
}
