//! The guide as stretches: parts of it along one move of the original, and places where the load turns.

use std::collections::BTreeMap;

use kinetostat_program::{Corrected, FeedPiece, Foot, NominalPath, Path, Turn};
use nalgebra::Vector3;

use crate::verify::matched::Uncut;

/// A part of the guide along one move of the original, or at one place of it where the load turns.
pub(crate) struct Stretch {
    /// Indices of its pieces in the nominal path of the guide.
    pub(crate) pieces: std::ops::Range<usize>,
    /// Start and end along that, mm.
    pub(crate) along_mm: [f64; 2],
    pub(crate) turns: bool,
    /// Index of the move of the original.
    pub(crate) move_index: usize,
    /// The pass of the guide that it is a part of.
    pub(crate) pass: usize,
}

impl Stretch {
    fn length_mm(&self) -> f64 {
        self.along_mm[1] - self.along_mm[0]
    }
}

/// All stretches of a guide in their order.
pub(crate) struct Stretches<'a> {
    guide: &'a Corrected,
    nominal: &'a NominalPath<'a>,
    pub(crate) all: Vec<Stretch>,
    /// First and last of those that go along a move of the original, by its index.
    of_move: BTreeMap<usize, [usize; 2]>,
}

impl<'a> Stretches<'a> {
    pub(crate) fn of(guide: &'a Corrected, nominal: &'a NominalPath<'a>) -> Self {
        let mut all: Vec<Stretch> = Vec::new();
        for (index, own) in nominal.pieces().iter().enumerate() {
            let piece = &guide.pieces[own.move_index];
            let end_mm = own.from_mm + own.length_mm;
            match all.last_mut() {
                Some(last)
                    if last.turns == piece.turn.is_some()
                        && last.move_index == piece.move_index
                        && last.pass == own.pass =>
                {
                    last.pieces.end = index + 1;
                    last.along_mm[1] = end_mm;
                }
                _ => all.push(Stretch {
                    pieces: index..index + 1,
                    along_mm: [own.from_mm, end_mm],
                    turns: piece.turn.is_some(),
                    move_index: piece.move_index,
                    pass: own.pass,
                }),
            }
        }
        let mut of_move: BTreeMap<usize, [usize; 2]> = BTreeMap::new();
        for (index, stretch) in all.iter().enumerate().filter(|(_, s)| !s.turns) {
            let both = of_move.entry(stretch.move_index).or_insert([index; 2]);
            both[1] = index;
        }
        Self {
            guide,
            nominal,
            all,
            of_move,
        }
    }

    /// Place of the guide at a share of a move of the original, and distance of a point from there; `None` for a move that the guide
    /// does not make.
    pub(crate) fn foot(&self, move_index: usize, share: f64, point: &Vector3<f64>) -> Option<Foot> {
        let [first, last] = *self.of_move.get(&move_index)?;
        let [begins, ends] = [self.all[first].along_mm[0], self.all[last].along_mm[1]];
        let along_mm = begins + share * (ends - begins);
        let range = self.all[first].pieces.start..self.all[last].pieces.end;
        let ends_before = |piece: &FeedPiece| piece.from_mm + piece.length_mm < along_mm;
        let behind = self.nominal.pieces()[range.clone()].partition_point(ends_before);
        let piece = (range.start + behind).min(range.end - 1);
        let own = &self.nominal.pieces()[piece];
        let share = match own.length_mm > 0.0 {
            true => ((along_mm - own.from_mm) / own.length_mm).clamp(0.0, 1.0),
            false => 1.0,
        };
        let motion = self.nominal.motion(own);
        let place_mm = motion.point(share);
        Some(Foot {
            piece,
            share,
            along_mm,
            place_mm,
            tangent: motion.tangent(share).unwrap_or_else(Vector3::zeros),
            distance_mm: (point - place_mm).norm(),
        })
    }

    /// The first piece of the guide along a move of the original.
    pub(crate) fn first_piece(&self, move_index: usize) -> Option<usize> {
        let [first, _] = self.of_move.get(&move_index)?;
        Some(self.all[*first].pieces.start)
    }

    /// The pass of a piece of the guide.
    pub(crate) fn pass_of_piece(&self, piece: usize) -> usize {
        self.nominal.pieces()[piece].pass
    }

    /// Range of stretches along a move of the original; `None` for a move that the guide does not make.
    pub(crate) fn along_move(&self, move_index: usize) -> Option<std::ops::RangeInclusive<usize>> {
        let [first, last] = self.of_move.get(&move_index)?;
        Some(*first..=*last)
    }

    /// Start and end of the guide along a move of the original, mm.
    pub(crate) fn span_mm(&self, move_index: usize) -> Option<[f64; 2]> {
        let [first, last] = self.of_move.get(&move_index)?;
        Some([self.all[*first].along_mm[0], self.all[*last].along_mm[1]])
    }

    /// The nearest end of a stretch, if there is one as near as the program is to its guide: along the guide, and along the original,
    /// of which a compensated path that turns back upon itself shows little.
    pub(crate) fn at_corner(&self, foot: &Foot, near_mm: f64, original: &Path) -> f64 {
        let along_mm = foot.along_mm;
        let ends_before = |stretch: &Stretch| stretch.along_mm[1] < along_mm;
        let after = self.all.partition_point(ends_before);
        let Some(stretch) = self.all.get(after) else {
            return self.nominal.length_mm();
        };
        let near_mm = near_mm.max(foot.distance_mm);
        // On a short stretch no farther than to its nearer end.
        let near_on_guide_mm = near_mm.min(0.5 * stretch.length_mm());
        let ends = stretch.along_mm.into_iter();
        let nearest = ends.min_by(|a, b| (a - along_mm).abs().total_cmp(&(b - along_mm).abs()));
        let is_near = |end: f64| {
            let [here, there] = [along_mm, end].map(|at| self.place(after, at).1);
            let length_mm = original.moves[stretch.move_index].length_mm();
            (end - along_mm).abs() <= near_on_guide_mm
                && (there - here).abs() * length_mm <= near_mm
        };
        nearest.filter(|end| is_near(*end)).unwrap_or(along_mm)
    }

    /// The end of the cut on which a place lies, if the place is no farther before it than what may be left out, mm along the guide: a
    /// cut that ends there ends too early by an error of the tool at that end, which the tolerance is for.
    pub(crate) fn at_end(&self, foot: &Foot) -> Option<f64> {
        let [begins, ends] = self.nominal.passes()[self.pass_of_piece(foot.piece)].along_mm;
        // On a short cut no farther than to its nearer end.
        let within_mm = LEAST_MM.min(0.5 * (ends - begins));
        (ends - foot.along_mm <= within_mm).then_some(ends)
    }

    /// Turn of the load at a place of a pass, mm along the guide.
    pub(crate) fn turn_at(&self, along_mm: f64, pass: usize) -> Option<[f64; 2]> {
        let first = (self.all).partition_point(|stretch| stretch.along_mm[1] < along_mm);
        let here = self.all[first..].iter();
        let here = here.take_while(|stretch| stretch.along_mm[0] <= along_mm);
        let mut turns = here.filter(|stretch| stretch.turns && stretch.pass == pass);
        turns.next().map(|stretch| stretch.along_mm)
    }

    /// The stretch of a place that was found on a piece of the guide. At the end of a pass another begins at the same length, and
    /// the piece tells which of them it is.
    pub(crate) fn at(&self, along_mm: f64, piece: usize) -> usize {
        let pieces = self.nominal.pieces();
        let usual = self.from(along_mm);
        if self.all[usual].pass == pieces[piece].pass {
            return usual;
        }
        let behind = |stretch: &Stretch| stretch.pieces.end <= piece;
        self.all.partition_point(behind)
    }

    /// The stretch in which a way begins.
    pub(crate) fn from(&self, along_mm: f64) -> usize {
        let ends_before = |stretch: &Stretch| stretch.along_mm[1] <= along_mm;
        self.all
            .partition_point(ends_before)
            .min(self.all.len() - 1)
    }

    /// Move and share of the original at a length along the guide in a stretch, and how much of the load's turn is done there.
    pub(crate) fn place(&self, stretch: usize, along_mm: f64) -> (usize, f64, Option<Turn>) {
        let pieces = self.all[stretch].pieces.clone();
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
}

/// Smallest length at an end of a pass, mm, that is a part left out: the tool is off by as much there.
pub(crate) const LEAST_MM: f64 = 0.05;

/// Smallest length inside a pass, mm, where the original goes on cutting and the program makes a rapid, that is more than the rounding
/// of ends; or twice the distance of the program from its guide.
const LEAST_INSIDE_MM: f64 = 0.002;

/// The compensated original, along which another program is followed.
pub(crate) struct Guide<'a> {
    pub(crate) original: &'a Path,
    pub(crate) written: &'a Corrected,
    /// The path as it was written.
    pub(crate) nominal: &'a NominalPath<'a>,
}

impl Guide<'_> {
    /// Line of the original at a length along the guide.
    fn line(&self, along_mm: f64) -> usize {
        let (index, _) = self.nominal.at_length(along_mm);
        let piece = &self.written.pieces[self.nominal.pieces()[index].move_index];
        self.original.moves[piece.move_index].line
    }
}

/// The parts of the guide that no pass of the program covers; `covered` are the lengths along the guide at which each begins and ends,
/// in their order, and `near_mm` is how near the program usually is to the guide.
pub(crate) fn uncut(guide: &Guide<'_>, covered: &[[f64; 2]], near_mm: f64) -> Vec<Uncut> {
    let nominal = guide.nominal;
    let inside_mm = LEAST_INSIDE_MM.max(2.0 * near_mm).min(LEAST_MM);
    let is_inside = |from: f64, to: f64| {
        nominal.passes().iter().any(|pass| {
            let [begins, ends] = pass.along_mm;
            begins + LEAST_MM < from && to < ends - LEAST_MM
        })
    };
    let least_mm = |from: f64, to: f64| match is_inside(from, to) {
        true => inside_mm,
        false => LEAST_MM,
    };
    let ends = covered.iter().map(|stretch| stretch[1]);
    let from = std::iter::once(0.0).chain(ends);
    let begins = covered.iter().map(|stretch| stretch[0]);
    let to = begins.chain(std::iter::once(nominal.length_mm()));
    from.zip(to)
        .filter(|(from, to)| to - from > least_mm(*from, *to))
        .map(|(from, to)| {
            // Just inside: at a corner two lines meet.
            let inside = 0.5 * LEAST_MM.min(to - from);
            Uncut {
                lines: [from + inside, to - inside].map(|at| guide.line(at)),
                length_mm: to - from,
            }
        })
        .collect()
}
