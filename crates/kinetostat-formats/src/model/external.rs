//! External axes from one motion to the next.

use std::collections::BTreeSet;

use crate::error::ProgramError;
use crate::model::motion::Motion;
use crate::model::program::{Language, RobotProgram};
use crate::text::source::SourceFile;

/// The motions with which external axes move, as far as the text says it, by their indices. RAPID and TP programs state all axes
/// that there are, so that one which is stated for the first time may come from anywhere.
pub(crate) fn moving_external_axes(program: &RobotProgram) -> BTreeSet<usize> {
    let states_all = matches!(program.language, Language::Rapid | Language::FanucLs);
    let mut known: Vec<Option<f64>> = Vec::new();
    let mut moving = BTreeSet::new();
    for (index, motion) in program.motions.iter().enumerate() {
        let Some(pose) = motion.target.pose() else {
            known.clear();
            continue;
        };
        known.resize(known.len().max(pose.external.len()), None);
        for (known, value) in known.iter_mut().zip(&pose.external) {
            let Some(value) = value else {
                continue;
            };
            let is_elsewhere = known.map_or(states_all && index > 0, |before| before != *value);
            if is_elsewhere {
                moving.insert(index);
            }
            *known = Some(*value);
        }
    }
    moving
}

/// The first motion at which an external axis is elsewhere than at the motions before it; `name` is that of an axis, counted
/// from 0, in words.
pub(crate) fn moving_axis<'m>(
    files: &[SourceFile],
    motions: impl Iterator<Item = (&'m Motion, &'m [Option<f64>])>,
    name: impl Fn(usize) -> String,
) -> Option<ProgramError> {
    let mut known: Vec<Option<f64>> = Vec::new();
    for (motion, external) in motions {
        known.resize(known.len().max(external.len()), None);
        for (axis, value) in external.iter().enumerate() {
            match (known[axis], value) {
                (None, Some(_)) => known[axis] = *value,
                (Some(before), Some(value)) if before != *value => {
                    return Some(ProgramError::at(
                        &files[motion.file],
                        motion.span.clone(),
                        format!(
                            "external axis {} moves from {before} to {value}: the arm stands elsewhere then",
                            name(axis)
                        ),
                        "read with external axes carried if they do not move the arm or the part",
                    ));
                }
                _ => {}
            }
        }
    }
    None
}
