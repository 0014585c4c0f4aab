//! Blocks that go to a place of the machine: G28, G30, G53.
//!
//! G28 and G30 go through the point that their axis words say (in the modes in force) to the reference point, with the
//! axes that are named, or with all where none is (LinuxCNC, `docs/src/gcode/g-code.adoc`, G28 and G30). G53 takes the
//! words of its block as machine coordinates, for a straight move (the same page, G53).

use nalgebra::Vector3;

use crate::error::{ProgramError, ProgramErrorKind};
use crate::path::moves::Motion;
use crate::reading::block::Block;
use crate::reading::extra::ExtraAxes;
use crate::reading::modes::Modes;
use crate::reading::options::{ReadOptions, Units};
use crate::text::lex::{Spanned, Token, tokens_of};

const COORDINATES: [u8; 3] = *b"XYZ";

/// End of a block in machine coordinates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct MachinePlace {
    /// Axes that it moves.
    pub axes: [bool; 3],
    /// Their places in the part frame, in mm, where these are known.
    pub places_mm: [Option<f64>; 3],
    /// True if it names no axis, and so moves all.
    pub all: bool,
}

/// Reads a block with G28, G30 or G53; none where it moves nothing.
pub(crate) fn machine_place(
    block: &Block<'_>,
    modes: &Modes,
    options: &ReadOptions,
) -> Result<Option<MachinePlace>, ProgramError> {
    check(block)?;
    let named = COORDINATES.map(|letter| block.value(letter).is_some());
    let others = ExtraAxes::LETTERS;
    let any = named != [false; 3] || others.iter().any(|letter| block.value(*letter).is_some());
    let is_g53 = block.codes.machine == Some(530);
    if is_g53 {
        if !any {
            return Ok(None);
        }
        check_machine_coordinates(block, modes, options.of_fanuc_run)?;
    }
    let zero = options.machine_zero_mm;
    let reference = match block.codes.machine {
        Some(280) => options.reference_points_mm[0],
        // P3 and P4 are further points (Fanuc).
        _ => options.reference_points_mm[1]
            .filter(|_| matches!(number_of(block, b'P'), None | Some(2.0))),
    };
    let bare = has_bare_letters(block);
    let all = !is_g53 && (!any || bare);
    let axes = match all {
        true => [true; 3],
        false => named,
    };
    let mut places_mm = [None; 3];
    for axis in (0..3).filter(|axis| axes[*axis] && !modes.has_tool_length(*axis)) {
        let at = match is_g53 {
            true if modes.incremental => None,
            true => match (block.value(COORDINATES[axis]), zero) {
                // Without units it is zero.
                (Some(value), Some(_)) => {
                    Some(value * modes.units().map_or(1.0, Units::mm_per_unit))
                }
                _ => None,
            },
            // The axes that `G28 X` homes depend on the printer.
            false => reference.filter(|_| !bare).map(|point| point[axis]),
        };
        places_mm[axis] = zero
            .zip(at)
            .map(|(zero, at): (Vector3<f64>, f64)| zero[axis] + at);
    }
    Ok(Some(MachinePlace {
        axes,
        places_mm,
        all,
    }))
}

/// Refuses codes that must not stand beside these.
fn check(block: &Block<'_>) -> Result<(), ProgramError> {
    let codes = &block.codes;
    let (is_g53, name) = match codes.machine {
        Some(530) => (true, "G53"),
        Some(300) => (false, "G30"),
        _ => (false, "G28"),
    };
    let other = codes.dwell
        || codes.position_offset.is_some()
        || matches!(codes.tool_length, Some(431 | 432));
    // `G0 G28 Z0` is common; the axis words are those of G28.
    let motion = !is_g53 && !matches!(codes.motion, None | Some(Motion::Rapid | Motion::Off));
    match other || motion {
        true => Err(block.refuse(
            ProgramErrorKind::Ambiguous,
            None,
            &format!("{name} and another code that may take the axis words are in one block"),
            "write them in two blocks",
        )),
        false => Ok(()),
    }
}

fn check_machine_coordinates(
    block: &Block<'_>,
    modes: &Modes,
    is_fanuc: bool,
) -> Result<(), ProgramError> {
    let (reason, remedy) = match modes.motion {
        // Fanuc's controllers pass over it, and others of their kind go there: the place behind it is not known.
        _ if modes.incremental && !is_fanuc => (
            "G53 stands beside increments (G91): some controllers refuse it, some ignore it",
            "write G90 before G53 (the place behind it is taken for unknown with --expand and --dialect fanuc)",
        ),
        Some(Motion::Rapid) => return Ok(()),
        // A rapid on Fanuc's controllers, whatever is in force (Operator's Manual B-64304EN, G53).
        Some(Motion::Off) | None if is_fanuc => return Ok(()),
        Some(Motion::Off) | None => (
            "G53 without a motion word before it: what it does depends on the machine",
            "write G53 G0 (Fanuc and Haas: --expand with --dialect fanuc)",
        ),
        Some(_) => (
            "a feed in machine coordinates cannot be corrected for its place in the part",
            "write it in part coordinates, or as a rapid (G53 G0) where it does not cut",
        ),
    };
    Err(block.refuse(ProgramErrorKind::Ambiguous, None, reason, remedy))
}

fn number_of(block: &Block<'_>, letter: u8) -> Option<f64> {
    let mut words = block.words.iter();
    words
        .find(|word| word.letter == letter)
        .map(|word| word.value)
}

/// `G28 X` names an axis without a number (printers).
fn has_bare_letters(block: &Block<'_>) -> bool {
    let mut tokens: Vec<Spanned> = Vec::new();
    tokens_of(
        &block.program.bytes()[block.program.content(block.line)],
        &mut tokens,
    );
    tokens
        .iter()
        .any(|spanned| matches!(spanned.token, Token::Letter(_)))
}
