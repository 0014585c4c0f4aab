//! G10 and G92: the program counts from another place.

use crate::error::{ProgramError, ProgramErrorKind};
use crate::path::moves::{Change, Event};
use crate::path::position_offset::OffsetChange;
use crate::reading::beside::COORDINATES;
use crate::reading::block::Block;
use crate::reading::extra::ExtraAxes;
use crate::reading::interpreting::interpreter::Interpreter;
use crate::reading::settings::{Setting, other_axes, setting};

impl Interpreter<'_> {
    /// G10: the tool stands still; where it is in the part stays known.
    pub(super) fn set_offsets(&mut self, block: &Block<'_>) -> Result<(), ProgramError> {
        match setting(block, &self.modes, self.options.machine_zero_mm)? {
            Setting::Tools => {
                self.modes.forget_length_number();
                self.repeated.note(block.line_number, "the program changes the machine's table of tools (G10): corrections are made for the tools as they are given here");
            }
            Setting::Origin { system, origin_mm } => {
                self.modes.use_units();
                let origin = self.origins_mm[system].get_or_insert_default();
                for axis in 0..3 {
                    origin[axis] = origin_mm[axis].unwrap_or(origin[axis]);
                }
                self.set_rotary_origins(block, system);
            }
        }
        self.note_no_motion(block);
        Ok(())
    }

    /// G10 L2 with words of other axes: those of the rotary axes of the machine count from there; where others stand is not known.
    fn set_rotary_origins(&mut self, block: &Block<'_>, system: usize) {
        for word in other_axes(block) {
            match ExtraAxes::rotary_index(word.letter) {
                Some(index) if self.rotary.is_counted(word.letter) => {
                    self.rotary_origins[system][index] = word.value;
                }
                _ => self.modes.extra.forget(block, true),
            }
        }
        let now = self.modes.work_offset;
        self.modes.extra.count_from(self.rotary_origin(now));
    }

    pub(super) fn set_position_offset(
        &mut self,
        block: &Block<'_>,
        has_axis_words: bool,
    ) -> Result<(), ProgramError> {
        if block.codes.motion.is_some() {
            return Err(block.refuse(
                ProgramErrorKind::Ambiguous,
                None,
                "G92 and a motion word are in one block",
                "write them in two blocks",
            ));
        }
        let change = match block.codes.position_offset {
            Some(920) => {
                if !has_axis_words {
                    return Err(block.refuse(
                        ProgramErrorKind::Ambiguous, None,
                        "G92 without an axis is an error to some controllers and means all axes to others",
                        "write each axis with its coordinate",
                    ));
                }
                self.here(block)?
            }
            _ if has_axis_words => {
                return Err(block.refuse(
                    ProgramErrorKind::Ambiguous,
                    None,
                    "an axis word appears in a block that clears, suspends or resumes G92",
                    "write the motion as a block of its own",
                ));
            }
            Some(921) => OffsetChange::Clear,
            Some(922) => OffsetChange::Suspend,
            _ => OffsetChange::Resume,
        };
        self.offset.apply(&change, &self.places.position);
        self.shifts
            .apply(&change, &self.places.stated, block.line_number);
        self.note_no_motion(block);
        self.events.push(Event {
            line: block.line_number,
            change: Change::Offset(change),
        });
        Ok(())
    }

    fn here(&mut self, block: &Block<'_>) -> Result<OffsetChange, ProgramError> {
        let mut coordinates_mm = [None; 3];
        let mut establishes = [false; 3];
        let work_offset_mm = self.work_offset_mm();
        for axis in 0..3 {
            let Some(value) = block.value(COORDINATES[axis]) else {
                continue;
            };
            let value_mm = value * self.modes.mm_per_unit(block)?;
            self.modes.use_units();
            coordinates_mm[axis] = Some(value_mm);
            if let Some(why) = self.places.why_lost(axis) {
                return Err(block.refuse(
                    ProgramErrorKind::Ambiguous,
                    block.word(COORDINATES[axis]),
                    &format!(
                        "{why}, so by how much G92 shifts the {} coordinates is not in the program",
                        char::from(COORDINATES[axis])
                    ),
                    "state the axis with a rapid (G0) and an absolute word before G92",
                ));
            }
            if !self.places.known[axis] {
                // The user tells where the tool stands: the coordinate is its place in the part.
                establishes[axis] = true;
                self.places.state(axis);
                self.places.position[axis] = value_mm + work_offset_mm[axis];
            }
        }
        self.modes.extra.set_here(block);
        Ok(OffsetChange::Here {
            coordinates_mm,
            work_offset_mm,
            establishes,
        })
    }

    /// Coordinates that were shifted by what the program does not say are at no known place.
    pub(super) fn refuse_shifted(&self, block: &Block<'_>) -> Result<(), ProgramError> {
        match (0..3).find(|axis| self.shifts.now[*axis]) {
            None => Ok(()),
            Some(axis) => Err(block.refuse(
                ProgramErrorKind::Ambiguous, None,
                &format!(
                    "line {} shifted the {} coordinates by an offset that is not in the program",
                    self.shifts.line,
                    char::from(COORDINATES[axis])
                ),
                "begin with G92.1 and state where the tool is with G0 before the first G92, or give the start position (--start-position-mm, or start_position_mm under [reading] in the job file)",
            )),
        }
    }
}
