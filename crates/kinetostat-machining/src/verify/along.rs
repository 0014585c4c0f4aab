//! The way of another program along its guide, from end to end.

use kinetostat::number::larger;
use kinetostat_program::{Arc, Curve, NominalPath, Path, Piece, Turn, WrittenCircle};

use crate::verify::matched::ExtraCut;
use crate::verify::on_guide::OnGuide;
use crate::verify::places::End;
use crate::verify::rapids::Reached;
use crate::verify::stretches::Stretches;

/// A move that is this many times as long as the original's way between its ends, or as short, does not follow it; beside this
/// length, mm, and this many times the largest correction: by so much steps at corners make a way longer.
const OTHER_LENGTH: (f64, f64, f64) = (1.5, 1.0, 4.0);

/// Maximum excess of a way over another that it belongs to, mm, by steps at corners.
pub(crate) fn beside_mm(shift_mm: f64) -> f64 {
    let (_, steps_mm, corrections) = OTHER_LENGTH;
    steps_mm + corrections * shift_mm
}

/// The way of another program along its guide.
pub(crate) struct Along<'a> {
    pub(crate) original: &'a Path,
    pub(crate) other: &'a Path,
    pub(crate) nominal: &'a NominalPath<'a>,
    pub(crate) stretches: &'a Stretches<'a>,
    /// The largest correction, mm.
    pub(crate) shift_mm: f64,
    pub(crate) pieces: Vec<Followed>,
    /// Lengths along the guide between which the passes go, mm.
    pub(crate) covered: Vec<[f64; 2]>,
    /// Passes from rapid to rapid of the other program.
    pub(crate) passes: Vec<[Reached; 2]>,
    pub(crate) extra_cuts: Vec<ExtraCut>,
}

impl Along<'_> {
    /// Goes from end to end.
    pub(crate) fn go(&mut self, ends: &[End], places: &[Option<OnGuide>]) {
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
                self.reach(end, [at, at], None);
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
            self.reach(end, [place.arrives_mm.min(at), at], Some(place.piece));
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
            covered[1] = larger(covered[1], to);
        }
        if leaves_out {
            self.covered.push([place.leaves_mm; 2]);
        }
    }

    /// A pass of the other program has come to a place of the guide.
    fn reach(&mut self, end: &End, [arrives_mm, along_mm]: [f64; 2], piece: Option<usize>) {
        let before = self.passes.last().map_or(0, |pass| pass[1].pass);
        let pass = piece.map_or(before, |piece| self.stretches.pass_of_piece(piece));
        let there = Reached {
            along_mm,
            arrives_mm,
            pass,
        };
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
            cut_mm: end.cut_mm - self.length_mm(end),
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
            cut_mm: end.cut_mm,
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

    /// True if a part of a move is no part of the original: it leaves out a way of that, or crosses where that lifts the tool.
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

    /// Begins a pass: a place without a correction of its own.
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

/// A piece of the other program with the move of it that it is a part of.
pub(crate) struct Followed {
    pub(crate) piece: Piece,
    /// Index of the move in the other program, and the share of it at which the piece ends.
    pub(crate) other_end: (usize, f64),
    /// The share of it at which the piece begins.
    pub(crate) other_from: f64,
    /// True if its end is fixed: the load turns there, or it is where a move of the original was found again.
    pub(crate) is_held: bool,
    /// A part of a move that the original makes just so.
    pub(crate) is_same: bool,
}
