//! Steps from where the tool is (`LIN_REL {X 10}`) with their ends stated.

use std::ops::Range;

use crate::krl::kept::kept_angles;
use crate::krl::position::PLACE;
use crate::krl::table::motion_row;
use crate::model::motion::Motion;
use crate::model::program::RobotProgram;
use crate::model::target::PoseTarget;
use crate::text::edits::Edits;
use crate::text::name::Name;

/// Absolute motion word that replaces that of a step (`LIN` for `LIN_REL`).
pub(super) fn step_of(program: &RobotProgram, motion: &Motion) -> Option<&'static str> {
    let word = program.files[motion.file].part(&motion.site.keyword);
    let row = motion_row(&Name::of(word)?)?;
    row.name
        .strip_suffix("_REL")
        .filter(|_| row.ends.are_steps())
}

/// Writes the end of a step in place of the step.
pub(super) fn state_step(
    program: &RobotProgram,
    motion: &Motion,
    straight: &'static str,
    pose: &PoseTarget,
    edits: &mut [Edits],
) {
    let place = pose.position_mm.iter().map(|value| format!("{value:.6}"));
    let angles = kept_angles(&pose.orientation);
    let values = place.chain(angles.iter().map(|value| format!("{value:.8}")));
    let members: Vec<String> = (PLACE.iter().zip(values))
        .map(|(name, value)| format!("{name} {}", trimmed(value)))
        .collect();
    let edits = &mut edits[motion.file];
    edits.replace(motion.site.keyword.clone(), straight);
    let file = &program.files[motion.file];
    let span = motion.site.target_span.clone();
    let behind = span.end..motion.span.end;
    if let Some(word) = axes_word(file.part(&behind)) {
        edits.replace(span.end + word.start..span.end + word.end, "");
    }
    edits.replace(span, format!("{{{}}}", members.join(",")));
}

/// Position of the word that selects the axes of a step, after its end, with the blanks before it.
fn axes_word(behind: &[u8]) -> Option<Range<usize>> {
    let sign = behind.iter().position(|byte| *byte == b'#')?;
    let before = behind[..sign].trim_ascii_end();
    // The text after WITH holds settings.
    let settings = before
        .windows("WITH".len())
        .any(|word| word.eq_ignore_ascii_case(b"WITH"));
    let word = behind[sign + 1..].trim_ascii_start();
    let length = behind.len() - word.len() + "BASE".len();
    (!settings && length <= behind.len()).then_some(before.len()..length)
}

/// A number without zeros that say nothing.
pub(super) fn trimmed(number: String) -> String {
    let short = number.trim_end_matches('0').trim_end_matches('.');
    match short {
        "-0" => "0".to_owned(),
        _ => short.to_owned(),
    }
}
