//! Canned cycles: what of a cycle holds for the blocks that follow, and the places of its holes.

use crate::expanding::translate::holes::{Hole, Spindle};
use crate::expanding::translate::{MotionBlock, Place};
use crate::expanding::{Dialect, Wrong, wrong};
use crate::number::number;
use crate::reading::interpreting::Interpreter;

/// Maximum repeats of a cycle.
const MOST_REPEATS: f64 = 1e5;

/// Modal parameters of a canned cycle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Cycle {
    /// Code of the cycle in tenths.
    pub code: u32,
    retract: f64,
    depth: f64,
    dwell: Option<f64>,
    peck: Option<f64>,
    shift: [Option<f64>; 3],
    /// Depth coordinate before the first cycle of a row.
    initial: f64,
    /// True if R and the depth are increments (G91); `levels` has the resulting levels.
    incremental: bool,
    levels: [f64; 2],
}

/// G87 of Fanuc.
const BACK_BORING: u32 = 870;

impl Cycle {
    /// True for a cycle of Fanuc's controllers that plain blocks do not make: a rigid tap, a fine boring whose way aside is a parameter of the
    /// control, a back boring, a boring from which the operator draws the tool.
    pub fn is_the_controls(&self, is_rigid: bool) -> bool {
        match self.code {
            740 | 840 => is_rigid,
            760 => self.shift[0].is_none() && self.shift[1].is_none(),
            code => matches!(code, BACK_BORING | 880),
        }
    }

    /// The blocks of one hole under the tool, which stands at its level R (back boring: anywhere above it).
    fn as_written(&self, rigid: Option<&str>, from_back: bool, to_level: bool) -> Vec<String> {
        let level = if from_back { "G98" } else { "G99" };
        let mut text = format!("{level} G{}", self.code / 10);
        let lengths = [
            (b'Z', Some(self.depth)),
            (b'R', Some(self.retract)),
            (b'Q', self.peck),
        ];
        let shift = [(b'I', self.shift[0]), (b'J', self.shift[1])];
        for (letter, value) in lengths.into_iter().chain(shift) {
            if let Some(value) = value {
                let digits = number(value);
                // Without a point it may count thousandths.
                let point = if digits.contains('.') { "" } else { "." };
                text.push_str(&format!(" {}{digits}{point}", char::from(letter)));
            }
        }
        if let Some(dwell) = self.dwell {
            text.push_str(&format!(" P{}", number(dwell)));
        }
        let end = if to_level { "G80 G99" } else { "G80 G98" };
        let blocks = rigid.map(str::to_owned).into_iter();
        blocks.chain([text, end.to_owned()]).collect()
    }
}

/// True if a code (in tenths) is a canned cycle.
pub(crate) fn is_cycle(code: u32) -> bool {
    matches!(code, 730 | 740 | 760) || (810..=890).contains(&code)
}

/// The blocks of a cycle, and what it keeps for the next one.
pub(crate) fn cycle(
    code: u32,
    block: &MotionBlock,
    before: Option<Cycle>,
    state: &Interpreter<'_>,
    dialect: Dialect,
    rigid: Option<&str>,
) -> Result<(Vec<String>, Cycle), Wrong> {
    let [first, second, normal] = state.plane_axes();
    let letters = [first, second, normal].map(|axis| b"XYZ"[axis]);
    let mut place = Place::of(state);
    let (Some(a), Some(b), Some(height)) = (place.at[first], place.at[second], place.at[normal])
    else {
        return wrong(
            "where the tool is before the cycle is not known",
            "state X, Y and Z with G0 before it; at the beginning of the program the start position does it (--start-position-mm, or start_position_mm under [reading] in the job file)",
        );
    };
    refuse_other_words(block, normal)?;
    let incremental = place.incremental;
    let mut cycle = words_of(
        code,
        block,
        before,
        letters[2],
        height,
        incremental,
        dialect,
    )?;
    let same = before.filter(|cycle| cycle.code == code || dialect == Dialect::Fanuc);
    let repeats = repeats_of(block, dialect)?;
    let is_carried = dialect == Dialect::Fanuc && cycle.is_the_controls(rigid.is_some());
    let was_incremental = same.is_some_and(|one| one.incremental);
    if is_carried && (incremental || was_incremental || normal != 2) {
        return wrong(
            format!(
                "the cycle G{} stays as it is written, and its levels would have to be places along Z",
                code / 10
            ),
            "write G90 and G17 before it, or its moves as G0 and G1 blocks",
        );
    }
    let from_back = is_carried && code == BACK_BORING;
    if from_back && state.retracts_to_level() == Some(true) {
        return wrong(
            "G87 bores from the back and goes back to its start: it has no return to the level R (G99)",
            "write G98 before it",
        );
    }
    cycle.levels = match from_back {
        // It goes back to where it began.
        true => [cycle.initial; 2],
        false => levels_of(&cycle, same, block, letters[2], dialect)?,
    };
    let [level, bottom] = cycle.levels;
    if dialect != Dialect::LinuxCnc && same.is_some_and(|one| one.incremental != incremental) {
        // Later holes keep the levels, in words of the current distance mode.
        (cycle.retract, cycle.depth) = match incremental {
            true => (level - cycle.initial, bottom - level),
            false => (level, bottom),
        };
    }
    let mut texts = Vec::new();
    let at = |plane: [f64; 2], height: f64| {
        let mut to = [None; 3];
        (to[first], to[second], to[normal]) = (Some(plane[0]), Some(plane[1]), Some(height));
        to
    };
    let (mut initial, mut now) = (cycle.initial, height);
    // Fanuc goes over the first hole where it is, and then to the level.
    let from_below = dialect == Dialect::Fanuc && height < level;
    let starts_below = initial < level && repeats > 0;
    if starts_below {
        initial = level;
        if !from_below {
            texts.extend(place.go("G0", at([a, b], level)));
            now = level;
        }
    }
    let stated = state.retracts_to_level();
    let to_level = goes_to_level(stated, dialect);
    if dialect == Dialect::Fanuc && starts_below && to_level == Some(false) {
        return wrong(
            "the cycle begins below its retract level (R), and with G98 it goes back down there behind each hole, and to the next one",
            "move above R before the cycle, or write G99",
        );
    }
    let clear = height_between(to_level, [level, initial])?;
    let mut hole_at = [a, b];
    for repeat in 0..repeats {
        hole_at = next_hole(
            block,
            hole_at,
            incremental,
            repeat,
            [letters[0], letters[1]],
        )?;
        if repeat == 0 && (now > level || from_below) {
            texts.extend(place.go("G0", at(hole_at, now)));
            texts.extend(place.go("G0", at(hole_at, level)));
        } else {
            texts.extend(place.go("G0", at(hole_at, clear)));
            if clear > level {
                texts.extend(place.go("G0", at(hole_at, level)));
            }
        }
        if is_carried {
            texts.extend(cycle.as_written(rigid, from_back, stated == Some(true)));
            texts.extend(place.go("G0", at(hole_at, clear)));
            continue;
        }
        let hole = Hole {
            at: hole_at,
            level,
            clear,
            bottom,
            dwell: cycle.dwell,
            peck: cycle.peck,
            shift: cycle.shift,
            middle: cycle.shift[2].map(|k| if incremental { bottom + k } else { k }),
            peck_back: state.peck_back(),
            dialect,
        };
        let mut go = |code: &str, plane: [f64; 2], height: f64| place.go(code, at(plane, height));
        texts.extend(hole.blocks(code, Spindle::of(state), &mut go)?);
    }
    Ok((texts, cycle))
}

/// Words that no cycle takes.
fn refuse_other_words(block: &MotionBlock, normal: usize) -> Result<(), Wrong> {
    if block.polar.is_there() && normal != 2 {
        return wrong("polar words outside the plane XY (G17)", "write X, Y and Z");
    }
    if block.has_other_axis() {
        return wrong(
            "a canned cycle moves no axis but X, Y, Z",
            "move it before the cycle",
        );
    }
    Ok(())
}

/// Merges the words of a block with the modal ones of the cycle before it; its levels are not known yet.
fn words_of(
    code: u32,
    block: &MotionBlock,
    before: Option<Cycle>,
    depth_letter: u8,
    height: f64,
    incremental: bool,
    dialect: Dialect,
) -> Result<Cycle, Wrong> {
    let same = before.filter(|cycle| cycle.code == code);
    // Fanuc keeps R, the depth, P and Q from one cycle to another until G80 (Operator's Manual B-63534EN, section 13.1).
    let held = before.filter(|_| same.is_some() || dialect == Dialect::Fanuc);
    let kept = |letter: u8, of: fn(&Cycle) -> f64, what: &'static str| {
        let own = block.value(letter).or(held.as_ref().map(of));
        own.ok_or((
            format!(
                "the cycle G{} has no {what} ({})",
                code / 10,
                char::from(letter)
            ),
            "write the word into its first block",
        ))
    };
    let optional = |letter: u8, of: fn(&Cycle) -> Option<f64>| {
        block.value(letter).or(held.as_ref().and_then(of))
    };
    let shift = |letter: u8, of: fn(&Cycle) -> Option<f64>| {
        block.value(letter).or(same.as_ref().and_then(of))
    };
    if let Some(time) = block.value(b'P').filter(|time| *time < 0.0) {
        return wrong(
            format!(
                "the dwell of the cycle G{} is below zero (P{time})",
                code / 10
            ),
            "write a time of zero or more",
        );
    }
    Ok(Cycle {
        code,
        retract: kept(b'R', |c| c.retract, "retract level")?,
        depth: kept(depth_letter, |c| c.depth, "depth")?,
        dwell: optional(b'P', |c| c.dwell),
        peck: optional(b'Q', |c| c.peck),
        shift: [
            shift(b'I', |c| c.shift[0]),
            shift(b'J', |c| c.shift[1]),
            shift(b'K', |c| c.shift[2]),
        ],
        initial: before.map_or(height, |cycle| cycle.initial),
        incremental,
        levels: [0.0; 2],
    })
}

/// Number of repeats of a cycle.
fn repeats_of(block: &MotionBlock, dialect: Dialect) -> Result<usize, Wrong> {
    // Fanuc repeats by K (others of its kind by L), and K0 only keeps the words.
    let k = block.value(b'K').filter(|_| dialect == Dialect::Fanuc);
    let repeats = block.value(b'L').or(k).unwrap_or(1.0);
    let least = match dialect {
        Dialect::Fanuc => 0.0,
        _ => 1.0,
    };
    if repeats.fract() != 0.0 || !(least..=MOST_REPEATS).contains(&repeats) {
        return wrong(
            format!("a cycle is repeated a whole number of times (L), at most {MOST_REPEATS}"),
            "correct L",
        );
    }
    Ok(repeats as usize)
}

/// The level of R and that of the depth.
fn levels_of(
    cycle: &Cycle,
    same: Option<Cycle>,
    block: &MotionBlock,
    depth_letter: u8,
    dialect: Dialect,
) -> Result<[f64; 2], Wrong> {
    let Cycle {
        retract,
        depth,
        initial,
        incremental,
        ..
    } = *cycle;
    let (mut level, mut bottom) = match incremental {
        false => (retract, depth),
        true => (retract + initial, retract + initial + depth),
    };
    // R and depth of a block before the change between G90 and G91.
    if let Some(same) = same.filter(|same| same.incremental != incremental) {
        let kept = [b'R', depth_letter].map(|letter| block.value(letter).is_none());
        match dialect {
            Dialect::LinuxCnc => {}
            Dialect::Undecided if kept != [false; 2] => {
                return wrong(
                    "the distance mode changes in a row of cycles: Fanuc keeps the levels of R and the depth, LinuxCNC reads their numbers anew as places or increments",
                    "write R and the depth into the block, or name the dialect (--dialect)",
                );
            }
            _ => {
                level = if kept[0] { same.levels[0] } else { level };
                bottom = match kept[1] {
                    true => same.levels[1],
                    false if incremental => level + depth,
                    false => depth,
                };
            }
        }
    }
    if level < bottom {
        return wrong(
            format!("the cycle's retract level {level} is below its depth {bottom}"),
            "correct R, or the depth",
        );
    }
    Ok([level, bottom])
}

/// True if a cycle retracts to the level of R (G99), false if to its start (G98); `None` if it is not known.
fn goes_to_level(stated: Option<bool>, dialect: Dialect) -> Option<bool> {
    stated.or(match dialect {
        Dialect::LinuxCnc => Some(true),
        Dialect::Fanuc => Some(false),
        Dialect::Undecided => None,
    })
}

/// The height between the holes: the level of R (G99), or that of the start (G98).
fn height_between(to_level: Option<bool>, [level, initial]: [f64; 2]) -> Result<f64, Wrong> {
    match to_level {
        Some(true) => Ok(level),
        Some(false) => Ok(initial),
        None if initial == level => Ok(level),
        None => wrong(
            "whether the cycle goes back to its start (G98) or to R (G99) is not stated: LinuxCNC begins with G99, Fanuc with G98",
            "write G98 or G99 before the cycle, or name the dialect (--dialect)",
        ),
    }
}

/// The place of a hole: that of the words, or the one before and the increments.
fn next_hole(
    block: &MotionBlock,
    at: [f64; 2],
    incremental: bool,
    repeat: usize,
    letters: [u8; 2],
) -> Result<[f64; 2], Wrong> {
    let polar = |at: [f64; 2]| {
        block
            .polar
            .place(at, incremental)
            .map_err(|reason| (reason.to_owned(), "write the place with X and Y"))
    };
    if !incremental {
        let first = match block.polar.is_there() {
            true => polar(at)?,
            false => [0, 1].map(|k| block.value(letters[k]).unwrap_or(at[k])),
        };
        return Ok(if repeat == 0 { first } else { at });
    }
    let moved = [0, 1].map(|k| at[k] + block.value(letters[k]).unwrap_or(0.0));
    match block.polar.is_there() {
        true => polar(moved),
        false => Ok(moved),
    }
}
