//! P in G2 and G3 of LinuxCNC: an arc of more than one turn, as full circles and the arc behind them.
//!
//! Source: LinuxCNC, `docs/src/gcode/g-code.adoc`, G2 and G3: P is the number of turns, begun ones counted; the way along the normal
//! is even over all of them (its canonical call, `ARC_FEED`, says the same).

use std::f64::consts::TAU;

use crate::expanding::translate::{MotionBlock, Place};
use crate::expanding::{Wrong, wrong};
use crate::number::number;
use crate::reading::interpreting::Interpreter;

/// Maximum turns of one block.
const MOST_TURNS: f64 = 1e5;

/// Ends nearer than this share of the radius are one place: a full circle.
const SAME: f64 = 1e-9;

/// True if a block is an arc with P.
pub(crate) fn counts_turns(block: &MotionBlock, state: &Interpreter<'_>) -> bool {
    let is_arc = match block.motion {
        Some(code) => matches!(code, 20 | 30),
        None => state.moves_in_arcs() && !block.wants_axes && block.has_place(),
    };
    is_arc && block.value(b'P').is_some()
}

/// The blocks of such an arc, one for each turn.
pub(crate) fn turns(block: &MotionBlock, state: &Interpreter<'_>) -> Result<Vec<String>, Wrong> {
    let count = block.value(b'P').unwrap_or(1.0);
    if count.fract() != 0.0 || !(1.0..=MOST_TURNS).contains(&count) {
        return wrong(
            "P in G2 and G3 is a whole number of turns from 1 to 100000",
            "correct P",
        );
    }
    let Some(code) = block.motion else {
        return wrong(
            "P counts the turns of an arc without G2 or G3 in its block",
            "write G2 or G3 into the block",
        );
    };
    let code = code / 10;
    let is_other_word = block.has_other_axis() || block.value(b'Q').is_some() || block.wants_axes;
    if is_other_word || !block.has_only_own_words() || block.polar.is_there() {
        return wrong(
            "P counts the turns of an arc beside words that have a P, or beside other axes",
            "write them in a block of their own before it",
        );
    }
    let [first, second, normal] = state.plane_axes();
    let mut last = format!("G{code}");
    let mut circle = format!("G{code}");
    let word = |letter: u8, value: f64| format!(" {}{}", char::from(letter), number(value));
    for letter in [b"XYZ"[first], b"XYZ"[second]] {
        if let Some(value) = block.value(letter) {
            last.push_str(&word(letter, value));
        }
    }
    let centre_words: String = b"IJKR"
        .iter()
        .filter_map(|letter| Some(word(*letter, block.value(*letter)?)))
        .collect();
    let along = block.value(b"XYZ"[normal]);
    if count == 1.0 {
        last.extend(along.map(|value| word(b"XYZ"[normal], value)));
        return Ok(vec![last + &centre_words]);
    }
    if block.value(b'R').is_some() {
        return wrong(
            "P counts the turns of an arc that is given by its radius (R)",
            "write its centre with I, J or K",
        );
    }
    let place = Place::of(state);
    let [Some(a), Some(b), Some(height)] = [first, second, normal].map(|axis| place.at[axis])
    else {
        return wrong(
            "where the tool is before the arc is not known",
            "state X, Y and Z before it, or give the start position",
        );
    };
    circle.push_str(&centre_words);
    let Some(along) = along else {
        let mut texts = vec![circle; count as usize - 1];
        texts.push(last + &centre_words);
        return Ok(texts);
    };
    let end = [(first, a), (second, b)].map(|(axis, at)| {
        match (block.value(b"XYZ"[axis]), place.incremental) {
            (None, _) => at,
            (Some(word), true) => at + word,
            (Some(word), false) => word,
        }
    });
    let centre = [(first, a), (second, b)].map(|(axis, at)| {
        match (block.value(b"IJK"[axis]), state.centres_are_places()) {
            (Some(word), true) => word,
            (word, _) => at + word.unwrap_or(0.0),
        }
    });
    let share = 1.0 / (count - 1.0 + part_of_turn([a, b], end, centre, code == 2));
    let rise = match place.incremental {
        true => along,
        false => along - height,
    };
    let mut texts = Vec::with_capacity(count as usize);
    let mut at = height;
    for turn in 1..count as usize {
        let next = height + rise * share * turn as f64;
        let value = if place.incremental { next - at } else { next };
        texts.push(circle.clone() + &word(b"XYZ"[normal], value));
        at = next;
    }
    let value = match place.incremental {
        true => height + rise - at,
        false => along,
    };
    texts.push(last + &word(b"XYZ"[normal], value) + &centre_words);
    Ok(texts)
}

/// Fraction of a turn of an arc: above 0, up to 1.
fn part_of_turn(from: [f64; 2], to: [f64; 2], centre: [f64; 2], clockwise: bool) -> f64 {
    let radius = (from[0] - centre[0]).hypot(from[1] - centre[1]);
    if (to[0] - from[0]).hypot(to[1] - from[1]) <= SAME * radius {
        return 1.0;
    }
    let angle = |of: [f64; 2]| (of[1] - centre[1]).atan2(of[0] - centre[0]);
    let turned = match clockwise {
        true => angle(from) - angle(to),
        false => angle(to) - angle(from),
    };
    match turned.rem_euclid(TAU) / TAU {
        0.0 => 1.0,
        part => part,
    }
}
