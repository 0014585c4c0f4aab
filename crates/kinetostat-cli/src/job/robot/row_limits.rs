//! Rows of a table of joint values that are beyond the limits of the model's joints.

use kinetostat::PostureRequest;
use kinetostat_formats::{RobotProgram, Target};
use kinetostat_model::Model;
use kinetostat_program::Warning;

use crate::ui::numbers::short;

/// Stretches of rows that are named; further ones are counted.
const MOST_NAMED: usize = 20;

/// Excess over a limit that is a matter of digits, rad.
const DIGITS: f64 = 1e-6;

/// Rows one behind the other in which a joint is beyond the same limit.
struct Stretch {
    joint: String,
    limit: f64,
    /// The other side of its range.
    other: f64,
    first: usize,
    last: usize,
    /// Index of its last row.
    row: usize,
    /// Line and value where it is farthest beyond.
    most: (usize, f64),
}

/// Warnings about rows beyond limits; `program` is the table with its joint values, `model_joints` converts the values of a row
/// (deg) to those of the model, rad.
pub(crate) fn rows_beyond_limits(
    model: &Model,
    model_joints: impl Fn(&[f64]) -> [f64; 6],
    program: &RobotProgram,
) -> Vec<Warning> {
    let mut found: Vec<Stretch> = Vec::new();
    for (row, motion) in program.motions.iter().enumerate() {
        let Target::Joints { values_deg } = &motion.target else {
            continue;
        };
        let commands = model_joints(values_deg);
        let posture = (model.mechanism).posture(PostureRequest::commands(&commands));
        // Non-finite values are refused by the reader of the rows.
        let Ok(posture) = posture else { continue };
        for (joint, value, (low, high)) in posture.limit_violations() {
            let (limit, other) = match value < low {
                true => (low, high),
                false => (high, low),
            };
            if (value - limit).abs() < DIGITS {
                continue;
            }
            let known = found
                .iter_mut()
                .rev()
                .find(|known| known.joint == joint && known.limit == limit && known.row + 1 == row);
            match known {
                Some(known) => {
                    (known.last, known.row) = (motion.line, row);
                    if (value - limit).abs() > (known.most.1 - limit).abs() {
                        known.most = (motion.line, value);
                    }
                }
                None => found.push(Stretch {
                    joint,
                    limit,
                    other,
                    first: motion.line,
                    last: motion.line,
                    row,
                    most: (motion.line, value),
                }),
            }
        }
    }
    let unnamed = found.split_off(MOST_NAMED.min(found.len()));
    let mut said: Vec<Warning> = found.iter().map(Stretch::warning).collect();
    if let Some(first) = unnamed.first() {
        said.push(Warning {
            line: first.first,
            text: format!(
                "from here on joints are beyond their limits in {} more stretches of rows",
                unnamed.len()
            ),
        });
    }
    said
}

impl Stretch {
    fn warning(&self) -> Warning {
        let degrees = |value: f64| short(value.to_degrees());
        let (line, value) = self.most;
        let place = match (self.first == self.last, line == self.first) {
            (true, _) => String::new(),
            (false, true) => format!(" (and beyond it up to line {})", self.last),
            (false, false) => format!(
                " in line {line} (beyond it from here to line {})",
                self.last
            ),
        };
        // Equivalent angle, whole turns away.
        let turn = std::f64::consts::TAU.copysign(self.other - self.limit);
        let turned = value + turn * ((self.limit - value) / turn).ceil();
        let (low, high) = (self.limit.min(self.other), self.limit.max(self.other));
        let instead = match (low..=high).contains(&turned) {
            true => format!(", where {} deg is the same place", degrees(turned)),
            false => String::new(),
        };
        Warning {
            line: self.first,
            text: format!(
                "{} is at {} deg{place}, and its limit in the model is {} deg: a controller stops there. Let the program be written inside the limits{instead}, or change limits_deg in the model if the arm goes farther",
                self.joint,
                degrees(value),
                degrees(self.limit)
            ),
        }
    }
}
