//! Path of the tool: the second stage of reading.

use crate::error::{ProgramError, ProgramErrorKind};
use crate::path::moves::{Motion, Path};
use crate::reading::beside::{
    COORDINATES, refuse_beside_look_ahead, refuse_dwell_with_arc, refuse_dwell_with_motion,
    refuse_negative_dwell, refuse_other_axes, refuse_parameters_of_calls,
};
use crate::reading::block::Block;
use crate::reading::directions::states_direction;
use crate::reading::extra::ExtraAxes;
use crate::reading::interpreting::interpreter::Interpreter;
use crate::reading::machine::machine_place;
use crate::reading::options::{BlockDelete, ReadOptions};
use crate::reading::pause::pause;
use crate::text::line::LineKind;
use crate::text::program::Program;

/// Interprets the motions of a program.
///
/// Modal state before the first word that sets it: absolute coordinates (G90), incremental arc
/// centres (G91.1), plane XY (G17), feed per minute (G94), the first work coordinate system (G54), no
/// motion word, millimetres (with a warning). Once M82 or M83 was met they alone decide about E words, before
/// that G90 and G91 do.
///
/// # Errors
///
/// The first block that is not followed, with its line, the reason and what to do; see
/// [`crate::CODES`] for the codes.
pub fn interpret(program: &Program, options: &ReadOptions) -> Result<Path, ProgramError> {
    let mut interpreter = Interpreter::new(options);
    for index in 0..program.lines().len() {
        interpreter.run_line(program, index)?;
    }
    interpreter.finish(program)
}

impl Interpreter<'_> {
    pub(crate) fn run_line(&mut self, program: &Program, index: usize) -> Result<(), ProgramError> {
        let line = &program.lines()[index];
        let skipped = line.block_delete && self.options.block_delete == BlockDelete::Skip;
        if line.kind == LineKind::AfterEnd {
            self.warn_of_text_after_end(program, index);
        }
        if line.kind == LineKind::AfterEnd || program.words(line).is_empty() || skipped {
            return Ok(());
        }
        if line.block_delete {
            self.warn_block_delete(program.number_of(index));
        }
        if self.outside_call(program, index)? {
            return Ok(());
        }
        let block = Block::of(program, index)?;
        self.run(&block)
    }

    fn run(&mut self, block: &Block<'_>) -> Result<(), ProgramError> {
        if block.is_vendor() {
            self.modes.extra.set_extruder_mode(block.codes.extruder);
            return Ok(());
        }
        self.refuse_cycle(block)?;
        refuse_dwell_with_motion(block)?;
        refuse_negative_dwell(block)?;
        let has_axis_words = COORDINATES
            .iter()
            .chain(ExtraAxes::LETTERS)
            .any(|letter| block.value(*letter).is_some());
        if let Some(end) = self.ended
            && (has_axis_words || block.codes.motion.is_some())
        {
            return Err(block.refuse(
                ProgramErrorKind::Ambiguous, None,
                &format!("the block follows the program's end on line {end}: some controllers run on, some stop"),
                "remove the blocks after M2 or M30, or the M2 or M30 before them",
            ));
        }
        refuse_other_axes(block, self.options)?;
        refuse_beside_look_ahead(block, has_axis_words)?;
        if self.modes.overrides_options(block) {
            self.warn(block.line_number, "the program names its units before it moves: they hold, and not those given (--units, or units under [reading] in the job file)");
        }
        self.modes.set(block)?;
        if has_axis_words || self.is_centre_only(block) {
            self.assume_units(block);
        }
        self.warn_of_look_ahead(block);
        refuse_dwell_with_arc(block, self.modes.motion)?;
        self.modes
            .extra
            .count_from(self.rotary_origin(self.modes.work_offset));
        self.rotary.set_tool_centre_point(block, &mut self.modes)?;
        self.rotary.refuse_lean(block, &self.modes)?;
        if block.codes.tool_centre_point {
            self.modes.directions = self.rotary.law_of_directions(block, &self.modes)?;
        }
        self.warn_of_path_tolerance(block);
        self.change_tool_length(block)?;
        self.tools.note(block)?;
        self.spindle.note(block, self.modes.units())?;
        self.pauses.extend(pause(block));
        if block.codes.sets {
            self.set_offsets(block)?;
        } else if block.codes.machine.is_some() {
            match machine_place(block, &self.modes, self.options)? {
                Some(place) => self.go_to_machine_place(block, &place),
                None => self.note_no_motion(block),
            }
        } else if let Some(code) = block.codes.cycle {
            self.carry_cycle(block, code)?;
        } else if block.codes.position_offset.is_some() {
            self.set_position_offset(block, has_axis_words)?;
        } else if has_axis_words || self.is_centre_only(block) || self.turns_alone(block) {
            refuse_parameters_of_calls(block, self.modes.motion, self.modes.directions.is_some())?;
            self.read_move(block)?;
        } else {
            self.note_no_motion(block);
        }
        if block.codes.ends {
            self.ended.get_or_insert(block.line_number);
            let line = block.line_number;
            let moves = self.moves.last().is_some_and(|last| last.line == line);
            self.spindle.end(line + usize::from(moves));
        }
        Ok(())
    }

    /// `I0 J1 K1` under G43.5 turns the tool where it stands.
    fn turns_alone(&self, block: &Block<'_>) -> bool {
        self.modes.directions.is_some() && states_direction(block)
    }

    /// `G2 I5` is a full circle without an axis word.
    fn is_centre_only(&self, block: &Block<'_>) -> bool {
        matches!(
            self.modes.motion,
            Some(Motion::Clockwise | Motion::CounterClockwise)
        ) && b"IJKR".iter().any(|letter| block.value(*letter).is_some())
    }
}
