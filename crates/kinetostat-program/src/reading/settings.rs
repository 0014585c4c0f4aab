//! G10: origins of work coordinate systems, and the table of tools.
//!
//! `G10 L2 Pn` states the origin of system n in machine coordinates; the tool stands still, and its coordinates change where
//! the system is in force (LinuxCNC, `docs/src/gcode/g-code.adoc`, G10 L2). L1, L10 and L11 change the table of tools: no
//! place changes before the next G43. Words that controllers read differently (P0, increments) are refused.

use nalgebra::Vector3;

use crate::error::{ProgramError, ProgramErrorKind};
use crate::reading::block::Block;
use crate::reading::extra::ExtraAxes;
use crate::reading::modes::Modes;
use crate::text::line::Word;

/// Systems that there are: G54 to G59.3.
const SYSTEMS: usize = 9;

/// Setting that a block with G10 changes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Setting {
    /// The table of tools.
    Tools,
    /// Parts of the origin of a system, mm, part frame.
    Origin {
        system: usize,
        origin_mm: [Option<f64>; 3],
    },
}

/// Reads a block with G10.
pub(crate) fn setting(
    block: &Block<'_>,
    modes: &Modes,
    machine_zero_mm: Option<Vector3<f64>>,
) -> Result<Setting, ProgramError> {
    let refuse = |word: Option<&Word>, what: &str, remedy: &str| {
        let reason = format!("G10 (set offsets or tool data): {what}");
        Err(block.refuse(ProgramErrorKind::Ambiguous, word, &reason, remedy))
    };
    let word = |letter: u8| block.words.iter().find(|word| word.letter == letter);
    let codes = &block.codes;
    let other = codes.dwell
        || codes.motion.is_some()
        || codes.machine.is_some()
        || codes.position_offset.is_some()
        || matches!(codes.tool_length, Some(431 | 432));
    if other {
        let what = "another code that may take the axis words is in its block";
        return refuse(None, what, "write them in two blocks");
    }
    match word(b'L').map(|l| l.value) {
        Some(1.0 | 10.0 | 11.0) => return Ok(Setting::Tools),
        Some(2.0) => {}
        Some(20.0) => {
            let what = "L20 makes the tool's place the reference, and a corrected place would be another one";
            let remedy =
                "flatten the program with `kinetostat expand` and the machine's zero: it writes L2";
            return refuse(word(b'L'), what, remedy);
        }
        _ => {
            let what = "only L1, L2, L10 and L11 are followed";
            return refuse(word(b'L'), what, "set the offsets at the machine");
        }
    }
    if let Some(turned) = word(b'R').filter(|r| r.value != 0.0) {
        let what = "R turns the coordinates of the system";
        return refuse(
            Some(turned),
            what,
            "let the CAM system write turned coordinates",
        );
    }
    let number = word(b'P').map(|p| p.value);
    let Some(system) = (1..=SYSTEMS).find(|n| number == Some(*n as f64)) else {
        let what = "P names no system: P0 is the one in force to LinuxCNC, and an offset of all systems to Fanuc";
        return refuse(word(b'P'), what, "write P1 for G54 to P9 for G59.3");
    };
    if modes.incremental {
        let what = "with G91 it adds to the origin on Fanuc, and states it on LinuxCNC";
        return refuse(None, what, "write G90 before it");
    }
    let named = *b"XYZ";
    if named.iter().all(|letter| word(*letter).is_none()) {
        let origin_mm = [None; 3];
        return Ok(Setting::Origin {
            system: system - 1,
            origin_mm,
        });
    }
    let Some(zero) = machine_zero_mm else {
        let what = "the origin is stated in machine coordinates, and where the machine's zero is in the part is not known";
        return refuse(
            None,
            what,
            "give it (--machine-zero-mm, or machine_zero_mm under [reading] in the job file), or set the offsets at the machine and give work offsets (--work-offset)",
        );
    };
    let unit = modes.mm_per_unit(block)?;
    let mut origin_mm = [None; 3];
    for (axis, letter) in named.into_iter().enumerate() {
        origin_mm[axis] = word(letter).map(|word| zero[axis] + word.value * unit);
    }
    Ok(Setting::Origin {
        system: system - 1,
        origin_mm,
    })
}

/// Words of a block that state origins of other axes.
pub(crate) fn other_axes<'b>(block: &Block<'b>) -> impl Iterator<Item = &'b Word> + use<'b> {
    let words = block.words.iter();
    words.filter(|word| ExtraAxes::LETTERS.contains(&word.letter))
}
