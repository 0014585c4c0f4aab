//! A place of another program and its foot on the compensated path, by Newton's method.

use kinetostat_program::{CorrectionField, Path, Piece, Request, Turning};
use nalgebra::Vector3;

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
    fn go(&mut self, original: &Path, (step, along_mm): (f64, f64)) {
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
pub(crate) fn find(original: &Path, field: &dyn CorrectionField, places: &mut [Abreast]) {
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
            place.go(original, (step, along.norm()));
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
