//! Another program along its guide: pieces of it, each of which belongs to a part of one move of the original.

use kinetostat_program::{Corrected, Foot, NominalPath, Path};

use crate::task::{NoMotion, RunError};
use crate::verify::air::without_air;
use crate::verify::along::{Along, beside_mm};
use crate::verify::followed::Followed;
use crate::verify::matched::Matched;
use crate::verify::on_guide::{Search, are_same};
use crate::verify::places::{End, ends, feet};
use crate::verify::rapids::{elsewhere, largest_shift_mm};
use crate::verify::stretches::Stretches;
use crate::verify::uncut::uncut;

/// An end this near to where the original goes on to another move lies there, mm; or if the program is farther from the guide, as
/// near as that.
const AT_CORNER_MM: f64 = 0.002;

/// Distances of this many times that of three quarters of the ends stand out.
const OUTSTANDING: f64 = 5.0;

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
    let stretches = Stretches::of(guide, &nominal);
    let feet = match are_same(original, other) {
        // A place may be nearer to another pass than to its own if passes are closer than corrections are large.
        true => {
            let foot = |end: &End| stretches.foot(end.move_index, end.shares[1], &end.position);
            ends.iter().map(foot).collect()
        }
        false => feet(&nominal, (other, shift_mm), &ends)?,
    };
    let far = |index: usize| feet[index].map_or(0.0, |foot| foot.distance_mm);
    let farthest = (0..ends.len()).max_by(|a, b| far(*a).total_cmp(&far(*b)));
    let farthest = farthest.unwrap_or(0);
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
        uncut: uncut(original, (&nominal, guide), (&along.covered, near_mm)),
        rapids,
        extra_cuts: along.extra_cuts,
        ..Matched::default()
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
