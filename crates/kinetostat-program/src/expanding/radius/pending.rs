//! Motions of the tool's centre as blocks of the flat program. They wait: the end of the last one along the contour is not settled
//! before the next one is known.
//!
//! Moves in depth, which stand on its end, and all words that came since wait after it. An inside corner moves the end back; a
//! stop of the program or G40 leaves it where it is.

use std::f64::consts::TAU;

use crate::expanding::flat::Flat;
use crate::expanding::radius::geometry::{Point, Sense, sweep};
use crate::expanding::{Origin, Trouble, Wrong};
use crate::number::number;
use crate::reading::interpreting::Interpreter;
use crate::reading::options::Units;

/// Minimum remaining length of a straight move, in mm.
const LEAST_MM: f64 = 1e-9;

/// Minimum remaining sweep of an arc, in rad: less may be read as a full circle.
const LEAST_SWEEP: f64 = 2e-6;

/// Ends of a circle nearer than this are one place, in mm.
const SAME_MM: f64 = 1e-10;

/// A circle of which a corner leaves less than this share is none.
const LEAST_SHARE: f64 = 0.125;

/// Angle by which an arc may turn further than programmed, in rad. LinuxCNC takes the lengths 0.0254 mm and 0.001 inch for
/// it, by the units in force.
fn further(units: Option<Units>) -> f64 {
    match units {
        Some(Units::Inches) => 0.001,
        _ => 0.0254,
    }
}

/// The motion along the contour that waits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Waiting {
    /// The move to the contour may end anywhere: it cuts nothing before its end.
    Entry,
    /// Line from a place, in a direction.
    Line { from: Point, direction: Point },
    /// Arc from a place about a centre; `sweep` as programmed, in rad.
    Arc {
        from: Point,
        centre: Point,
        sense: Sense,
        sweep: f64,
    },
}

enum Item {
    Words(Vec<u8>, Origin),
    Move(Piece),
}

/// Pending motions and words, in the order of the program.
#[derive(Default)]
pub(crate) struct Pending {
    along: Option<Waiting>,
    items: Vec<Item>,
}

impl Pending {
    /// The motion along the contour whose end can still be moved.
    pub fn along(&self) -> Option<Waiting> {
        self.along
    }

    /// True if a motion or a word is pending.
    pub fn is_waiting(&self) -> bool {
        !self.items.is_empty()
    }

    /// A new motion along the contour; nothing waits before it.
    pub fn begin(&mut self, along: Waiting, piece: Piece) {
        self.along = Some(along);
        self.items.push(Item::Move(piece));
    }

    /// A move in depth.
    pub fn stand(&mut self, piece: Piece) {
        self.items.push(Item::Move(piece));
    }

    /// Words without a motion.
    pub fn words(&mut self, text: Vec<u8>, origin: Origin) {
        self.items.push(Item::Words(text, origin));
    }

    /// Ends the motion at a place, and writes everything.
    pub fn end_at(&mut self, place: Point, flat: &mut Flat<'_>) -> Result<(), Trouble> {
        if let Some(along) = self.along.take() {
            check(along, place, flat.interpreter.units())?;
        }
        for item in std::mem::take(&mut self.items) {
            match item {
                Item::Words(text, origin) => flat.add(&text, origin)?,
                Item::Move(piece) => write(&Piece { to: place, ..piece }, flat)?,
            }
        }
        Ok(())
    }
}

/// Writes a motion behind all blocks so far.
pub(crate) fn write(piece: &Piece, flat: &mut Flat<'_>) -> Result<(), Trouble> {
    if let Some(text) = piece.text(&flat.interpreter)? {
        flat.add(&text, piece.origin)?;
    }
    Ok(())
}

/// Checks that something of a motion is left that ends at a place, and no more than was programmed.
///
/// LinuxCNC looks only where an inside corner or a straight move follows; here it is looked at before every next motion. It also
/// wants the radius of a shortened arc to stay within 0.01: the ends come from the arc's own circle here, so that it does.
fn check(along: Waiting, end: Point, units: Option<Units>) -> Result<(), Wrong> {
    let too_short = || {
        (
            "the corner before cannot be reached: the tool would have to go back beyond the start of its move, and cut into the contour"
                .to_owned(),
            "take a smaller tool, or widen the corners",
        )
    };
    match along {
        Waiting::Entry => Ok(()),
        Waiting::Line { from, direction } => match (end - from).dot(&direction) > LEAST_MM {
            true => Ok(()),
            false => Err(too_short()),
        },
        Waiting::Arc {
            from,
            centre,
            sense,
            sweep: programmed,
        } => {
            let left = sweep(from, centre, sense, end);
            let is_circle = programmed > TAU - LEAST_SWEEP;
            if is_circle && (end - from).norm() < SAME_MM {
                return Ok(());
            }
            let shares = TAU * LEAST_SHARE..=TAU - LEAST_SWEEP;
            if is_circle && !shares.contains(&left) {
                return Err((
                    "the full circle is not tangent to the moves before and behind it to the last digit: its ends are beside each other, and whether that is a circle or nothing depends on the controller".to_owned(),
                    "divide the circle into two arcs",
                ));
            }
            match left > LEAST_SWEEP && left < programmed + further(units) {
                true => Ok(()),
                false => Err(too_short()),
            }
        }
    }
}

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
