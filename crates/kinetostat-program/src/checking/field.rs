//! A written program against the field that it was written for, in places that the division did not
//! choose.

use nalgebra::Vector3;
use serde::Serialize;

use crate::checking::fail;
use crate::error::WriteError;
use crate::field::{CorrectionField, Monitor, Request, Turning};
use crate::number::{irregular, larger};
use crate::path::moves::{Knowledge, Move, Path};
use crate::writing::node::{is_corrected_at_end, is_divided};
use crate::writing::options::WriteOptions;
use crate::writing::written::{Corrected, Piece};

/// Seed of the places: neither that of the division nor that of the check of the text.
const SEED: u64 = 3;

/// Irregular places on every stretch between two breaks of the field.
const PLACES: u64 = 2;

/// Additional places in a piece that is an arc: its ends may leave the curve, and between them it is farthest near the middle. Not
/// at an end itself, where the correction may jump.
const ON_ARCS: [f64; 3] = [0.01, 0.5, 0.99];

/// Places evaluated in one call of the field.
const BATCH: usize = 8192;

/// The place of a program that is farthest from where path and field want it.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Farthest {
    /// Distance from the desired place, in mm.
    pub distance_mm: f64,
    /// Line of the input; `None` if nothing is off.
    pub line: Option<usize>,
    /// Line of the output, counted from 1; 0 where nothing is off.
    pub output_line: usize,
    /// The place on the path, in mm.
    pub position_mm: [f64; 3],
}

impl Farthest {
    fn note(&mut self, look: &Look, distance_mm: f64) {
        // NaN is kept.
        if distance_mm > self.distance_mm || distance_mm.is_nan() {
            *self = Self {
                distance_mm,
                line: Some(look.line),
                output_line: look.output_line,
                position_mm: look.request.position_mm.into(),
            };
        }
    }
}

/// Deviation of a written program from the field it was written for.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct FieldCheck {
    /// Places looked at.
    pub places: usize,
    /// Largest deviation of the written program, including corrections left out because the program never states
    /// their axis.
    pub after: Farthest,
    /// Largest deviation at feed of the uncorrected program.
    pub before: Farthest,
    /// The largest distance, if it were left as it is, of the ends of rapids and of moves from an unknown
    /// place, in mm.
    pub before_at_ends_mm: f64,
    /// Largest allowed deviation, in mm: the tolerance of the path with what may be unknown between its places (a
    /// tenth of it), the chord error where there are arcs, and the rounding.
    pub allowed_mm: f64,
}

/// Position of a place within its piece.
#[derive(Clone, Copy, PartialEq, Eq)]
enum At {
    /// Interior of the piece, where the division may have overlooked something.
    Inside,
    /// At an end on the path, where the field's own correction was written: what is left out there shows. Next to a
    /// jump the answer of the field differs from the one that was written.
    End,
    /// End of a move that is corrected only there.
    EndOfMove,
}

/// A place of the written program.
struct Look {
    at: At,
    request: Request,
    line: usize,
    output_line: usize,
    commanded: Vector3<f64>,
    allowed: f64,
}

/// Asks the field again along what was written: at both ends of every piece's stretches between the
/// field's breaks, and at two irregular places inside each; on arcs near the ends and in the middle, too.
///
/// Axes that the program never states cannot be written. The deviation in them is measured with the rest, but does
/// not refuse the program: its user decides.
///
/// A corner step is looked at inside where the field knows what happens there
/// ([`CorrectionField::turns`]).
///
/// # Errors
///
/// [`WriteError::Verification`] at the first place that is farther off than allowed in the axes that are
/// stated; what the field
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
        if !piece.corrected {
            continue;
        }
        if !is_divided(motion) {
            if is_corrected_at_end(motion) {
                looks.push(Look::on(motion, piece, 1.0, 1.0, None, At::EndOfMove));
            }
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
        if piece.is_fitted() {
            // The centre of a fitted arc is rounded as well.
            allowed += 2.0 * writing.last_digit_mm(motion.words.mm_per_unit);
        }
        if writing.smallest_step_mm() > writing.tolerance_mm {
            allowed += writing.smallest_step_mm();
        }
        found.allowed_mm = larger(found.allowed_mm, allowed);
        places(
            piece,
            index,
            &breaks.1,
            field.turns(),
            |part, share, turning, at| {
                let look = Look::on(motion, piece, part, share, turning, at);
                looks.push(Look { allowed, ..look });
            },
        );
        if looks.len() >= BATCH {
            look(path, field, &mut looks, &mut found, monitor)?;
        }
    }
    look(path, field, &mut looks, &mut found, monitor)?;
    Ok(found)
}

impl Look {
    /// Place on a piece: its part, the share of its move, and the turn of the load.
    fn on(
        motion: &Move,
        piece: &Piece,
        part: f64,
        share: f64,
        turning: Option<Turning>,
        at: At,
    ) -> Self {
        Self {
            at,
            request: Request {
                move_index: piece.move_index,
                share,
                position_mm: motion.point(share),
                tangent: motion.tangent(share),
                orientation: motion.orientation(share),
                turning,
            },
            line: motion.line,
            output_line: piece.output_line,
            commanded: piece.commanded(motion, part),
            allowed: 0.0,
        }
    }
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
    mut push: impl FnMut(f64, f64, Option<Turning>, At),
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
            push(part, to, Some(turning), At::Inside);
        }
        return;
    }
    if from == 0.0 {
        push(0.0, from, None, At::End);
    }
    push(1.0, to, None, At::End);
    for part in ON_ARCS.into_iter().filter(|_| piece.is_fitted()) {
        push(part, from + (to - from) * part, None, At::Inside);
    }
    let first = breaks.partition_point(|share| *share <= from);
    let last = breaks.partition_point(|share| *share < to);
    let mut low = from;
    let mut k = 0;
    for high in breaks[first..last.max(first)].iter().copied().chain([to]) {
        for _ in 0..PLACES {
            let share = low + (high - low) * irregular(SEED, index as u64, k);
            k += 1;
            push((share - from) / (to - from), share, None, At::Inside);
        }
        if high < to {
            push((high - from) / (to - from), high, None, At::Inside);
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
        let mut correction: Vector3<f64> = match answers.next() {
            Some(Ok(correction)) => correction.shift_mm,
            Some(Err(reason)) => return Err(failure(reason.message)),
            None => return Err(failure("the field gave too few answers".to_owned())),
        };
        if look.at == At::EndOfMove {
            let off = correction.norm();
            if off > found.before_at_ends_mm || off.is_nan() {
                found.before_at_ends_mm = off;
            }
            continue;
        }
        // On a corner step the tool stands where the path is, before as after.
        if look.request.turning.is_none() {
            found.before.note(&look, correction.norm());
        }
        let mut left_out = Vector3::zeros();
        for axis in (0..3).filter(|axis| !path.stated[*axis]) {
            left_out[axis] = std::mem::take(&mut correction[axis]);
        }
        let inside = look.at == At::Inside;
        let distance = match inside {
            true => (look.commanded - look.request.position_mm - correction).norm(),
            false => 0.0,
        };
        found.places += usize::from(inside);
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
        found.after.note(&look, distance.hypot(left_out.norm()));
    }
    Ok(())
}
