//! External axes from one motion to the next.

use crate::error::ProgramError;
use crate::model::motion::Motion;
use crate::text::source::SourceFile;

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
