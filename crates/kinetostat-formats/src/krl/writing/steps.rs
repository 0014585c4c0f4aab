//! Steps from where the tool is (`LIN_REL {X 10}`) with their ends stated.

use crate::krl::kept::kept_angles;
use crate::krl::table::{Ends, motion_row};
use crate::model::motion::Motion;
use crate::model::program::RobotProgram;
use crate::model::target::PoseTarget;
use crate::text::edits::Edits;
use crate::text::name::Name;

/// Members of a position in the order in which they are written.
pub(super) const MEMBERS: [&str; 6] = ["X", "Y", "Z", "A", "B", "C"];

/// With which word a step is written that states its end.
pub(super) fn step_of(program: &RobotProgram, motion: &Motion) -> Option<&'static str> {
    let word = program.files[motion.file].part(&motion.site.keyword);
    let row = motion_row(&Name::of(word)?)?;
    (row.ends == Ends::Step).then_some(row.straight.unwrap_or("LIN"))
}

/// Writes the end of a step in place of the step.
pub(super) fn state_step(
    program: &RobotProgram,
    motion: &Motion,
    (straight, pose): (&'static str, &PoseTarget),
    edits: &mut [Edits],
) {
    let place = pose.position_mm.iter().map(|value| format!("{value:.6}"));
    let angles = kept_angles(&pose.orientation);
    let values = place.chain(angles.iter().map(|value| format!("{value:.8}")));
    let members: Vec<String> = (MEMBERS.iter().zip(values))
        .map(|(name, value)| format!("{name} {}", trimmed(value)))
        .collect();
    let edits = &mut edits[motion.file];
    edits.replace(motion.site.keyword.clone(), straight);
    let file = &program.files[motion.file];
    let behind = file.part(&(motion.site.target_span.end..motion.span.end));
    // In whose axes the step was.
    let blanks = behind.len() - behind.trim_ascii_start().len();
    let word = match behind.trim_ascii_start().starts_with(b"#") {
        true => blanks + "#BASE".len(),
        false => 0,
    };
    let span = motion.site.target_span.start..motion.site.target_span.end + word;
    edits.replace(span, format!("{{{}}}", members.join(",")));
}

/// A number without zeros that say nothing.
pub(super) fn trimmed(number: String) -> String {
    let short = number.trim_end_matches('0').trim_end_matches('.');
    match short {
        "-0" => "0".to_owned(),
        _ => short.to_owned(),
    }
}
