//! Rate of change of the correction along the path, from the program as it is written.
//!
//! A written position less its place on the path is the correction there, and between two of them it changes evenly with the length
//! of the path, or, on an arc that was fitted, as the arc as written says. Positions are rounded to the last digit written, which says nothing of the change over a length of a few
//! digits: so the change is taken over every stretch of [`DIGITS`] times that digit (0.01 mm with four decimals), and rounding
//! makes it at most [`ROUNDING`] larger. Steps, where the correction jumps at one place, are no part of it, nor are rapids.

use kinetostat_program::{Corrected, Path, Piece, WriteOptions};
use nalgebra::Vector3;

/// Length over which the change is taken, in last digits that are written.
const DIGITS: f64 = 100.0;

/// Increase by rounding, mm per mm: half a digit along three axes at both ends.
const ROUNDING: f64 = 1.732_050_808 / DIGITS;

/// A change of the correction between two places of the path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Change {
    /// Line of the program.
    pub line: usize,
    pub mm_per_mm: f64,
    /// Stated change of the load there, mm per mm.
    pub stated: f64,
    /// Move and share of the two places.
    pub ends: [(usize, f64); 2],
    /// Length of path between them, mm.
    pub way_mm: f64,
}

/// The fastest changes of a written program.
#[derive(Clone, Debug, Default)]
pub(crate) struct Changes {
    pub worst: Option<Change>,
    /// The one that is the most times what is stated for it, if it is more by more than rounding makes of it.
    pub beyond: Option<Change>,
    /// Lines with such changes.
    pub lines_beyond: usize,
    last_beyond: Option<usize>,
}

impl Changes {
    fn note(&mut self, change: Change) {
        if self.worst.is_none_or(|w| change.mm_per_mm > w.mm_per_mm) {
            self.worst = Some(change);
        }
        if change.mm_per_mm <= change.stated + ROUNDING {
            return;
        }
        let times = |c: &Change| c.mm_per_mm / c.stated;
        if self.beyond.is_none_or(|b| times(&change) > times(&b)) {
            self.beyond = Some(change);
        }
        // Lines come one after the other.
        if self.last_beyond != Some(change.line) {
            self.lines_beyond += 1;
            self.last_beyond = Some(change.line);
        }
    }
}

/// A piece of a stretch without steps and rapids.
struct Along {
    /// Index of the piece.
    piece: usize,
    /// Length of path at its ends, mm.
    ends_mm: [f64; 2],
}

/// The place and the correction at a length of path in a piece.
fn at(path: &Path, written: &Corrected, along: &Along, at_mm: f64) -> ((usize, f64), Vector3<f64>) {
    let piece: &Piece = &written.pieces[along.piece];
    let [from, to] = along.ends_mm;
    let motion = &path.moves[piece.move_index];
    let part = ((at_mm - from) / (to - from)).clamp(0.0, 1.0);
    let share = piece.share_from + part * (piece.share_to - piece.share_from);
    let correction = match (piece.kept_arc, piece.is_fitted()) {
        (true, _) => Vector3::zeros(),
        (false, true) => piece.commanded(motion, part) - motion.point(share),
        (false, false) => {
            let first = piece.commanded_from - motion.point(piece.share_from);
            let last = piece.commanded_to - motion.point(piece.share_to);
            first.lerp(&last, part)
        }
    };
    ((piece.move_index, share), correction)
}

/// The fastest changes of the correction; `stated` says the largest one that is stated for the load on a line.
pub(crate) fn changes(
    path: &Path,
    written: &Corrected,
    writing: &WriteOptions,
    stated: impl Fn(usize) -> f64,
) -> Changes {
    let mut found = Changes::default();
    let mut stretch: Vec<Along> = Vec::new();
    let mut close = |stretch: &mut Vec<Along>| {
        of_stretch(path, written, writing, stretch, &stated, &mut found);
        stretch.clear();
    };
    for (index, piece) in written.pieces.iter().enumerate() {
        let motion = &path.moves[piece.move_index];
        // A turn in place is no length of path: what changes on it changes with the angle.
        let turns = motion.turns_in_place();
        if piece.corner_step || !piece.corrected || turns || !motion.is_known_feed() {
            close(&mut stretch);
            continue;
        }
        let length = motion.length_between_mm(piece.share_from, piece.share_to);
        if length > 0.0 {
            let from = stretch.last().map_or(0.0, |last| last.ends_mm[1]);
            stretch.push(Along {
                piece: index,
                ends_mm: [from, from + length],
            });
        }
    }
    close(&mut stretch);
    found
}

/// Largest change between two places at this distance: one of them is the end of a piece.
fn of_stretch(
    path: &Path,
    written: &Corrected,
    writing: &WriteOptions,
    stretch: &[Along],
    stated: &impl Fn(usize) -> f64,
    found: &mut Changes,
) {
    let Some(last) = stretch.last() else {
        return;
    };
    let whole_mm = last.ends_mm[1];
    let motion = |along: &Along| &path.moves[written.pieces[along.piece].move_index];
    let digits = stretch
        .iter()
        .map(|along| writing.last_digit_mm(motion(along).words.mm_per_unit));
    let way_mm = DIGITS * digits.fold(0.0, kinetostat::number::larger);
    let (mut before, mut after) = (0, 0);
    for (i, along) in stretch.iter().enumerate() {
        let [start, end] = along.ends_mm;
        while stretch[after].ends_mm[1] < start + way_mm && after + 1 < stretch.len() {
            after += 1;
        }
        while stretch[before].ends_mm[1] < end - way_mm && before < i {
            before += 1;
        }
        let line = motion(along).line;
        let mut look = |a: &Along, a_mm: f64, b: &Along, b_mm: f64| {
            let (from, first) = at(path, written, a, a_mm);
            let (to, last) = at(path, written, b, b_mm);
            found.note(Change {
                line,
                mm_per_mm: (last - first).norm() / way_mm,
                stated: stated(line),
                ends: [from, to],
                way_mm,
            });
        };
        // A stretch that is shorter is taken whole.
        if i == 0 || start + way_mm <= whole_mm {
            look(along, start, &stretch[after], start + way_mm);
        }
        if end >= way_mm {
            look(&stretch[before], end - way_mm, along, end);
        }
    }
}
