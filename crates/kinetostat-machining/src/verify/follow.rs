//! Another program along its guide: pieces of it, each of which belongs to a part of one move of the original.

use std::borrow::Cow;
use std::cell::LazyCell;

use kinetostat::number::{larger, smaller};
use kinetostat_program::{Corrected, Curve, Foot, Knowledge, Move, MoveKind, NominalPath, Path};
use nalgebra::Vector3;

use crate::task::{NoMotion, RunError};
use crate::verify::along::{Along, Followed, beside_mm};
use crate::verify::matched::Matched;
use crate::verify::on_guide::{Search, are_same};
use crate::verify::places::{End, ends, feet};
use crate::verify::rapids::{NEAR_MM, ON_WAY_MM, Way, elsewhere, largest_shift_mm};
use crate::verify::stretches::{Guide, Stretches, uncut};

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
    let other = &*without_air(&as_it_is, &nominal, other, shift_mm);
    let of_other = NominalPath::new(other).map_err(nothing)?;
    let ends = ends(&of_other);
    let stretches = Stretches::of(guide, &nominal);
    let feet = match are_same(original, other) {
        // A place may be nearer to another pass than to its own if passes are closer than corrections are large.
        true => {
            let foot = |end: &End| stretches.foot(end.move_index, end.shares[1], &end.position);
            ends.iter().map(foot).collect()
        }
        false => feet(&nominal, other, shift_mm, &ends)?,
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
    let guide = Guide {
        original,
        written: guide,
        nominal: &nominal,
    };
    let rapids = elsewhere(&guide, &of_other, &along.passes, shift_mm);
    let matched = Matched {
        largest_distance_mm: far(farthest),
        largest_distance_line: other.moves[ends[farthest].move_index].line,
        uncut: uncut(&guide, &along.covered, near_mm),
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

/// The other program with its moves at feed as rapids where they are rapids of the original: a retract at feed cuts nothing, nor does
/// a way along which the program has cut before.
fn without_air<'a>(
    original: &NominalPath<'_>,
    nominal: &NominalPath<'_>,
    other: &'a Path,
    shift_mm: f64,
) -> Cow<'a, Path> {
    let near_mm = NEAR_MM + shift_mm;
    let rapids = Starts::of(original.path(), |m| m.kind == MoveKind::Rapid);
    let ways =
        LazyCell::new(|| [nominal.path(), other].map(|path| Starts::of(path, Move::has_length)));
    // Maximum distance of earlier cuts from a way along them: a lift may go where the cut is not shifted to. A way that is where the
    // cuts are is compensated as those are, and another cut nearby is none along it.
    let beside_cuts = |own: &Move| {
        let places = [0.0, 0.5, 1.0].map(|share| own.point(share));
        let feet = places.iter().filter_map(|place| nominal.nearest(place));
        smaller(
            shift_mm,
            feet.map(|foot| foot.distance_mm).fold(0.0, larger),
        )
    };
    // A way that was cut before is cut again where the guide, coming by as often, cuts that time; where it comes by more or less often,
    // if a cut of the guide is more like it than any rapid is.
    let is_cut_again = |index: usize| {
        let own = &other.moves[index];
        let [guide, of_other] = &*ways;
        let [of_guide, of_other] = [guide, of_other].map(|ways| ways.along(own, near_mm));
        let time = of_other.iter().position(|k| *k == index);
        if let Some(time) = time.filter(|_| of_guide.len() == of_other.len()) {
            return guide.moves[of_guide[time]].kind == MoveKind::Feed;
        }
        let least = |kind: MoveKind| {
            let near = guide.near(&own.start, near_mm);
            let near = near.filter(|k| guide.moves[*k].kind == kind);
            let near = near.filter(|k| guide.way(*k).distance(&own.end) <= near_mm);
            near.map(|k| guide.apart_mm(k, other, index))
                .fold(f64::INFINITY, smaller)
        };
        least(MoveKind::Feed) < least(MoveKind::Rapid)
    };
    let is_air = |index: usize| {
        let own = &other.moves[index];
        if own.kind != MoveKind::Feed || own.curve != Curve::Line || !own.is_known_feed() {
            return false;
        }
        let middle = own.point(0.5);
        let mut candidates = rapids
            .near(&own.start, near_mm)
            .map(|rapid| &rapids.moves[rapid]);
        candidates.any(|m| {
            let beside = (m.point(0.5) - middle).norm();
            (m.end - own.end).norm() <= near_mm
                && goes_the_same_way(own, m)
                // Not where a cut goes nearer by, as it is or compensated, unless it has been made.
                && ([original, nominal].into_iter().all(|cuts| {
                    cuts.nearest(&middle).is_none_or(|foot| foot.distance_mm > beside)
                }) || (is_cut_before(other, index, ON_WAY_MM + beside_cuts(own))
                    && !is_cut_again(index)))
        })
    };
    let air: Vec<usize> = (0..other.moves.len())
        .filter(|index| is_air(*index))
        .collect();
    if air.is_empty() {
        return Cow::Borrowed(other);
    }
    let mut changed = other.clone();
    for index in air {
        changed.moves[index].kind = MoveKind::Rapid;
    }
    Cow::Owned(changed)
}

/// Moves of a path by where they start.
struct Starts<'p> {
    moves: &'p [Move],
    by_x: Vec<usize>,
}

impl<'p> Starts<'p> {
    fn of(path: &'p Path, is_meant: impl Fn(&Move) -> bool) -> Self {
        let moves = &path.moves[..];
        let is_meant = |index: &usize| {
            let m = &moves[*index];
            m.known == Knowledge::Whole && is_meant(m)
        };
        let mut by_x: Vec<usize> = (0..moves.len()).filter(is_meant).collect();
        by_x.sort_by(|a, b| moves[*a].start.x.total_cmp(&moves[*b].start.x));
        Self { moves, by_x }
    }

    fn way(&self, index: usize) -> Way {
        Way {
            line: self.moves[index].line,
            ends: [self.moves[index].start, self.moves[index].end],
        }
    }

    /// Moves that start near a place.
    fn near<'s>(
        &'s self,
        place: &'s Vector3<f64>,
        within_mm: f64,
    ) -> impl Iterator<Item = usize> + 's {
        let from = self
            .by_x
            .partition_point(|index| self.moves[*index].start.x < place.x - within_mm);
        let indices = self.by_x[from..].iter().copied();
        let indices = indices.take_while(move |i| self.moves[*i].start.x <= place.x + within_mm);
        indices.filter(move |index| (self.moves[*index].start - place).norm() <= within_mm)
    }

    /// Moves that go along the same way, in their order.
    fn along(&self, own: &Move, within_mm: f64) -> Vec<usize> {
        let goes = |k: &usize| {
            let tangents = self.moves[*k].tangent(0.0).zip(own.tangent(0.0));
            tangents.is_some_and(|(a, b)| a.dot(&b) >= ONE_DIRECTION)
        };
        let mut all: Vec<usize> = self.near(&own.start, within_mm).filter(goes).collect();
        all.sort_unstable();
        all
    }

    /// Distance between the starts of two ways and of the moves before them, mm: a hole is pecked again after the way to it, and the
    /// way back to its ground follows the lift out of it.
    fn apart_mm(&self, index: usize, other: &Path, own: usize) -> f64 {
        let starts = |moves: &[Move], index: usize| {
            let first = first_of_way(moves, index);
            [first, first.saturating_sub(1)].map(|index| moves[index].start)
        };
        let (there, here) = (starts(self.moves, index), starts(&other.moves, own));
        there.iter().zip(&here).map(|(a, b)| (a - b).norm()).sum()
    }
}

/// Moves of one kind in this direction, as the cosine of the angle between them, are parts of one way.
const ONE_DIRECTION: f64 = 0.9;

/// The first of the moves that lead on to one in its direction.
fn first_of_way(moves: &[Move], index: usize) -> usize {
    let leads_on = |before: &usize| {
        let [from, to] = [&moves[*before], &moves[before + 1]];
        let tangents = from.tangent(1.0).zip(to.tangent(0.0));
        from.kind == to.kind && tangents.is_some_and(|(a, b)| a.dot(&b) >= ONE_DIRECTION)
    };
    let before = index.saturating_sub(LOOKED_BACK)..index;
    before.rev().take_while(leads_on).last().unwrap_or(index)
}

/// Corrections change a rapid by at most this share of it, or a move is not taken for it.
const CHANGED: f64 = 0.75;

/// True if a move goes in the direction of a rapid and about as far: a short block and a slot beside a lift are near both of
/// its ends.
fn goes_the_same_way(own: &Move, rapid: &Move) -> bool {
    let [own, rapid] = [own, rapid].map(|m| m.end - m.start);
    (own - rapid).norm() <= CHANGED * rapid.norm()
}

/// Number of earlier moves that are searched for one that has cut a way.
const LOOKED_BACK: usize = 200;

/// Places of a way that are looked at.
const LOOKED_AT: usize = 16;

/// True if earlier moves at feed have been along all of a straight way: the lift out of a hole and the way back to its
/// ground.
fn is_cut_before(path: &Path, index: usize, within_mm: f64) -> bool {
    let own = &path.moves[index];
    let before = &path.moves[index.saturating_sub(LOOKED_BACK)..index];
    let is_straight = |m: &&Move| m.is_known_feed() && m.curve == Curve::Line;
    let cuts = before.iter().filter(is_straight);
    let cuts = cuts.map(|m| Way {
        line: m.line,
        ends: [m.start, m.end],
    });
    let cuts: Vec<Way> = cuts.collect();
    (0..=LOOKED_AT).all(|k| {
        let place = own.point(k as f64 / LOOKED_AT as f64);
        cuts.iter().any(|cut| cut.holds(&place, within_mm))
    })
}
