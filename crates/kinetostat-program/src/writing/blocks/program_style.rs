//! Style common to all blocks of a program.

use nalgebra::Vector3;

use crate::path::moves::{Move, Path};
use crate::text::program::Program;
use crate::writing::blocks::block_text::motion_word;

/// Style common to all blocks of a program.
pub(crate) struct ProgramStyle {
    /// Axes that may be written.
    pub stated: [bool; 3],
    /// See [`Path::tool_axis`].
    pub tool_axis: Vector3<f64>,
    /// Every motion of the program has its own motion word, so its pieces must too: it may be meant for
    /// a firmware without modal motion (most printers').
    pub repeats_motion: bool,
}

impl ProgramStyle {
    pub fn of(program: &Program, path: &Path) -> Self {
        let names_motion = |motion: &Move| {
            program
                .line(motion.line)
                .is_some_and(|line| motion_word(program.words(line)).is_some())
        };
        Self {
            stated: path.stated,
            tool_axis: path.tool_axis,
            repeats_motion: match program.part() {
                Some(part) => part.repeats_motion,
                None => path.moves.iter().all(names_motion),
            },
        }
    }
}
