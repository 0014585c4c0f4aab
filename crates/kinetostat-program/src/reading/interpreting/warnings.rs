//! Warnings about words that are read literally.

use crate::path::moves::ExtraMode;
use crate::reading::beside::{COORDINATES, OTHER_AXES};
use crate::reading::block::Block;
use crate::reading::interpreting::Interpreter;
use crate::reading::options::{OtherAxes, Units};
use crate::text::program::Program;

/// Path tolerances up to this get no warning, mm: programs hold hundredths.
const LEAVES_MM: f64 = 0.01;

impl Interpreter<'_> {
    /// `G64 P0.5` lets the control round corners by half a millimetre, whatever is written between them.
    pub(super) fn warn_of_path_tolerance(&mut self, block: &Block<'_>) {
        // P belongs to G64, and is no word of the block.
        let mut words = block.words.iter();
        let (Some(own), Some(640)) = (words.find(|w| w.letter == b'P'), block.codes.path_mode)
        else {
            return;
        };
        let tolerance = own.value;
        let mm = tolerance * self.modes.units().map_or(1.0, Units::mm_per_unit);
        if mm > LEAVES_MM {
            self.repeated.note_of_corrections(block.line_number, &format!("the control may leave the path by {mm} mm from here on (G64 P{tolerance}), however it is corrected: no figure has that in it"));
        }
    }

    /// Settings of the control that round corners, or look ahead.
    pub(super) fn warn_of_look_ahead(&mut self, block: &Block<'_>) {
        if block.codes.looks_ahead {
            self.repeated.note_of_corrections(block.line_number, "a setting of look-ahead or precision (G5, G5.1, G103, G187) is carried as it is written: how far the control may leave the path under it is in no figure");
        }
    }

    /// Lengths without a unit are millimetres, but where they are zero on the way to a place of the machine.
    pub(super) fn assume_units(&mut self, block: &Block<'_>) {
        let any = |letter: &u8| block.value(*letter).is_some_and(|value| value != 0.0);
        let states_a_length = block.codes.machine.is_none() || COORDINATES.iter().any(any);
        if states_a_length && self.modes.assume_units() {
            self.units_assumed_on = Some(block.line_number);
            self.warn(block.line_number, "no G20 or G21 stands before the first motion: the lengths are taken for millimetres; if they are others, give the units (--units, or units under [reading] in the job file)");
        }
    }

    pub(super) fn warn_block_delete(&mut self, line: usize) {
        self.repeated.note(line, "blocks marked with / are taken as run; the output is right only with the machine's block delete switch off (--block-delete skip leaves them out)");
    }

    pub(super) fn warn_of_text_after_end(&mut self, program: &Program, index: usize) {
        let text = program.bytes()[program.content(&program.lines()[index])].trim_ascii_start();
        let comment = text.starts_with(b"(") || text.starts_with(b";");
        if !comment && text.iter().any(u8::is_ascii_alphanumeric) {
            self.repeated.note_of_corrections(program.number_of(index), "text follows the closing tape mark %: it is carried unchanged, and is taken to be for people");
        }
    }

    /// Two work coordinate systems in one program are at different places, or one would do; with no
    /// offset for either, the places are not known.
    pub(super) fn warn_of_systems_without_offsets(&mut self, line: usize) {
        let now = self.modes.work_offset;
        let first = *self.first_system.get_or_insert(now);
        let offsets = &self.origins_mm;
        let stated = |system: usize| offsets.get(system).copied().flatten();
        let origin = |system: usize| stated(system).unwrap_or_default();
        let how = match now.max(first) < offsets.len() {
            true => "--work-offset, or work_offset_mm under [reading] in the job file",
            false => {
                "--work-offset, with G54 to G59.3 in place of G54.1 and G154, whose origins cannot be stated here"
            }
        };
        if stated(now).is_none() && offsets.iter().any(Option::is_some) {
            self.repeated.note(line, &format!("the origin of this work coordinate system is not stated, that of another is: it is taken to be the part's; state it ({how}), or these blocks are corrected for the wrong place"));
        } else if now != first
            && origin(now) == origin(first)
            && self.rotary_origin(now) == self.rotary_origin(first)
        {
            self.repeated.note(line, &format!("a second work coordinate system is used, but both have the same origin here: state where they are in the part ({how}), or these blocks are corrected for the wrong place"));
        }
    }

    /// The user said that these axes stand still; the program may say otherwise.
    pub(super) fn warn_of_moved_axes(&mut self) {
        if self.options.other_axes == OtherAxes::Carried {
            return;
        }
        let rotary = self.options.rotary.as_deref();
        let is_rotary = |letter: &char| {
            rotary.is_some_and(|rotary| rotary.axes.iter().any(|axis| axis.letter == *letter))
        };
        for letter in OTHER_AXES
            .map(char::from)
            .into_iter()
            .filter(|l| !is_rotary(l))
        {
            let words = || {
                self.moves.iter().flat_map(|motion| {
                    let own = motion.extra.iter().filter(|extra| extra.letter == letter);
                    own.map(|extra| (motion.line, *extra))
                })
            };
            let moved = words().find(|(_, extra)| match (extra.mode, extra.start) {
                (ExtraMode::Incremental, _) => extra.word != 0.0,
                (_, Some(start)) => extra.word != start,
                (_, None) => false,
            });
            if let Some((line, extra)) = moved {
                let from = match (extra.mode, extra.start) {
                    (ExtraMode::Absolute, Some(start)) => format!("from {start} to {}", extra.word),
                    _ => format!("by {}", extra.word),
                };
                self.warn_of_corrections(line, &format!("axis {letter} moves {from} though it is said to stand still: from here on the corrections are right only if that does not change where the tool is in the part"));
            } else if let Some((line, _)) = words().next() {
                self.warn_of_corrections(
                    line,
                    &format!("axis {letter} is carried along and taken to stand still"),
                );
            }
        }
    }
}
