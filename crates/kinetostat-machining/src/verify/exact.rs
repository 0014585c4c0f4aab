//! Places of the original to which the ends of pieces belong, from corrections that are solved for them.
//!
//! The guide is straight between its ends, which leave the compensated path by its tolerance: a place that was found by it is off
//! along the path by as much, and where the load comes over the program the force that belongs to it is another. Newton's method
//! takes it to the foot on the compensated path itself: there the error is what no other choice of the place would make smaller.

use kinetostat_program::{
    Arc, CorrectionField, Path, Piece, Request, Turn, Turning, WrittenCircle,
};
use nalgebra::Vector3;

use crate::verify::along::Followed;

/// Equal ways on a part of an arc belong to equal ways on the original within this, mm, or the part is halved.
const EVEN_MM: f64 = 2e-5;

/// Number of times that a part of an arc is halved.
const HALVINGS: usize = 6;

/// The pieces with the places that the field of corrections gives; parts of arcs are divided where their ways are not even.
pub(crate) fn exact(
    original: &Path,
    field: &dyn CorrectionField,
    mut pieces: Vec<Followed>,
) -> Vec<Followed> {
    let free: Vec<usize> = (0..pieces.len())
        .filter(|index| is_free(original, &pieces, *index))
        .collect();
    let of_end = |index: &usize| Abreast::of_end(&pieces[*index].piece);
    let mut places: Vec<Abreast> = free.iter().map(of_end).collect();
    find(original, field, &mut places);
    for (index, place) in free.into_iter().zip(places) {
        if let Some(turning) = place.turning {
            put_part(&mut pieces[index..=index + 1], turning.part);
            continue;
        }
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

/// Lets two parts of one turn of the load meet at this part of it.
fn put_part(both: &mut [Followed], part: f64) {
    let [own, next] = both else {
        return;
    };
    let turns = own.piece.turn.as_mut().zip(next.piece.turn.as_mut());
    if let Some((own, next)) = turns {
        let part = part.min(next.part_to).max(own.part_from);
        own.part_to = part;
        next.part_from = part;
    }
}

/// True if the end of a piece lies inside a move of the original or inside a turn of the load, and is not fixed.
fn is_free(original: &Path, pieces: &[Followed], index: usize) -> bool {
    let Some(next) = pieces.get(index + 1) else {
        return false;
    };
    let own = &pieces[index];
    let (piece, next) = (&own.piece, &next.piece);
    let goes_on = next.move_index == piece.move_index && next.share_from == piece.share_to;
    if !goes_on || own.is_held || !next.corrected {
        return false;
    }
    if let (Some(turn), Some(behind)) = (piece.turn, next.turn) {
        let goes_on = Turn {
            part_from: turn.part_to,
            part_to: behind.part_to,
            ..turn
        };
        return behind == goes_on && turn.part_to > 0.0 && turn.part_to < 1.0;
    }
    piece.turn.is_none()
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
            turning: None,
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

/// Divides a part of an arc in two, whose middle belongs to a place.
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

/// Steps of Newton's method; the guide is near enough that the second one has nothing left to do but where the program is far from it.
const STEPS: usize = 2;

/// Way along the original over which the direction of the compensated path is taken, mm.
const DIRECTION_MM: f64 = 0.01;

/// Maximum length of a step, mm: the guide is nearer.
const LONGEST_MM: f64 = 0.05;

/// Part of a turn of the load over which the direction of the compensated path is taken, and the longest step.
const TURN: (f64, f64) = (0.01, 0.25);

/// A place of the other program, and the one of the original that it belongs to.
pub(crate) struct Abreast {
    pub(crate) move_index: usize,
    pub(crate) share: f64,
    /// Turn of the load at that place, if it turns there.
    pub(crate) turning: Option<Turning>,
    pub(crate) point: Vector3<f64>,
}

impl Abreast {
    pub(crate) fn of_end(piece: &Piece) -> Self {
        Self {
            move_index: piece.move_index,
            share: piece.share_to,
            turning: piece.turn.map(|turn| Turning {
                from_move: turn.from_move,
                from_share: turn.from_share,
                to_share: turn.to_share,
                part: turn.part_to,
            }),
            point: piece.commanded_to,
        }
    }

    /// Unknown of the search: the part of the turn, or the share of the move.
    fn at(&self) -> f64 {
        self.turning.map_or(self.share, |turning| turning.part)
    }

    /// Takes a step, if it is no longer than steps may be; the compensated path goes `along_mm` in a whole turn.
    fn go(&mut self, original: &Path, step: f64, along_mm: f64) {
        let moved = (self.at() + step).clamp(0.0, 1.0);
        match &mut self.turning {
            Some(turning) => {
                if step.abs() <= TURN.1 && step.abs() * along_mm <= LONGEST_MM {
                    turning.part = moved;
                }
            }
            None => {
                if step.abs() * original.moves[self.move_index].length_mm() <= LONGEST_MM {
                    self.share = moved;
                }
            }
        }
    }
}

/// Takes places to their feet on the compensated path; one that has no correction, or is not found nearby, stays.
fn find(original: &Path, field: &dyn CorrectionField, places: &mut [Abreast]) {
    for _ in 0..STEPS {
        let requests: Vec<Request> = places
            .iter()
            .flat_map(|place| {
                [place.at(), beside(original, place)].map(|at| request(original, place, at))
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
            let along = (there - here) / (beside(original, place) - place.at());
            let step = (place.point - here).dot(&along) / along.norm_squared();
            place.go(original, step, along.norm());
        }
    }
}

/// A share of the same move a little before a place, or behind it; or a part of the same turn.
fn beside(original: &Path, place: &Abreast) -> f64 {
    let width = match place.turning {
        Some(_) => TURN.0,
        None => (DIRECTION_MM / original.moves[place.move_index].length_mm()).min(0.5),
    };
    match place.at() >= width {
        true => place.at() - width,
        false => place.at() + width,
    }
}

/// Request at a share of the move of a place, or at a part of its turn.
fn request(original: &Path, place: &Abreast, at: f64) -> Request {
    let motion = &original.moves[place.move_index];
    let turning = place.turning.map(|turning| Turning {
        part: at,
        ..turning
    });
    let share = turning.map_or(at, |_| place.share);
    Request {
        move_index: place.move_index,
        share,
        position_mm: motion.point(share),
        tangent: motion.tangent(share),
        orientation: motion.orientation(share),
        turning,
    }
}
