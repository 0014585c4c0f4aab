//! G53 behind G40: a rapid in machine coordinates from beside the contour.
//!
//! The axes of the plane that it does not name go to the place that the program counts from (LinuxCNC, tried): they are written
//! too, and so the machine's zero must be known.

use crate::expanding::flat::Flat;
use crate::expanding::number::number;
use crate::expanding::radius::words::Words;
use crate::expanding::translate::block::{MotionBlock, Polar};
use crate::expanding::translate::wrong::Wrong;
use crate::reading::options::Units;

/// The block with all axes of the plane; none where it is no such rapid.
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
