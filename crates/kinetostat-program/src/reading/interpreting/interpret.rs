//! Path of the tool: the second stage of reading.

use nalgebra::Vector3;

use crate::error::{ProgramError, ProgramErrorKind};
use crate::path::curve::Curve;
use crate::path::moves::{Knowledge, Motion, Path, Pause, PauseKind, Warning};
use crate::reading::beside::{
    COORDINATES, refuse_beside_look_ahead, refuse_dwell_with_arc, refuse_dwell_with_motion,
    refuse_negative_dwell, refuse_other_axes, refuse_parameters_of_calls,
};
use crate::reading::block::Block;
use crate::reading::directions::states_direction;
use crate::reading::extra::ExtraAxes;
use crate::reading::interpreting::Interpreter;
use crate::reading::machine::machine_place;
use crate::reading::options::{BlockDelete, ReadOptions};
use crate::text::LineKind;
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

/// The path, when all blocks are read.
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
    Warning::of_corrections(
        line,
        format!(
            "{blocks} before the program has stated where the tool is; {carried} carried unchanged (a start position changes this: --start-position-mm, or start_position_mm under [reading] in the job file)"
        ),
    )
}

/// The pause that a block makes; `None` if it makes none.
///
/// P of G4 is seconds with LinuxCNC (`docs/src/gcode/g-code.adoc`, G4), milliseconds with Fanuc; X and U are seconds where
/// they are known; S (Siemens, Haas lathes) counts turns of the spindle.
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
