//! The path, when all blocks are read.

use nalgebra::Vector3;

use crate::error::{ProgramError, ProgramErrorKind};
use crate::path::curve::Curve;
use crate::path::moves::{Knowledge, Path, Warning};
use crate::reading::block::Block;
use crate::reading::interpreting::interpreter::Interpreter;
use crate::text::program::Program;

impl Interpreter<'_> {
    /// The path of a part of a longer program, which states these axes anywhere. Warnings about the whole program are
    /// made elsewhere.
    pub(crate) fn finish_part(
        mut self,
        program: &Program,
        stated: [bool; 3],
    ) -> Result<Path, ProgramError> {
        self.places.stated = stated;
        let mut path = self.finish(program)?;
        path.warnings.clear();
        Ok(path)
    }

    pub(crate) fn finish(mut self, program: &Program) -> Result<Path, ProgramError> {
        self.note_what_is_known(program)?;
        self.warn_of_unknown_beginning();
        self.warn_of_moved_axes();
        self.warn_of_calls_without_effect();
        self.warnings.extend(self.repeated.finish());
        let mut path = Path {
            // The spindle is along z of the part if all rotary axes are at zero.
            tool_axis: match &self.options.rotary {
                Some(rotary) => rotary.tool_at_zero.inverse() * Vector3::z(),
                None => Vector3::z(),
            },
            moves: self.moves,
            stated: self.places.stated,
            warnings: self.warnings,
            tool_changes: Vec::new(),
            spindle_changes: self.spindle.finish(),
            pauses: self.pauses,
            events: self.events,
            part: None,
            units_assumed_on: self.units_assumed_on,
            unjudged_feed_on: self.unjudged_feed_on,
            outside_calls: self.outside_calls,
        };
        self.tools.finish(&mut path, program, self.options)?;
        path.warnings.extend(path.rotary_findings());
        path.warnings.sort_by_key(|warning| warning.line);
        Ok(path)
    }

    /// A place is known where all axes are that the program states anywhere: only now it is clear which.
    fn note_what_is_known(&mut self, program: &Program) -> Result<(), ProgramError> {
        let stated = self.places.stated;
        let covers = |known: &[bool; 3]| (0..3).all(|axis| known[axis] || !stated[axis]);
        for (motion, (before, after, _)) in self.moves.iter_mut().zip(&self.knowledge) {
            if motion.words.is_to_machine() {
                continue;
            }
            motion.known = match (covers(before), covers(after)) {
                (true, _) => Knowledge::Whole,
                (false, true) => Knowledge::End,
                (false, false) => Knowledge::Nothing,
            };
            if motion.known != Knowledge::Whole && motion.curve != Curve::Line {
                let block = Block::on(program, motion.line)?;
                return Err(block.refuse(
                    ProgramErrorKind::Ambiguous, None,
                    "the arc is made before the program has stated all axes it moves later",
                    "state X, Y and Z before the first arc, or give the start position (--start-position-mm, or start_position_mm under [reading] in the job file)",
                ));
            }
        }
        Ok(())
    }

    /// Blocks before the program states where the tool is; those behind a place that was lost are noted where they are read.
    fn warn_of_unknown_beginning(&mut self) {
        let mut unknown = self
            .moves
            .iter()
            .zip(&self.knowledge)
            .filter(|(motion, (.., lost))| {
                motion.known == Knowledge::Nothing && !motion.words.is_to_machine() && !lost
            });
        let Some((first, _)) = unknown.next() else {
            return;
        };
        let found = unknown_beginning(first.line, 1 + unknown.count());
        self.warnings.push(found);
    }
}

/// Warning for the blocks, the first of them on this line, before the program states where the tool is.
pub(crate) fn unknown_beginning(line: usize, count: usize) -> Warning {
    let (blocks, carried) = match count {
        1 => ("1 block moves".to_owned(), "it is"),
        _ => (format!("{count} blocks move"), "they are"),
    };
    Warning {
        line,
        text: format!(
            "{blocks} before the program has stated where the tool is; {carried} carried unchanged (a start position changes this: --start-position-mm, or start_position_mm under [reading] in the job file)"
        ),
    }
}
