//! Places of the original to which the ends of pieces belong, from corrections that are solved for them.
//!
//! The guide is straight between its ends, which leave the compensated path by its tolerance: a place that was found by it is off
//! along the path by as much, and where the load comes over the program the force that belongs to it is another. Newton's method
//! takes it to the foot on the compensated path itself: there the error is what no other choice of the place would make smaller.

use kinetostat_program::{Arc, CorrectionField, Path, Piece, Request, WrittenCircle};
use nalgebra::Vector3;

use crate::verify::followed::Followed;

/// Steps of Newton's method; the guide is near enough that the second one has nothing left to do but where the program is far from it.
const STEPS: usize = 2;

/// Way along the original over which the direction of the compensated path is taken, mm.
const DIRECTION_MM: f64 = 0.01;

/// No step is longer than this, mm: the guide is nearer.
const LONGEST_MM: f64 = 0.05;

/// Equal ways on a part of an arc belong to equal ways on the original within this, mm, or the part is halved.
const EVEN_MM: f64 = 2e-5;

/// How often a part of an arc is halved.
const HALVINGS: usize = 6;

/// A place of the other program, and the one of the original that it belongs to.
struct Abreast {
    move_index: usize,
    share: f64,
    point: Vector3<f64>,
}

/// The pieces with the places that the field of corrections gives; parts of arcs are divided where their ways are not even.
pub(crate) fn exact(
    original: &Path,
    field: &dyn CorrectionField,
    mut pieces: Vec<Followed>,
) -> Vec<Followed> {
    let free: Vec<usize> = (0..pieces.len())
        .filter(|index| is_free(original, &pieces, *index))
        .collect();
    let of_end = |index: &usize| {
        let piece = &pieces[*index].piece;
        Abreast {
            move_index: piece.move_index,
            share: piece.share_to,
            point: piece.commanded_to,
        }
    };
    let mut places: Vec<Abreast> = free.iter().map(of_end).collect();
    find(original, field, &mut places);
    for (index, place) in free.into_iter().zip(places) {
        let [least, most] = [
            pieces[index].piece.share_from,
            pieces[index + 1].piece.share_to,
        ];
        let begins_pass = !pieces[index].piece.corrected;
        let least = if begins_pass { 0.0 } else { least };
        let share = place.share.min(most).max(least);
        pieces[index].piece.share_to = share;
        pieces[index + 1].piece.share_from = share;
        if begins_pass {
            pieces[index].piece.share_from = share;
        }
    }
    divided(original, field, pieces)
}

/// Whether the end of a piece lies inside a move of the original, and nothing holds it where it is.
fn is_free(original: &Path, pieces: &[Followed], index: usize) -> bool {
    let Some(next) = pieces.get(index + 1) else {
        return false;
    };
    let own = &pieces[index];
    let (piece, next) = (&own.piece, &next.piece);
    let goes_on = next.move_index == piece.move_index && next.share_from == piece.share_to;
    goes_on
        && !own.is_held
        && next.corrected
        && piece.turn.is_none()
        && next.turn.is_none()
        && piece.share_to > 0.0
        && piece.share_to < 1.0
        && original.moves[piece.move_index].has_length()
}

/// Halves parts of arcs until equal ways on them belong to equal ways on the original.
fn divided(original: &Path, field: &dyn CorrectionField, pieces: Vec<Followed>) -> Vec<Followed> {
    let mut all: Vec<(Followed, bool)> = pieces
        .into_iter()
        .map(|own| {
            let is_round = own.piece.circle.is_some() && own.piece.turn.is_none();
            let looked = is_round && own.piece.share_to > own.piece.share_from && !own.is_same;
            (own, looked)
        })
        .collect();
    for _ in 0..HALVINGS {
        let looked: Vec<&Piece> = all
            .iter()
            .filter(|(_, l)| *l)
            .map(|(own, _)| &own.piece)
            .collect();
        let middle = |piece: &&Piece| Abreast {
            move_index: piece.move_index,
            share: 0.5 * (piece.share_from + piece.share_to),
            point: piece.commanded(&original.moves[piece.move_index], 0.5),
        };
        let mut middles: Vec<Abreast> = looked.iter().map(middle).collect();
        if middles.is_empty() {
            break;
        }
        find(original, field, &mut middles);
        let mut middles = middles.into_iter();
        let mut next = Vec::with_capacity(all.len());
        for (own, looked) in all {
            let Some(place) = looked.then(|| middles.next()).flatten() else {
                next.push((own, false));
                continue;
            };
            let piece = &own.piece;
            let even = 0.5 * (piece.share_from + piece.share_to);
            let off_mm = (place.share - even).abs() * original.moves[piece.move_index].length_mm();
            let inside = place.share > piece.share_from && place.share < piece.share_to;
            match off_mm > EVEN_MM && inside {
                true => next.extend(halves(own, &place).map(|half| (half, true))),
                false => next.push((own, false)),
            }
        }
        all = next;
    }
    all.into_iter().map(|(own, _)| own).collect()
}

/// Both halves of a part of an arc, whose middle belongs to a place.
fn halves(own: Followed, place: &Abreast) -> [Followed; 2] {
    let [from, to] = [own.other_from, own.other_end.1];
    let middle = 0.5 * (from + to);
    let half = |shares: [f64; 2]| {
        let circle = own.piece.circle.map(|circle: WrittenCircle| {
            let curve: Arc = circle.curve.between(shares);
            WrittenCircle { curve, ..circle }
        });
        Piece {
            circle,
            ..own.piece
        }
    };
    let first = Piece {
        share_to: place.share,
        commanded_to: place.point,
        ..half([0.0, 0.5])
    };
    let last = Piece {
        share_from: place.share,
        commanded_from: place.point,
        ..half([0.5, 1.0])
    };
    [
        Followed {
            piece: first,
            other_from: from,
            other_end: (own.other_end.0, middle),
            is_held: false,
            is_same: false,
        },
        Followed {
            piece: last,
            other_from: middle,
            ..own
        },
    ]
}

/// Takes places to their feet on the compensated path; one that has no correction, or is not found nearby, stays.
fn find(original: &Path, field: &dyn CorrectionField, places: &mut [Abreast]) {
    for _ in 0..STEPS {
        let requests: Vec<Request> = places
            .iter()
            .flat_map(|place| {
                let share = place.share;
                [share, beside(original, place)]
                    .map(|share| request(original, place.move_index, share))
            })
            .collect();
        let answers = field.corrections(&requests);
        let commanded: Vec<Option<Vector3<f64>>> = requests
            .iter()
            .zip(&answers)
            .map(|(request, answer)| {
                let shift = answer.as_ref().ok()?.shift_mm;
                Some(request.position_mm + shift)
            })
            .collect();
        for (place, both) in places.iter_mut().zip(commanded.chunks_exact(2)) {
            let &[Some(here), Some(there)] = both else {
                continue;
            };
            let along = (there - here) / (beside(original, place) - place.share);
            let step = (place.point - here).dot(&along) / along.norm_squared();
            if step.abs() * original.moves[place.move_index].length_mm() <= LONGEST_MM {
                place.share = (place.share + step).clamp(0.0, 1.0);
            }
        }
    }
}

/// A share of the same move a little before a place, or behind it.
fn beside(original: &Path, place: &Abreast) -> f64 {
    let width = (DIRECTION_MM / original.moves[place.move_index].length_mm()).min(0.5);
    match place.share >= width {
        true => place.share - width,
        false => place.share + width,
    }
}

fn request(original: &Path, move_index: usize, share: f64) -> Request {
    let motion = &original.moves[move_index];
    Request {
        move_index,
        share,
        position_mm: motion.point(share),
        tangent: motion.tangent(share),
        orientation: motion.orientation(share),
        turning: None,
    }
}
