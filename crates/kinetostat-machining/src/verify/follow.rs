//! Another program along its guide: pieces of it, each of which belongs to a part of one move of the original.

use kinetostat_program::{
    Arc, Corrected, Curve, Foot, NominalPath, Path, Piece, Turn, WrittenCircle,
};

use crate::task::{NoMotion, RunError};
use crate::verify::matched::{ExtraCut, Matched};
use crate::verify::places::{End, ends, feet};
use crate::verify::rapids::{Reached, elsewhere, largest_shift_mm, without_air};
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
    let far = |a: &usize, b: &usize| feet[*a].distance_mm.total_cmp(&feet[*b].distance_mm);
    let farthest = (0..ends.len()).max_by(far).unwrap_or(0);
    let mut along = Along {
        original,
        other,
        guide,
        stretches: stretches(guide, &nominal),
        near_mm: usual_distance_mm(&feet).max(AT_CORNER_MM),
        shift_mm,
        nominal: &nominal,
        pieces: Vec::new(),
        covered: Vec::new(),
        passes: Vec::new(),
        extra_cuts: Vec::new(),
    };
    along.go(&ends, &feet);
    let with = (&of_other, along.passes.as_slice());
    let rapids = elsewhere((original, guide, &nominal), with, shift_mm);
    let matched = Matched {
        largest_distance_mm: feet[farthest].distance_mm,
        largest_distance_line: other.moves[ends[farthest].move_index].line,
        uncut: uncut(original, (&nominal, guide), &along.covered),
        rapids,
        extra_cuts: along.extra_cuts,
    };
    Ok((along.pieces, matched))
}

/// The largest distance from the guide but for those that stand out: one wrong block says nothing of how near the others are.
fn usual_distance_mm(feet: &[Foot]) -> f64 {
    let mut distances: Vec<f64> = feet.iter().map(|foot| foot.distance_mm).collect();
    distances.sort_by(f64::total_cmp);
    let three_quarters = distances.get(distances.len() * 3 / 4).copied();
    let most = (OUTSTANDING * three_quarters.unwrap_or(0.0)).max(AT_CORNER_MM);
    let usual = distances.iter().rev().find(|distance| **distance <= most);
    usual.copied().unwrap_or(0.0)
}

/// A part of the guide along one move of the original, or at one place of it where the load turns.
struct Stretch {
    /// Indices of its pieces in the nominal path of the guide.
    pieces: std::ops::Range<usize>,
    /// Where it begins and ends along that, mm.
    along_mm: [f64; 2],
    turns: bool,
}

fn stretches(guide: &Corrected, nominal: &NominalPath<'_>) -> Vec<Stretch> {
    let mut stretches: Vec<Stretch> = Vec::new();
    let of = |index: usize| &guide.pieces[nominal.pieces()[index].move_index];
    for (index, own) in nominal.pieces().iter().enumerate() {
        let piece = of(index);
        let end_mm = own.from_mm + own.length_mm;
        match stretches.last_mut() {
            Some(last)
                if last.turns == piece.turn.is_some()
                    && of(last.pieces.start).move_index == piece.move_index
                    && nominal.pieces()[last.pieces.start].pass == own.pass =>
            {
                last.pieces.end = index + 1;
                last.along_mm[1] = end_mm;
            }
            _ => stretches.push(Stretch {
                pieces: index..index + 1,
                along_mm: [own.from_mm, end_mm],
                turns: piece.turn.is_some(),
            }),
        }
    }
    stretches
}

struct Along<'a> {
    original: &'a Path,
    other: &'a Path,
    guide: &'a Corrected,
    nominal: &'a NominalPath<'a>,
    stretches: Vec<Stretch>,
    near_mm: f64,
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
    fn go(&mut self, ends: &[End], feet: &[Foot]) {
        let mut at = 0.0;
        for (end, foot) in ends.iter().zip(feet) {
            let to = self.at_corner(foot);
            let follows = !end.begins_pass && !self.goes_elsewhere(end, [at, to]);
            match self.covered.last_mut().filter(|_| follows) {
                None => {
                    if !end.begins_pass {
                        self.extra_cuts.push(ExtraCut {
                            line: self.other.moves[end.move_index].line,
                            length_mm: self.length_mm(end),
                        });
                    }
                    self.begin(end, to, foot.piece);
                    at = to;
                    self.covered.push([to, to]);
                }
                Some(covered) => {
                    let to = to.max(at);
                    covered[1] = to;
                    self.part(end, [at, to], foot.piece);
                    at = to;
                }
            }
            let there = Reached {
                along_mm: at,
                pass: self.nominal.pieces()[foot.piece].pass,
            };
            match self.passes.last_mut().filter(|_| !end.begins_pass) {
                None => self.passes.push([there, there]),
                Some(pass) => pass[1] = there,
            }
        }
    }

    fn length_mm(&self, end: &End) -> f64 {
        let [from, to] = end.shares;
        self.other.moves[end.move_index].length_between_mm(from, to)
    }

    /// Whether a part of a move is no part of the original: it leaves a way of that out, or crosses where that lifts the tool.
    fn goes_elsewhere(&self, end: &End, [from, to]: [f64; 2]) -> bool {
        let (times, steps_mm, corrections) = OTHER_LENGTH;
        let beside_mm = steps_mm + corrections * self.shift_mm;
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

    /// The nearest end of a stretch, if there is one as near as the program is to its guide.
    fn at_corner(&self, foot: &Foot) -> f64 {
        let along_mm = foot.along_mm;
        let after = self
            .stretches
            .partition_point(|stretch| stretch.along_mm[1] < along_mm);
        let Some(stretch) = self.stretches.get(after) else {
            return self.nominal.length_mm();
        };
        // On a short stretch no farther than to its nearer end.
        let near = (self.near_mm)
            .max(foot.distance_mm)
            .min(0.5 * (stretch.along_mm[1] - stretch.along_mm[0]));
        let ends = stretch.along_mm.into_iter();
        let nearest = ends.min_by(|a, b| (a - along_mm).abs().total_cmp(&(b - along_mm).abs()));
        nearest
            .filter(|end| (end - along_mm).abs() <= near)
            .unwrap_or(along_mm)
    }

    /// Where a pass begins: a place without a correction of its own.
    fn begin(&mut self, end: &End, at: f64, piece: usize) {
        let stretch = self.stretch_at(at, piece);
        let (move_index, share, _) = self.place(stretch, at);
        self.pieces.push(Followed {
            piece: Piece::uncorrected(
                move_index,
                [share; 2],
                [end.position; 2],
                self.other.moves[end.move_index].line,
            ),
            other_end: (end.move_index, end.shares[1]),
        });
    }

    /// A part of a move of the other program between two lengths along the guide, divided where stretches meet.
    fn part(&mut self, end: &End, [from, to]: [f64; 2], piece: usize) {
        if to <= from {
            let stretch = self.stretch_at(to, piece);
            self.push(end, stretch, [from, to], [0.0, 1.0]);
            return;
        }
        let first = self.stretch_from(from);
        let mut begun = 0.0;
        for index in first..self.stretches.len() {
            let [begins, ends] = self.stretches[index].along_mm;
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

    /// The stretch of a place that was found on a piece of the guide. Where one pass ends another begins at the same length, and the
    /// piece tells which of them it is.
    fn stretch_at(&self, along_mm: f64, piece: usize) -> usize {
        let pieces = self.nominal.pieces();
        let usual = self.stretch_from(along_mm);
        let pass = |stretch: &Stretch| pieces[stretch.pieces.start].pass;
        if pass(&self.stretches[usual]) == pieces[piece].pass {
            return usual;
        }
        let behind = |stretch: &Stretch| stretch.pieces.end <= piece;
        self.stretches.partition_point(behind)
    }

    /// The stretch in which a way begins.
    fn stretch_from(&self, along_mm: f64) -> usize {
        let after = self
            .stretches
            .partition_point(|stretch| stretch.along_mm[1] <= along_mm);
        after.min(self.stretches.len() - 1)
    }

    /// Move and share of the original at a length along the guide in a stretch, and how much of the load's turn is done there.
    fn place(&self, stretch: usize, along_mm: f64) -> (usize, f64, Option<Turn>) {
        let pieces = self.stretches[stretch].pieces.clone();
        let all = self.nominal.pieces();
        let after = all[pieces.clone()].partition_point(|piece| piece.from_mm <= along_mm);
        let own = &all[(pieces.start + after).saturating_sub(1).max(pieces.start)];
        let part = ((along_mm - own.from_mm) / own.length_mm).clamp(0.0, 1.0);
        let piece = &self.guide.pieces[own.move_index];
        let between = |from: f64, to: f64| from + part * (to - from);
        let turn = piece.turn.map(|turn| Turn {
            part_to: between(turn.part_from, turn.part_to),
            ..turn
        });
        (
            piece.move_index,
            between(piece.share_from, piece.share_to),
            turn,
        )
    }

    fn push(&mut self, end: &End, stretch: usize, along_mm: [f64; 2], done: [f64; 2]) {
        let [from, to] = along_mm.map(|at| self.place(stretch, at));
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
        });
    }
}
