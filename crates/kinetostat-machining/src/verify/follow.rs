//! Another program along its guide: pieces of it, each of which belongs to a part of one move of the original.

use kinetostat_program::{
    Arc, Corrected, Curve, Foot, NominalPath, Path, Piece, Turn, WrittenCircle,
};

use crate::task::{NoMotion, RunError};
use crate::verify::matched::{ExtraCut, Matched};
use crate::verify::on_guide::{OnGuide, Search};
use crate::verify::places::{End, ends, feet};
use crate::verify::rapids::{Reached, elsewhere, largest_shift_mm, without_air};
use crate::verify::stretches::Stretches;
use crate::verify::uncut::uncut;

/// An end this near to where the original goes on to another move lies there, mm; or if the program is farther from the guide, as
/// near as that.
const AT_CORNER_MM: f64 = 0.002;

/// Distances of this many times that of three quarters of the ends stand out.
const OUTSTANDING: f64 = 5.0;

/// A move that is this many times as long as the original's way between its ends, or as short, does not follow it; beside this
/// length, mm, and this many times the largest correction: by so much steps at corners make a way longer.
const OTHER_LENGTH: (f64, f64, f64) = (1.5, 1.0, 4.0);

/// A piece of the other program with the move of it that it is a part of.
pub(crate) struct Followed {
    pub(crate) piece: Piece,
    /// Index of the move in the other program, and the share of it at which the piece ends.
    pub(crate) other_end: (usize, f64),
    /// The share of it at which the piece begins.
    pub(crate) other_from: f64,
    /// Its end is where it is: the load turns there, or it is where a move of the original was found again.
    pub(crate) is_held: bool,
    /// A part of a move that the original makes just so.
    pub(crate) is_same: bool,
}

/// Pieces of the other program along the guide, which was written from the original, and how it belongs to that.
pub(crate) fn follow(
    original: &Path,
    guide: &Corrected,
    other: &Path,
) -> Result<(Vec<Followed>, Matched), RunError> {
    let nothing = |_| RunError::NoMotion(NoMotion::NoLength);
    let guide_path = guide.path(original);
    let nominal = NominalPath::new(&guide_path).map_err(nothing)?;
    let shift_mm = largest_shift_mm(original, guide);
    let as_it_is = NominalPath::new(original).map_err(nothing)?;
    let other = &*without_air(&as_it_is, &nominal, (other, shift_mm));
    let of_other = NominalPath::new(other).map_err(nothing)?;
    let ends = ends(&of_other);
    let feet = feet(&nominal, other, &ends)?;
    let far = |index: usize| feet[index].map_or(0.0, |foot| foot.distance_mm);
    let farthest = (0..ends.len()).max_by(|a, b| far(*a).total_cmp(&far(*b)));
    let farthest = farthest.unwrap_or(0);
    let stretches = Stretches::of(guide, &nominal);
    let near_mm = usual_distance_mm(&feet).max(AT_CORNER_MM);
    let search = Search {
        stretches: &stretches,
        original,
        other,
        near_mm,
        beside_mm: beside_mm(shift_mm),
    };
    let places = search.places(&ends, &feet);
    let mut along = Along {
        original,
        other,
        stretches: &stretches,
        shift_mm,
        nominal: &nominal,
        pieces: Vec::new(),
        covered: Vec::new(),
        passes: Vec::new(),
        extra_cuts: Vec::new(),
    };
    along.go(&ends, &places);
    let with = (&of_other, along.passes.as_slice());
    let rapids = elsewhere((original, guide, &nominal), with, shift_mm);
    let matched = Matched {
        largest_distance_mm: far(farthest),
        largest_distance_line: other.moves[ends[farthest].move_index].line,
        uncut: uncut(original, (&nominal, guide), &along.covered),
        rapids,
        extra_cuts: along.extra_cuts,
        conditions: Vec::new(),
    };
    Ok((along.pieces, matched))
}

/// The largest distance from the guide but for those that stand out: one wrong block says nothing of how near the others are.
fn usual_distance_mm(feet: &[Option<Foot>]) -> f64 {
    let feet = feet.iter().flatten();
    let mut distances: Vec<f64> = feet.map(|foot| foot.distance_mm).collect();
    distances.sort_by(f64::total_cmp);
    let three_quarters = distances.get(distances.len() * 3 / 4).copied();
    let most = (OUTSTANDING * three_quarters.unwrap_or(0.0)).max(AT_CORNER_MM);
    let usual = distances.iter().rev().find(|distance| **distance <= most);
    usual.copied().unwrap_or(0.0)
}

/// How much longer a way may be than another that it belongs to, mm, by steps at corners.
fn beside_mm(shift_mm: f64) -> f64 {
    let (_, steps_mm, corrections) = OTHER_LENGTH;
    steps_mm + corrections * shift_mm
}

struct Along<'a> {
    original: &'a Path,
    other: &'a Path,
    nominal: &'a NominalPath<'a>,
    stretches: &'a Stretches<'a>,
    /// The largest correction, mm.
    shift_mm: f64,
    pieces: Vec<Followed>,
    /// Lengths along the guide between which the passes go, mm.
    covered: Vec<[f64; 2]>,
    /// The same from rapid to rapid of the other program.
    passes: Vec<[Reached; 2]>,
    extra_cuts: Vec<ExtraCut>,
}

impl Along<'_> {
    fn go(&mut self, ends: &[End], places: &[Option<OnGuide>]) {
        let mut at = 0.0;
        // The tool is on the original.
        let mut is_on = false;
        for (index, end) in ends.iter().enumerate() {
            is_on &= !end.begins_pass;
            let Some(place) = places[index] else {
                if !end.begins_pass {
                    self.push_extra_cut(end);
                }
                is_on = false;
                self.reach(end, at, None);
                continue;
            };
            let is_inside = end.shares[1] < 1.0 && !end.begins_pass;
            match place.same_as {
                Some(_) if is_inside => continue,
                Some(same) => {
                    if !is_on {
                        self.begin_same(end, same, place.piece);
                    }
                    self.same(end, same);
                    at = place.leaves_mm.max(at);
                }
                None if is_on && !self.goes_elsewhere(end, [at, place.arrives_mm]) => {
                    let to = place.arrives_mm.max(at);
                    self.part(end, [at, to], place.piece);
                    at = place.leaves_mm.max(to);
                }
                None => {
                    if !end.begins_pass {
                        self.push_extra_cut(end);
                    }
                    at = place.leaves_mm;
                    self.begin(end, at, place.piece);
                    self.covered.push([place.arrives_mm; 2]);
                }
            }
            is_on = true;
            if place.leaves_mm > place.arrives_mm
                && let Some(last) = self.pieces.last_mut()
            {
                last.is_held = true;
            }
            self.cover(&place, at);
            self.reach(end, at, Some(place.piece));
        }
    }

    fn push_extra_cut(&mut self, end: &End) {
        self.extra_cuts.push(ExtraCut {
            line: self.other.moves[end.move_index].line,
            length_mm: self.length_mm(end),
        });
    }

    /// The program has come to a place; where it goes on behind one that is farther than any step, what lies between is not cut.
    fn cover(&mut self, place: &OnGuide, at: f64) {
        let leaves_out = place.leaves_mm - place.arrives_mm > beside_mm(self.shift_mm);
        let to = if leaves_out { place.arrives_mm } else { at };
        if let Some(covered) = self.covered.last_mut() {
            covered[1] = covered[1].max(to);
        }
        if leaves_out {
            self.covered.push([place.leaves_mm; 2]);
        }
    }

    /// A pass of the other program has come to a place of the guide.
    fn reach(&mut self, end: &End, along_mm: f64, piece: Option<usize>) {
        let before = self.passes.last().map_or(0, |pass| pass[1].pass);
        let pass = piece.map_or(before, |piece| self.stretches.pass_of_piece(piece));
        let there = Reached { along_mm, pass };
        match self.passes.last_mut().filter(|_| !end.begins_pass) {
            None => self.passes.push([there, there]),
            Some(pass) => pass[1] = there,
        }
    }

    /// The tool comes back to the original where a move of it begins.
    fn begin_same(&mut self, end: &End, same: usize, piece: usize) {
        let begins = self.stretches.span_mm(same).map_or(0.0, |span| span[0]);
        let start = End {
            move_index: end.move_index,
            shares: [0.0; 2],
            begins_pass: true,
            position: self.other.moves[end.move_index].start,
        };
        self.begin(&start, begins, piece);
        self.covered.push([begins; 2]);
    }

    /// A move of the original that the other program makes just so.
    fn same(&mut self, end: &End, same: usize) {
        let whole = End {
            move_index: end.move_index,
            shares: [0.0, 1.0],
            begins_pass: false,
            position: end.position,
        };
        for index in self.stretches.along_move(same).into_iter().flatten() {
            let stretch = &self.stretches.all[index];
            if !stretch.turns {
                let along_mm = stretch.along_mm;
                let shares = along_mm.map(|at| self.stretches.place(index, at).1);
                self.push(&whole, index, along_mm, shares);
                if let Some(last) = self.pieces.last_mut() {
                    (last.is_held, last.is_same) = (true, true);
                }
            }
        }
    }

    fn length_mm(&self, end: &End) -> f64 {
        let [from, to] = end.shares;
        self.other.moves[end.move_index].length_between_mm(from, to)
    }

    /// Whether a part of a move is no part of the original: it leaves a way of that out, or crosses where that lifts the tool.
    fn goes_elsewhere(&self, end: &End, [from, to]: [f64; 2]) -> bool {
        let times = OTHER_LENGTH.0;
        let beside_mm = beside_mm(self.shift_mm);
        let (own, way) = (self.length_mm(end), to - from);
        let leaves_out = way > times * own + beside_mm;
        // Just inside: where passes meet both are at the same length.
        let pass = |at: f64| {
            let at = at.clamp(0.0, self.nominal.length_mm());
            let (piece, _) = self.nominal.at_length(at);
            self.nominal.pieces()[piece].pass
        };
        let crosses = own > times * way + beside_mm && pass(from - 0.01) != pass(to + 0.01);
        leaves_out || crosses
    }

    /// Where a pass begins: a place without a correction of its own.
    fn begin(&mut self, end: &End, at: f64, piece: usize) {
        let stretch = self.stretches.at(at, piece);
        let (move_index, share, _) = self.stretches.place(stretch, at);
        self.pieces.push(Followed {
            piece: Piece::uncorrected(
                move_index,
                [share; 2],
                [end.position; 2],
                self.other.moves[end.move_index].line,
            ),
            other_end: (end.move_index, end.shares[1]),
            other_from: end.shares[0],
            is_held: false,
            is_same: false,
        });
    }

    /// A part of a move of the other program between two lengths along the guide, divided where stretches meet.
    fn part(&mut self, end: &End, [from, to]: [f64; 2], piece: usize) {
        if to <= from {
            let stretch = self.stretches.at(to, piece);
            self.push(end, stretch, [from, to], [0.0, 1.0]);
            return;
        }
        let first = self.stretches.from(from);
        let mut begun = 0.0;
        for index in first..self.stretches.all.len() {
            let [begins, ends] = self.stretches.all[index].along_mm;
            if index > first && begins >= to {
                break;
            }
            let done = match to > from && ends < to {
                true => (ends - from) / (to - from),
                false => 1.0,
            };
            self.push(end, index, [from.max(begins), to.min(ends)], [begun, done]);
            begun = done;
        }
    }

    fn push(&mut self, end: &End, stretch: usize, along_mm: [f64; 2], done: [f64; 2]) {
        let [from, to] = along_mm.map(|at| self.stretches.place(stretch, at));
        let motion = &self.other.moves[end.move_index];
        let [begins, ends] = end.shares;
        let [share_from, share_to] = done.map(|done| begins + done * (ends - begins));
        let turn = from.2.zip(to.2).map(|(from, to)| Turn {
            part_from: from.part_to,
            ..to
        });
        let arc = |arc: &Arc| WrittenCircle {
            curve: arc.between([share_from, share_to]),
            slip: [0.0, 0.0],
        };
        self.pieces.push(Followed {
            piece: Piece {
                corner_step: turn.is_some(),
                turn,
                corrected: self.original.moves[to.0].is_known_feed(),
                circle: match &motion.curve {
                    Curve::Line => None,
                    Curve::Arc(of_move) => Some(arc(of_move)),
                },
                ..Piece::uncorrected(
                    to.0,
                    [from.1, to.1],
                    [share_from, share_to].map(|share| motion.point(share)),
                    motion.line,
                )
            },
            other_end: (end.move_index, share_to),
            other_from: share_from,
            is_held: false,
            is_same: false,
        });
    }
}
