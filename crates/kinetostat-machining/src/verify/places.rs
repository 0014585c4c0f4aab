//! The ends of another program's moves, in their order, and which places of the guide belong to them.

use kinetostat_program::{Curve, Foot, NominalPath, Path, WhyLeftOut, in_order_by};
use nalgebra::Vector3;

use crate::task::RunError;

/// Chords of the other program's arcs between whose ends the correspondence is taken to grow evenly leave them by at most this, mm.
const ARC_MM: f64 = 0.01;

/// Maximum distances of the other program from the guide, mm, tried one after the other: the nearer it is, the less can be
/// mistaken.
const WINDOWS_MM: [f64; 5] = [0.02, 0.1, 0.5, 2.0, 8.0];

/// Number of ends of which one may be farther away than the others, and two of any number: those of one wrong block.
const FEW: usize = 20;

/// The start of a pass, or the end of a part of a move.
pub(crate) struct End {
    /// Index of the move in the other program.
    pub(crate) move_index: usize,
    /// Shares of it at which the part begins and ends.
    pub(crate) shares: [f64; 2],
    pub(crate) begins_pass: bool,
    pub(crate) position: Vector3<f64>,
    /// Length that the program has cut up to there, mm.
    pub(crate) cut_mm: f64,
}

/// Starts of passes and ends of moves at feed, of arcs those of parts of them.
pub(crate) fn ends(other: &NominalPath<'_>) -> Vec<End> {
    let mut ends = Vec::new();
    let mut pass = None;
    for piece in other.pieces() {
        let motion = other.motion(piece);
        let end = |shares: [f64; 2], begins_pass: bool| End {
            move_index: piece.move_index,
            shares,
            begins_pass,
            position: motion.point(shares[1]),
            cut_mm: piece.from_mm + shares[1] * piece.length_mm,
        };
        if pass.replace(piece.pass) != Some(piece.pass) {
            ends.push(end([0.0, 0.0], true));
        }
        let parts = match &motion.curve {
            Curve::Line => 1,
            Curve::Arc(arc) => arc.chords_within(ARC_MM),
        };
        let share = |part: usize| part as f64 / parts as f64;
        ends.extend((0..parts).map(|part| end([share(part), share(part + 1)], false)));
    }
    ends
}

/// Maximum share of ends that may be nowhere on the guide: of more it is another program.
const MOST_AWAY: f64 = 0.25;

/// Maximum number of times that an end that leaps ahead is left out, and the order looked for anew.
const LEAPS: usize = 8;

/// The place of the guide for each end; none for the few that are nowhere near it, or only in another order. A program may be as far
/// from the guide as corrections are large, `shift_mm`: it is that where it is not compensated.
///
/// # Errors
/// More than a few are.
pub(crate) fn feet(
    guide: &NominalPath<'_>,
    other: &Path,
    shift_mm: f64,
    ends: &[End],
) -> Result<Vec<Option<Foot>>, RunError> {
    let points: Vec<Vector3<f64>> = ends.iter().map(|end| end.position).collect();
    let mut last = None;
    for window_mm in WINDOWS_MM {
        let mut near: Vec<Vec<Foot>> = points
            .iter()
            .map(|point| guide.nearest_within(point, window_mm))
            .collect();
        let found = match widened(guide, &points, &mut near, window_mm) {
            // Nobody is asked for an order of points many of which are nowhere.
            Err(lost) => Err((lost, WhyLeftOut::BeyondWindow)),
            Ok(()) => ordered(ends, near, window_mm, |k| {
                guide.nearest_within(&points[k], window_mm + shift_mm)
            }),
        };
        match found {
            Ok(feet) => return Ok(feet),
            Err(lost) => last = Some(lost),
        }
    }
    let (index, why) = last.unwrap_or((0, WhyLeftOut::BeyondWindow));
    let end = &ends[index];
    Err(RunError::Elsewhere {
        line: other.moves[end.move_index].line,
        position_mm: end.position.into(),
        distance_mm: match why {
            WhyLeftOut::OutOfOrder => None,
            _ => guide.nearest(&end.position).map(|foot| foot.distance_mm),
        },
    })
}

/// True if so many of all ends are few enough to be left out.
fn is_few(lost: usize, all: usize) -> bool {
    lost as f64 <= MOST_AWAY * all as f64 || (lost <= 2 && 2 * lost < all)
}

/// The feet in their order. One end that leaps ahead, to a part of the original that comes later, leaves those behind it without any:
/// it is left out where that leaves more of the others. For those that are left, feet farther away are asked for, where a program that
/// is not compensated comes nearer to another part of the path than to their own.
///
/// # Errors
/// The first end without a foot and why, where there are many.
fn ordered(
    ends: &[End],
    mut near: Vec<Vec<Foot>>,
    window_mm: f64,
    farther: impl Fn(usize) -> Vec<Foot>,
) -> Result<Vec<Option<Foot>>, (usize, WhyLeftOut)> {
    let lost = |feet: &[Result<Foot, WhyLeftOut>]| feet.iter().filter(|foot| foot.is_err()).count();
    let way_mm = |from: usize, to: usize| ends[to].cut_mm - ends[from].cut_mm;
    let mut best = in_order_by(&near, window_mm, way_mm);
    for _ in 0..LEAPS {
        let out_of_order = |foot: &Result<Foot, WhyLeftOut>| *foot == Err(WhyLeftOut::OutOfOrder);
        let leaps = best.iter().position(out_of_order).and_then(|first| {
            let mut before = (0..first).rev();
            before.find(|index| best[*index].is_ok())
        });
        let Some(leaps) = leaps else {
            break;
        };
        let its_feet = std::mem::take(&mut near[leaps]);
        let without = in_order_by(&near, window_mm, way_mm);
        if lost(&without) >= lost(&best) {
            near[leaps] = its_feet;
            break;
        }
        best = without;
    }
    let left_out: Vec<usize> = (0..best.len()).filter(|k| best[*k].is_err()).collect();
    if !left_out.is_empty() && is_few(left_out.len(), ends.len()) {
        for k in left_out {
            near[k] = farther(k);
        }
        let with = in_order_by(&near, window_mm, way_mm);
        if lost(&with) < lost(&best) {
            best = with;
        }
    }
    let first = best.iter().position(Result::is_err);
    match first.zip(first.and_then(|first| best[first].err())) {
        Some(first) if !is_few(lost(&best), ends.len()) => Err(first),
        _ => Ok(best.into_iter().map(Result::ok).collect()),
    }
}

/// Looks farther away for the few ends that are nowhere near: one wrong block is to widen the window of no other.
///
/// # Errors
/// The first of them, where there are many.
fn widened(
    guide: &NominalPath<'_>,
    points: &[Vector3<f64>],
    near: &mut [Vec<Foot>],
    window_mm: f64,
) -> Result<(), usize> {
    let lost: Vec<usize> = (0..near.len()).filter(|k| near[*k].is_empty()).collect();
    let [.., widest_mm] = WINDOWS_MM;
    let mut away = 0;
    for k in &lost {
        let nearest = guide.nearest(&points[*k]);
        away += usize::from(nearest.is_none_or(|foot| foot.distance_mm > widest_mm));
    }
    let farther = lost.len() - away;
    let Some(first) = lost.first() else {
        return Ok(());
    };
    if !is_few(away, near.len()) || (farther > 2 && farther * FEW > near.len()) {
        return Err(*first);
    }
    for k in lost {
        let wider = WINDOWS_MM.into_iter().filter(|mm| *mm > window_mm);
        let mut found = wider.map(|mm| guide.nearest_within(&points[k], mm));
        near[k] = found.find(|feet| !feet.is_empty()).unwrap_or_default();
    }
    Ok(())
}
