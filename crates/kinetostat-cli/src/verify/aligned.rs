//! Moves of two programs that belong to each other: ends of their cuts, and rapids between the same cuts.

use kinetostat_program::Knowledge;
use nalgebra::Vector3;

use crate::verify::marks::{Marks, Way};
use crate::verify::other_word::{FaultKind, OtherWord};

/// Moves of the program verified and of the original that belong to each other, and rapids that do not.
#[derive(Default)]
pub(crate) struct Aligned {
    /// Moves with the ends of both: the last piece of each cut, and rapids.
    pub(crate) ends: Vec<[usize; 2]>,
    /// Rapids that go another way.
    pub(crate) other_ways: Vec<OtherWord>,
}

impl Aligned {
    pub(crate) fn of(both: &[Marks<'_>; 2], cuts: &[[usize; 2]]) -> Self {
        let mut aligned = Self::default();
        let cut_box = box_of(&both[1], cuts);
        let mut from = [0, 0];
        for pieces in cuts.chunk_by(|a, b| a[1] == b[1]) {
            let [first, last] = [pieces[0], pieces[pieces.len() - 1]];
            aligned.rapids(both, [from, first], &cut_box);
            aligned.ends.push(last);
            from = last.map(|index| index + 1);
        }
        let behind = both.each_ref().map(|own| own.path.moves.len());
        aligned.rapids(both, [from, behind], &cut_box);
        aligned
    }

    /// Rapids of both between two places of their runs.
    fn rapids(&mut self, both: &[Marks<'_>; 2], [from, to]: [[usize; 2]; 2], cut_box: &CutBox) {
        let [own, of_original] = [0, 1].map(|of| {
            let moves = from[of]..to[of].min(both[of].ways.len());
            let rapids = moves.filter(|index| both[of].ways[*index] != Way::Feed);
            rapids.collect::<Vec<usize>>()
        });
        let ways = |of: usize, all: &[usize]| {
            let mut ways: Vec<Way> = all.iter().map(|index| both[of].ways[*index]).collect();
            ways.dedup();
            ways
        };
        if own.len() > of_original.len() && ways(0, &own) == ways(1, &of_original) {
            // Corrections may divide them.
            return;
        }
        if own.len() != of_original.len() {
            let [line, there] = [0, 1].map(|of| both[of].line_of(from[of].saturating_sub(1)));
            let text = format!(
                "{} rapids run behind line {line} up to the next cut, and {} in the original (behind line {there} there)",
                own.len(),
                of_original.len()
            );
            let word = OtherWord::new("rapids", None, [Some(line), Some(there)], text);
            self.other_ways.push(word);
            return;
        }
        for (index, there) in own.into_iter().zip(of_original) {
            let ways = [both[0].ways[index], both[1].ways[there]];
            self.ends.push([index, there]);
            if ways[0] == ways[1] {
                continue;
            }
            let [line, line_there] = [both[0].line_of(index), both[1].line_of(there)];
            let said = |way: Way| match way {
                Way::Joints => "by the joints",
                _ => "on a straight line",
            };
            let fault = cut_box
                .is_near(&both[1], there)
                .then_some(FaultKind::Course);
            let follows = match fault {
                Some(_) => ": between its ends it may lead through the part",
                None => "",
            };
            let text = format!(
                "the motion at line {line} goes {}, that of the original (line {line_there} there) {}{follows}",
                said(ways[0]),
                said(ways[1])
            );
            let lines = [Some(line), Some(line_there)];
            self.other_ways
                .push(OtherWord::new("way", fault, lines, text));
        }
    }
}

/// The box around all cuts of a program, from its lowest to its highest corner, mm.
struct CutBox([Vector3<f64>; 2]);

fn box_of(of_original: &Marks<'_>, cuts: &[[usize; 2]]) -> CutBox {
    let none = [f64::INFINITY, f64::NEG_INFINITY].map(Vector3::repeat);
    let moves = cuts
        .iter()
        .filter_map(|cut| of_original.path.moves.get(cut[1]));
    let ends = moves.flat_map(|own| [own.start, own.end]);
    CutBox(ends.fold(none, |[low, high], end| [low.inf(&end), high.sup(&end)]))
}

impl CutBox {
    /// True if a straight line between the known ends of a move leads through the box.
    fn is_near(&self, marks: &Marks<'_>, index: usize) -> bool {
        let Some(own) = marks.path.moves.get(index) else {
            return true;
        };
        let [low, high] = self.0;
        if low.x > high.x {
            return false;
        }
        let start = match own.known {
            Knowledge::Whole => own.start,
            _ => own.end,
        };
        let way = own.end - start;
        let [mut from, mut to] = [0.0_f64, 1.0];
        for axis in 0..3 {
            let mut shares = [low[axis], high[axis]].map(|side| (side - start[axis]) / way[axis]);
            if way[axis] == 0.0 {
                let is_inside = (low[axis]..=high[axis]).contains(&start[axis]);
                shares = if is_inside { [0.0, 1.0] } else { [2.0, 2.0] };
            }
            shares.sort_by(f64::total_cmp);
            from = if shares[0] > from { shares[0] } else { from };
            to = if shares[1] < to { shares[1] } else { to };
        }
        from <= to
    }
}
