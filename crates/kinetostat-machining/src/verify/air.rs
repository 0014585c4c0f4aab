//! Which moves at feed of another program are rapids of the original: they cut nothing.

use std::borrow::Cow;

use kinetostat::number::{larger, smaller};
use kinetostat_program::{Curve, Knowledge, Move, MoveKind, NominalPath, Path};

use crate::verify::rapids::NEAR_MM;
use crate::verify::way::{ON_WAY_MM, Way};

/// The other program with its moves at feed as rapids where they are rapids of the original: a retract at feed cuts nothing, nor does
/// a way along which the program has cut before.
pub(crate) fn without_air<'a>(
    original: &NominalPath<'_>,
    nominal: &NominalPath<'_>,
    (other, shift_mm): (&'a Path, f64),
) -> Cow<'a, Path> {
    let near_mm = NEAR_MM + shift_mm;
    let is_rapid = |m: &&Move| m.kind == MoveKind::Rapid && m.known == Knowledge::Whole;
    let mut rapids: Vec<&Move> = original.path().moves.iter().filter(is_rapid).collect();
    rapids.sort_by(|a, b| a.start.x.total_cmp(&b.start.x));
    // How far cuts before may be from a way along them: a lift may go where the cut is not shifted to. A way that is where the cuts are
    // is compensated as those are, and another cut nearby is none along it.
    let beside_cuts = |own: &Move| {
        let places = [0.0, 0.5, 1.0].map(|share| own.point(share));
        let feet = places.iter().filter_map(|place| nominal.nearest(place));
        smaller(
            shift_mm,
            feet.map(|foot| foot.distance_mm).fold(0.0, larger),
        )
    };
    let is_air = |index: usize| {
        let own = &other.moves[index];
        if own.kind != MoveKind::Feed || own.curve != Curve::Line || !own.is_known_feed() {
            return false;
        }
        let from = rapids.partition_point(|m| m.start.x < own.start.x - near_mm);
        let candidates = rapids[from..].iter();
        let mut candidates = candidates.take_while(|m| m.start.x <= own.start.x + near_mm);
        let middle = own.point(0.5);
        candidates.any(|m| {
            let beside = (m.point(0.5) - middle).norm();
            (m.start - own.start).norm() <= near_mm
                && (m.end - own.end).norm() <= near_mm
                && goes_the_same_way(own, m)
                // Not where a cut goes nearer by, as it is or compensated, unless it has been made.
                && ([original, nominal].into_iter().all(|cuts| {
                    cuts.nearest(&middle).is_none_or(|foot| foot.distance_mm > beside)
                }) || is_cut_before(other, index, ON_WAY_MM + beside_cuts(own)))
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

/// Corrections change a rapid by at most this share of it, or a move is not taken for it.
const CHANGED: f64 = 0.75;

/// Whether a move goes where a rapid goes and about as far: a short block and a slot beside a lift are near both of its ends.
fn goes_the_same_way(own: &Move, rapid: &Move) -> bool {
    let [own, rapid] = [own, rapid].map(|m| m.end - m.start);
    (own - rapid).norm() <= CHANGED * rapid.norm()
}

/// So many moves back is looked for one that has cut a way before.
const LOOKED_BACK: usize = 200;

/// Places of a way that are looked at.
const LOOKED_AT: usize = 16;

/// Whether moves at feed before have been along all of a straight way: the lift out of a hole and the way back to its ground.
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
