//! A block while compensation is on, and one behind G40.

use crate::expanding::expanded::Origin;
use crate::expanding::flat::Flat;
use crate::expanding::radius::contour::{Contour, Programmed};
use crate::expanding::radius::geometry::in_plane;
use crate::expanding::radius::machine::to_machine_place;
use crate::expanding::radius::motion::{Motion, no_motion};
use crate::expanding::radius::pending::write;
use crate::expanding::radius::piece::Shape;
use crate::expanding::radius::trouble::Trouble;
use crate::expanding::radius::words::Words;

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
