//! A block while compensation is on, and one behind G40.

use crate::expanding::flat::Flat;
use crate::expanding::radius::contour::{Contour, Programmed};
use crate::expanding::radius::geometry::in_plane;
use crate::expanding::radius::pending::{Shape, write};
use crate::expanding::radius::words::{Motion, Words, no_motion};
use crate::expanding::translate::{MotionBlock, Polar};
use crate::expanding::{Origin, Trouble, Wrong};
use crate::number::number;
use crate::reading::options::Units;

/// A block of plain words, the switch of compensation taken out.
#[derive(Clone, Copy)]
pub(crate) struct Block<'b> {
    pub text: &'b [u8],
    pub words: &'b Words,
    pub origin: Origin,
}

/// First moves that a contour allows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum First {
    Any,
    /// The tool is not where the program has it.
    Straight,
}

/// Tool position after a block that follows G40.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Next {
    /// At the programmed place.
    Together,
    /// Offset from the programmed place.
    Apart,
}

/// A block of a contour.
pub(crate) fn within(
    block: Block<'_>,
    contour: &mut Contour,
    first: First,
    programmed: &mut Flat<'_>,
    flat: &mut Flat<'_>,
) -> Result<(), Trouble> {
    let Block {
        text,
        words,
        origin,
    } = block;
    let axes = programmed.interpreter.plane_axes();
    words.check_within(axes)?;
    let Some(motion) = Motion::of(text, &programmed.interpreter) else {
        programmed.add(text, origin)?;
        if words.stops() {
            contour.settle(flat)?;
        }
        return contour.words(text, origin, flat);
    };
    let made = motion.run(origin, programmed)?.ok_or_else(no_motion)?;
    if !motion.before.is_empty() {
        contour.words(&motion.before, origin, flat)?;
    }
    let now = Programmed::of(&made, axes)?;
    if first == First::Straight {
        now.straight_only()?;
    }
    let after = motion.after.clone();
    contour.go(now, motion.dress(&made, axes, origin), flat)?;
    if !after.is_empty() {
        contour.settle(flat)?;
        programmed.add(&after, origin)?;
        flat.add(&after, origin)?;
    }
    Ok(())
}

/// A block behind G40. There is no other run as programmed where a change of the tool has ended the difference; the next move
/// is straight all the same.
pub(crate) fn behind(
    block: Block<'_>,
    programmed: Option<&mut Flat<'_>>,
    flat: &mut Flat<'_>,
) -> Result<Next, Trouble> {
    let Block {
        text,
        words,
        origin,
    } = block;
    let Some(programmed) = programmed else {
        let motion = Motion::of(text, &flat.interpreter);
        let next = match &motion {
            Some(motion) => motion.refuse_arc().map(|()| Next::Together)?,
            None => Next::Apart,
        };
        flat.add(text, origin)?;
        return Ok(next);
    };
    if let Some(text) = to_machine_place(text, words, programmed)? {
        // The programmed run goes there by the words of the program, the flat one by all axes.
        programmed.add(block.text, origin)?;
        flat.add(text.as_bytes(), origin)?;
        return Ok(Next::Together);
    }
    words.check_behind()?;
    let Some(motion) = Motion::of(text, &programmed.interpreter) else {
        programmed.add(text, origin)?;
        flat.add(text, origin)?;
        return Ok(Next::Apart);
    };
    let made = motion.run(origin, programmed)?.ok_or_else(no_motion)?;
    if !motion.before.is_empty() {
        flat.add(&motion.before, origin)?;
    }
    let axes = flat.interpreter.plane_axes();
    let code = Programmed::of(&made, axes)?.straight_only()?;
    let after = motion.after.clone();
    let dress = motion.dress(&made, axes, origin);
    let to = in_plane(&made.end, axes);
    write(&dress.last(Shape::Straight(code), to), flat)?;
    if !after.is_empty() {
        flat.add(&after, origin)?;
    }
    Ok(Next::Together)
}

/// The block with all axes of the plane; none where it is no such rapid.
///
/// The axes of the plane that it does not name go to the place that the program counts from (LinuxCNC, tried): they are written
/// too, and so the machine's zero must be known.
pub(crate) fn to_machine_place(
    text: &[u8],
    words: &Words,
    programmed: &Flat<'_>,
) -> Result<Option<String>, Wrong> {
    let block = MotionBlock::of(text, Polar::default());
    if !words.is_in_machine_coordinates() || !block.has_place() {
        return Ok(None);
    }
    let state = &programmed.interpreter;
    let axes = state.plane_axes();
    let letters = axes.map(|axis| b"XYZ"[axis]);
    let Some(zero) = programmed.machine_zero_mm() else {
        return Err((
            "G53 behind G40: the tool is beside the place that the program counts from, and where that is in the machine is not known".to_owned(),
            "move with G0 or G1 first, or give the machine's zero (--machine-zero-mm)",
        ));
    };
    let unit = state.units().map_or(1.0, Units::mm_per_unit);
    let mut made = String::from_utf8_lossy(text.trim_ascii_end()).into_owned();
    for (axis, letter) in axes.into_iter().zip(letters).take(2) {
        if block.value(letter).is_some() {
            continue;
        }
        let Some(place) = state
            .place_mm(axis)
            .filter(|_| !state.has_tool_length_along(axis))
        else {
            return Err((
                format!(
                    "where the tool is along {} is not known behind G40",
                    char::from(letter)
                ),
                "move with G0 or G1 first",
            ));
        };
        let value = (place - zero[axis]) / unit;
        // Before a comment: the words belong to the block.
        let end = made.find(['(', ';']).unwrap_or(made.len());
        made.insert_str(end, &format!(" {}{} ", char::from(letter), number(value)));
    }
    Ok(Some(made.trim_end().to_owned()))
}
