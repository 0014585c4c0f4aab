//! A motion of the tool's centre as a block of the flat program.

use crate::expanding::expanded::Origin;
use crate::expanding::number::number;
use crate::expanding::radius::geometry::{Point, Sense};
use crate::expanding::translate::wrong::Wrong;
use crate::reading::interpreting::interpreter::Interpreter;

/// Words are rounded here, in program units: far below what counts, above what the arithmetic leaves.
const DIGITS: f64 = 1e12;

/// Shape of a piece.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Shape {
    /// `G0` or `G1`.
    Straight(&'static str),
    Arc {
        centre: Point,
        sense: Sense,
    },
}

/// A motion that is written.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Piece {
    pub shape: Shape,
    /// End in mm, part frame.
    pub to: Point,
    /// Depth, in mm, where the block states it.
    pub depth: Option<f64>,
    /// N word.
    pub lead: Vec<u8>,
    /// F and comments.
    pub tail: Vec<u8>,
    pub origin: Origin,
}

impl Piece {
    /// The block from where the tool is, in the modes in force; `None` for a straight move that goes nowhere.
    pub fn text(&self, state: &Interpreter<'_>) -> Result<Option<Vec<u8>>, Wrong> {
        let mut words = String::new();
        let [first, second, across] = state.plane_axes();
        // X before Y before Z.
        let mut in_plane = [(first, self.to.x), (second, self.to.y)];
        in_plane.sort_by_key(|(axis, _)| *axis);
        for (axis, to) in in_plane {
            if let Some(value) = word(state, axis, to)? {
                words.push_str(&format!(" {}{value}", ["X", "Y", "Z"][axis]));
            }
        }
        if let Some(depth) = self.depth {
            let value = match (state.is_incremental(), state.coordinate(across)) {
                (true, Ok(here)) => state.in_program(across, depth) - here,
                (true, Err(reason)) => return Err((reason, "state X, Y and Z before")),
                (false, _) => state.in_program(across, depth),
            };
            words.push_str(&format!(" {}{}", ["X", "Y", "Z"][across], rounded(value)));
        }
        let code = match self.shape {
            Shape::Straight(code) => code,
            Shape::Arc { sense, .. } => match sense {
                Sense::CounterClockwise => "G3",
                Sense::Clockwise => "G2",
            },
        };
        if let Shape::Arc { centre, .. } = self.shape {
            let mut centres = [(first, centre.x), (second, centre.y)];
            centres.sort_by_key(|(axis, _)| *axis);
            for (axis, centre) in centres {
                let place = state.in_program(axis, centre);
                let here = here(state, axis)?;
                let value = match state.centres_are_places() {
                    true => place,
                    false => place - here,
                };
                words.push_str(&format!(" {}{}", ["I", "J", "K"][axis], rounded(value)));
            }
        }
        let moves = !words.is_empty();
        if !moves && self.tail.is_empty() {
            return Ok(None);
        }
        let mut text = self.lead.clone();
        if moves {
            text.extend_from_slice(code.as_bytes());
            text.extend_from_slice(words.as_bytes());
        }
        if moves && !self.tail.is_empty() {
            text.push(b' ');
        }
        text.extend_from_slice(&self.tail);
        Ok(Some(text))
    }
}

fn here(state: &Interpreter<'_>, axis: usize) -> Result<f64, Wrong> {
    let place = state.coordinate(axis);
    place.map_err(|reason| (reason, "state X, Y and Z before cutter radius compensation"))
}

/// A word of an axis of the plane; `None` if the axis stands still.
fn word(state: &Interpreter<'_>, axis: usize, to: f64) -> Result<Option<String>, Wrong> {
    let (to, here) = (state.in_program(axis, to), here(state, axis)?);
    if (to - here).abs() * DIGITS < 1.0 {
        return Ok(None);
    }
    Ok(Some(rounded(match state.is_incremental() {
        true => to - here,
        false => to,
    })))
}

fn rounded(value: f64) -> String {
    number((value * DIGITS).round() / DIGITS)
}
