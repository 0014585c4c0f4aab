//! Blocks in which the tool stands still: G4, M0, M1, M60, M6.
//!
//! P of G4 is seconds with LinuxCNC (`docs/src/gcode/g-code.adoc`, G4), milliseconds with Fanuc; X and U are seconds where
//! they are known; S (Siemens, Haas lathes) counts turns of the spindle.

use crate::path::pause::{Pause, PauseKind};
use crate::reading::block::Block;

/// The pause that a block makes; `None` if it makes none.
pub(crate) fn pause(block: &Block<'_>) -> Option<Pause> {
    let kind = match block.codes.dwell {
        true => dwell(block),
        false => {
            let words = block.words.iter().filter(|word| word.letter == b'M');
            let kinds = words.filter_map(|word| match word.tenths() {
                0 | 10 | 600 => Some(PauseKind::Stop),
                60 => Some(PauseKind::ToolChange),
                _ => None,
            });
            // A block with both changes the tool, in whatever order its words stand.
            kinds.reduce(|one, other| match other {
                PauseKind::ToolChange => other,
                _ => one,
            })?
        }
    };
    Some(Pause {
        line: block.line_number,
        kind,
    })
}

fn dwell(block: &Block<'_>) -> PauseKind {
    let value = |letter: u8| {
        let mut words = block.words.iter();
        let word = words.find(|word| word.letter == letter);
        word.map(|word| word.value)
            .filter(|value| value.is_finite() && *value >= 0.0)
    };
    match (value(b'P'), value(b'X').or(value(b'U'))) {
        (Some(number), _) => PauseKind::Dwell(number),
        (None, Some(seconds)) => PauseKind::DwellSeconds(seconds),
        (None, None) => PauseKind::DwellUnknown,
    }
}
