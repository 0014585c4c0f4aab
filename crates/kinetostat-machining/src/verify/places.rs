//! The ends of another program's moves, in their order, and which places of the guide belong to them.

use kinetostat_program::{Curve, Foot, NominalPath, Path, WhyLeftOut, in_order};
use nalgebra::Vector3;

use crate::task::RunError;

/// Chords of the other program's arcs between whose ends the correspondence is taken to grow evenly leave them by at most this, mm.
const ARC_MM: f64 = 0.01;

/// How far the other program may be from the guide, mm, tried one after the other: the nearer it is, the less can be mistaken.
const WINDOWS_MM: [f64; 5] = [0.02, 0.1, 0.5, 2.0, 8.0];

/// One of so many ends may be farther away than the others, and two of any number: those of one wrong block.
const FEW: usize = 20;

/// The start of a pass, or the end of a part of a move.
pub(crate) struct End {
    /// Index of the move in the other program.
    pub(crate) move_index: usize,
    /// Shares of it at which the part begins and ends.
    pub(crate) shares: [f64; 2],
    pub(crate) begins_pass: bool,
    pub(crate) position: Vector3<f64>,
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

/// The place of the guide for each end.
///
/// # Errors
/// One is nowhere near it, or only behind those before it.
pub(crate) fn feet(
    guide: &NominalPath<'_>,
    other: &Path,
    ends: &[End],
) -> Result<Vec<Foot>, RunError> {
    let points: Vec<Vector3<f64>> = ends.iter().map(|end| end.position).collect();
    let mut last = None;
    for window_mm in WINDOWS_MM {
        let mut near: Vec<Vec<Foot>> = points
            .iter()
            .map(|point| guide.nearest_within(point, window_mm))
            .collect();
        widen_few(guide, &points, (&mut near, window_mm));
        // Nobody is asked for an order of points one of which is nowhere.
        let found = match near.iter().position(Vec::is_empty) {
            Some(lost) => Err((lost, WhyLeftOut::BeyondWindow)),
            None => in_order(&points, &near, window_mm)
                .into_iter()
                .enumerate()
                .map(|(index, foot)| foot.map_err(|why| (index, why)))
                .collect(),
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

/// Looks farther away for the few ends that are nowhere near: one wrong block is to widen the window of no other.
fn widen_few(
    guide: &NominalPath<'_>,
    points: &[Vector3<f64>],
    (near, window_mm): (&mut [Vec<Foot>], f64),
) {
    let lost: Vec<usize> = (0..near.len()).filter(|k| near[*k].is_empty()).collect();
    if lost.len() > 2 && lost.len() * FEW > near.len() {
        return;
    }
    for k in lost {
        let wider = WINDOWS_MM.into_iter().filter(|mm| *mm > window_mm);
        let mut found = wider.map(|mm| guide.nearest_within(&points[k], mm));
        near[k] = found.find(|feet| !feet.is_empty()).unwrap_or_default();
    }
}
