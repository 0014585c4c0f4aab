//! A written program against the field that it was written for, in places that the division did not
//! choose.

use nalgebra::Vector3;
use serde::Serialize;

use crate::divide::is_divided;
use crate::error::WriteError;
use crate::field::{CorrectionField, Monitor, Request, Turning};
use crate::irregular::irregular;
use crate::path::{Knowledge, Move, Path};
use crate::verify::fail;
use crate::write::{Corrected, Piece, WriteOptions};

/// Seed of the places: neither that of the division nor that of the check of the text.
const SEED: u64 = 3;

/// Irregular places on every stretch between two breaks of the field.
const PLACES: u64 = 2;

/// Places asked in one call of the field.
const BATCH: usize = 8192;

/// How far a written program is from the field it was written for.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct FieldCheck {
    /// Places looked at.
    pub places: usize,
    /// Largest distance between where the program goes and where path and field want it, in mm.
    pub largest_mm: f64,
    /// Line of the input there.
    pub largest_line: Option<usize>,
    /// What is allowed at most, in mm: the tolerance of the path with what may be unknown between its
    /// places (a tenth of it), of chords where there are arcs, and the rounding.
    pub allowed_mm: f64,
}

/// A place of the written program.
struct Look {
    request: Request,
    line: usize,
    output_line: usize,
    commanded: Vector3<f64>,
    allowed: f64,
}

/// Asks the field again along what was written: at both ends of every piece's stretches between the
/// field's breaks, and at two irregular places inside each.
///
/// A corner step is looked at inside where the field knows what happens there
/// ([`CorrectionField::turns`]).
///
/// # Errors
///
/// [`WriteError::Verification`] at the first place that is farther off than allowed; what the field
/// itself refuses; [`WriteError::Cancelled`].
pub fn verify_against_field(
    path: &Path,
    corrected: &Corrected,
    field: &dyn CorrectionField,
    writing: &WriteOptions,
    monitor: &dyn Monitor,
) -> Result<FieldCheck, WriteError> {
    let mut found = FieldCheck::default();
    let mut looks = Vec::new();
    let mut breaks: (usize, Vec<f64>) = (usize::MAX, Vec::new());
    for (index, piece) in corrected.pieces.iter().enumerate() {
        let Some(motion) = path.moves.get(piece.move_index) else {
            return Err(fail(0, piece.output_line, "a piece of no move".to_owned()));
        };
        if !piece.corrected || !is_divided(motion) {
            continue;
        }
        if breaks.0 != piece.move_index {
            let mut shares = field.structure(piece.move_index, motion).breaks;
            shares.sort_by(f64::total_cmp);
            breaks = (piece.move_index, shares);
        }
        let rounding = rounding(path, piece, motion, writing);
        let mut allowed = 1.1 * writing.tolerance_mm + rounding;
        if motion.curve != crate::Curve::Line {
            allowed += 1.2 * writing.chord_tolerance_mm;
        }
        if writing.smallest_step_mm() > writing.tolerance_mm {
            allowed += writing.smallest_step_mm();
        }
        found.allowed_mm = found.allowed_mm.max(allowed);
        places(
            piece,
            index,
            &breaks.1,
            field.turns(),
            |part, share, turning| {
                looks.push(Look {
                    request: Request {
                        move_index: piece.move_index,
                        share,
                        position_mm: motion.point(share),
                        tangent: motion.tangent(share),
                        turning,
                    },
                    line: motion.line,
                    output_line: piece.output_line,
                    commanded: match piece.kept_arc {
                        true => motion.point(share),
                        false => piece.commanded_from.lerp(&piece.commanded_to, part),
                    },
                    allowed,
                });
            },
        );
        if looks.len() >= BATCH {
            look(path, field, &mut looks, &mut found, monitor)?;
        }
    }
    look(path, field, &mut looks, &mut found, monitor)?;
    Ok(found)
}

/// The rounding of a piece's two ends; the first may have been rounded in the units of the block before.
fn rounding(path: &Path, piece: &Piece, motion: &Move, writing: &WriteOptions) -> f64 {
    let of = |motion: &Move| writing.half_digit_mm(motion.words.mm_per_unit);
    let before = piece
        .move_index
        .checked_sub(1)
        .map(|index| &path.moves[index]);
    let before = before.filter(|before| before.known != Knowledge::Nothing);
    3.0_f64.sqrt() * of(motion).max(before.map_or(0.0, of)) + 1e-6
}

/// The places of one piece: part of the piece, share of its move, turn of the load.
fn places(
    piece: &Piece,
    index: usize,
    breaks: &[f64],
    turns: bool,
    mut push: impl FnMut(f64, f64, Option<Turning>),
) {
    let [from, to] = [piece.share_from, piece.share_to];
    if piece.corner_step {
        let Some(turn) = piece.turn.filter(|_| turns) else {
            return;
        };
        for k in 0..PLACES {
            let part = irregular(SEED, index as u64, k);
            let turning = Turning {
                from_move: turn.from_move,
                from_share: turn.from_share,
                to_share: turn.to_share,
                part: turn.part_from + part * (turn.part_to - turn.part_from),
            };
            push(part, to, Some(turning));
        }
        return;
    }
    let first = breaks.partition_point(|share| *share <= from);
    let last = breaks.partition_point(|share| *share < to);
    let mut low = from;
    let mut k = 0;
    for high in breaks[first..last.max(first)].iter().copied().chain([to]) {
        for _ in 0..PLACES {
            let share = low + (high - low) * irregular(SEED, index as u64, k);
            k += 1;
            push((share - from) / (to - from), share, None);
        }
        if high < to {
            push((high - from) / (to - from), high, None);
        }
        low = high;
    }
}

fn look(
    path: &Path,
    field: &dyn CorrectionField,
    looks: &mut Vec<Look>,
    found: &mut FieldCheck,
    monitor: &dyn Monitor,
) -> Result<(), WriteError> {
    if monitor.cancelled() {
        return Err(WriteError::Cancelled);
    }
    let requests: Vec<Request> = looks.iter().map(|look| look.request).collect();
    let mut answers = field.corrections(&requests).into_iter();
    for look in looks.drain(..) {
        let failure = |message: String| WriteError::Field {
            line: look.line,
            share: look.request.share,
            position_mm: look.request.position_mm,
            message,
        };
        let mut correction = match answers.next() {
            Some(Ok(correction)) => correction,
            Some(Err(reason)) => return Err(failure(reason.message)),
            None => return Err(failure("the field gave too few answers".to_owned())),
        };
        for axis in (0..3).filter(|axis| !path.stated[*axis]) {
            correction[axis] = 0.0;
        }
        let distance = (look.commanded - look.request.position_mm - correction).norm();
        found.places += 1;
        // A distance that is no number is off, too.
        if distance.is_nan() || distance > look.allowed {
            return Err(fail(
                look.line,
                look.output_line,
                format!(
                    "{:.1} % along the block it is {distance:.5} mm from where the corrections want it, {:.5} mm \
                     are allowed",
                    100.0 * look.request.share,
                    look.allowed
                ),
            ));
        }
        if distance > found.largest_mm {
            found.largest_mm = distance;
            found.largest_line = Some(look.line);
        }
    }
    Ok(())
}
