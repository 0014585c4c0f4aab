//! G10 and G92: the program counts from another place.

use nalgebra::Vector3;

use crate::error::{ProgramError, ProgramErrorKind};
use crate::path::moves::{Change, Event, OffsetChange};
use crate::reading::beside::COORDINATES;
use crate::reading::block::Block;
use crate::reading::extra::ExtraAxes;
use crate::reading::interpreting::Interpreter;
use crate::reading::modes::Modes;
use crate::text::Word;

impl Interpreter<'_> {
    /// G10: the tool stands still; where it is in the part stays known.
    pub(super) fn set_offsets(&mut self, block: &Block<'_>) -> Result<(), ProgramError> {
        match setting(block, &self.modes, self.options.machine_zero_mm)? {
            Setting::Tools => {
                self.modes.forget_length_number();
                self.repeated.note_of_corrections(block.line_number, "the program changes the machine's table of tools (G10): corrections are made for the tools as they are given here");
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

/// Systems that there are: G54 to G59.3.
const SYSTEMS: usize = 9;

/// Setting that a block with G10 changes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Setting {
    /// The table of tools.
    Tools,
    /// Parts of the origin of a system, mm, part frame.
    Origin {
        system: usize,
        origin_mm: [Option<f64>; 3],
    },
}

/// Reads a block with G10.
///
/// `G10 L2 Pn` states the origin of system n in machine coordinates; the tool stands still, and its coordinates change where
/// the system is in force (LinuxCNC, `docs/src/gcode/g-code.adoc`, G10 L2). L1, L10 and L11 change the table of tools: no
/// place changes before the next G43. Words that controllers read differently (P0, increments) are refused.
pub(crate) fn setting(
    block: &Block<'_>,
    modes: &Modes,
    machine_zero_mm: Option<Vector3<f64>>,
) -> Result<Setting, ProgramError> {
    let refuse = |word: Option<&Word>, what: &str, remedy: &str| {
        let reason = format!("G10 (set offsets or tool data): {what}");
        Err(block.refuse(ProgramErrorKind::Ambiguous, word, &reason, remedy))
    };
    let word = |letter: u8| block.words.iter().find(|word| word.letter == letter);
    let codes = &block.codes;
    let other = codes.dwell
        || codes.motion.is_some()
        || codes.machine.is_some()
        || codes.position_offset.is_some()
        || matches!(codes.tool_length, Some(431 | 432));
    if other {
        let what = "another code that may take the axis words is in its block";
        return refuse(None, what, "write them in two blocks");
    }
    match word(b'L').map(|l| l.value) {
        Some(1.0 | 10.0 | 11.0) => return Ok(Setting::Tools),
        Some(2.0) => {}
        Some(20.0) => {
            let what = "L20 makes the tool's place the reference, and a corrected place would be another one";
            let remedy =
                "flatten the program with `kinetostat expand` and the machine's zero: it writes L2";
            return refuse(word(b'L'), what, remedy);
        }
        _ => {
            let what = "only L1, L2, L10 and L11 are followed";
            return refuse(word(b'L'), what, "set the offsets at the machine");
        }
    }
    if let Some(turned) = word(b'R').filter(|r| r.value != 0.0) {
        let what = "R turns the coordinates of the system";
        return refuse(
            Some(turned),
            what,
            "let the CAM system write turned coordinates",
        );
    }
    let number = word(b'P').map(|p| p.value);
    let Some(system) = (1..=SYSTEMS).find(|n| number == Some(*n as f64)) else {
        let what = "P names no system: P0 is the one in force to LinuxCNC, and an offset of all systems to Fanuc";
        return refuse(word(b'P'), what, "write P1 for G54 to P9 for G59.3");
    };
    if modes.incremental {
        let what = "with G91 it adds to the origin on Fanuc, and states it on LinuxCNC";
        return refuse(None, what, "write G90 before it");
    }
    let named = *b"XYZ";
    if named.iter().all(|letter| word(*letter).is_none()) {
        let origin_mm = [None; 3];
        return Ok(Setting::Origin {
            system: system - 1,
            origin_mm,
        });
    }
    let Some(zero) = machine_zero_mm else {
        let what = "the origin is stated in machine coordinates, and where the machine's zero is in the part is not known";
        return refuse(
            None,
            what,
            "give it (--machine-zero-mm, or machine_zero_mm under [reading] in the job file), or set the offsets at the machine and give work offsets (--work-offset)",
        );
    };
    let unit = modes.mm_per_unit(block)?;
    let mut origin_mm = [None; 3];
    for (axis, letter) in named.into_iter().enumerate() {
        origin_mm[axis] = word(letter).map(|word| zero[axis] + word.value * unit);
    }
    Ok(Setting::Origin {
        system: system - 1,
        origin_mm,
    })
}

/// Words of a block that state origins of other axes.
pub(crate) fn other_axes<'b>(block: &Block<'b>) -> impl Iterator<Item = &'b Word> + use<'b> {
    let words = block.words.iter();
    words.filter(|word| ExtraAxes::LETTERS.contains(&word.letter))
}
