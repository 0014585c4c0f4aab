//! Queries to a field of corrections, in large batches, with a count of its evaluations.

use nalgebra::{Vector3, Vector6};

use crate::error::WriteError;
use crate::field::{CorrectionField, Monitor, Request};
use crate::number::larger;
use crate::path::moves::{Knowledge, Move, MoveKind, Path};

/// Asks the field and checks its answers.
pub(crate) struct FieldQueries<'a> {
    pub path: &'a Path,
    pub field: &'a dyn CorrectionField,
    pub(crate) monitor: &'a dyn Monitor,
    pub(crate) answered: usize,
    pub(crate) left_out_mm: f64,
    /// [`WriteOptions::turn_lever_mm`](crate::WriteOptions::turn_lever_mm).
    pub(crate) lever_mm: f64,
}

impl FieldQueries<'_> {
    pub fn request(&self, move_index: usize, share: f64) -> Request {
        let motion = &self.path.moves[move_index];
        let tangent = if motion.known == Knowledge::Whole {
            motion.tangent(share)
        } else {
            None
        };
        Request {
            move_index,
            share,
            position_mm: motion.point(share),
            tangent,
            orientation: motion.orientation(share),
            turning: None,
        }
    }

    pub fn evaluate(&mut self, requests: &[Request]) -> Result<Vec<Vector6<f64>>, WriteError> {
        let mut values = Vec::with_capacity(requests.len());
        let total = self.answered + requests.len();
        for batch in requests.chunks(BATCH) {
            if self.monitor.cancelled() {
                return Err(WriteError::Cancelled);
            }
            let mut answers = self.field.corrections(batch).into_iter();
            if self.monitor.cancelled() {
                return Err(WriteError::Cancelled);
            }
            for request in batch {
                let failure = |message: String| WriteError::Field {
                    line: self.path.moves[request.move_index].line,
                    share: request.share,
                    position_mm: request.position_mm,
                    message,
                };
                let answer = answers.next();
                let mut value = match answer.map(|a| a.map(|c| c.in_lengths(self.lever_mm))) {
                    Some(Ok(value)) if !value.iter().all(|number| number.is_finite()) => {
                        return Err(failure(
                            "the field answered with no finite number".to_owned(),
                        ));
                    }
                    Some(Ok(value)) => {
                        let turns = value.fixed_rows::<3>(3) != Vector3::zeros();
                        if turns && request.orientation.is_none() {
                            return Err(failure(
                                "the field turns the tool, and the program states no orientation"
                                    .to_owned(),
                            ));
                        }
                        value
                    }
                    Some(Err(reason)) => return Err(failure(reason.message)),
                    None => return Err(failure("the field gave too few answers".to_owned())),
                };
                if is_last_with_rotary_axes(self.path, request.move_index) {
                    // The next block expects the angles of the program.
                    value.fixed_rows_mut::<3>(3).fill(0.0);
                }
                for axis in 0..3 {
                    if !self.path.stated[axis] {
                        self.left_out_mm = larger(self.left_out_mm, value[axis].abs());
                        value[axis] = 0.0;
                    }
                }
                values.push(value);
            }
            self.answered += batch.len();
            self.monitor
                .progress(self.answered, total.max(self.answered));
        }
        Ok(values)
    }
}

/// A rapid that turns by rotary axes, before moves that do not say how these stand.
fn is_last_with_rotary_axes(path: &Path, move_index: usize) -> bool {
    let states = |motion: &Move| {
        let turn = motion.tool_turn.as_ref();
        turn.is_some_and(|turn| turn.rotary.is_some()) && motion.known != Knowledge::Nothing
    };
    let motion = &path.moves[move_index];
    let goes_on = path.moves.get(move_index + 1).is_some_and(states);
    motion.kind == MoveKind::Rapid && states(motion) && !goes_on
}

/// Points queried in one call of the field.
const BATCH: usize = 16_384;
