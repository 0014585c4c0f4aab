//! Blocks that are carried as they are written: canned cycles of the controller's own, and calls of subprograms in other files.

use crate::error::{ProgramError, ProgramErrorKind};
use crate::path::curve::Curve;
use crate::path::moves::{Knowledge, Motion, Move, MoveKind};
use crate::reading::block::Block;
use crate::reading::dialect::{Treatment, lookup};
use crate::reading::interpreting::Interpreter;
use crate::text::program::Program;
use crate::text::syntax::{FLATTEN, of_subprogram};

/// G87: the tool ends where it began.
const BACK_BORING: u32 = 870;

/// Canned cycles that stay as they are written: rigid taps, and borings whose way is the controller's own.
///
/// The expansion for Fanuc writes each hole as `G99 G84 Z-3. R1.` (back boring as `G98 G87`), without a place in the plane: the
/// tool is over the hole, and ends at the level R, which G98 does not leave for a cycle that begins there.
impl Interpreter<'_> {
    /// Refuses a canned cycle in another form than the one that is carried.
    pub(super) fn refuse_cycle(&self, block: &Block<'_>) -> Result<(), ProgramError> {
        let Some(code) = block.codes.cycle else {
            return Ok(());
        };
        let has = |letters: &[u8]| letters.iter().all(|letter| block.value(*letter).is_some());
        let level = match code {
            BACK_BORING => 980,
            _ => 990,
        };
        let is_carried = self.options.of_fanuc_run
            && block.codes.retract_mode == Some(level)
            && block.codes.motion.is_none()
            && has(b"ZR")
            && !b"XYABCUVW".iter().any(|letter| has(&[*letter]))
            && self.places.known == [true; 3]
            && self.modes.plane == [0, 1, 2]
            && !self.modes.incremental;
        let Some(Treatment::Refused { reason, remedy }) =
            lookup('G', code).map(|code| code.treatment)
        else {
            return Ok(());
        };
        match is_carried {
            true => Ok(()),
            false => Err(block.refuse(
                ProgramErrorKind::UnknownCode,
                block
                    .words
                    .iter()
                    .find(|w| w.letter == b'G' && w.tenths() == code),
                &format!("G{} (canned cycles): {reason}", code / 10),
                remedy,
            )),
        }
    }

    /// Carries a canned cycle: the tool stays over the hole.
    pub(super) fn carry_cycle(&mut self, block: &Block<'_>, code: u32) -> Result<(), ProgramError> {
        let mm_per_unit = self.modes.mm_per_unit(block)?;
        self.modes.use_units();
        let start = self.places.position;
        if let Some(level) = block.value(b'R').filter(|_| code != BACK_BORING) {
            let offset = self.work_offset_mm() + self.offset.active_mm;
            self.places.position[2] = level * mm_per_unit + offset[2];
        }
        self.repeated.note_of_corrections(block.line_number, &format!(
            "the cycle G{} stays as it is written: the place over its hole is corrected, its depth is not, and its way is in no length and no verdict",
            code / 10
        ));
        self.unjudged_feed_on.get_or_insert(block.line_number);
        self.modes.motion = Some(Motion::Off);
        self.knowledge.push(([true; 3], [true; 3], false));
        self.moves.push(Move {
            line: block.line_number,
            kind: MoveKind::Feed,
            curve: Curve::Line,
            start,
            end: self.places.position,
            tool_turn: None,
            extra: Vec::new(),
            feed: self.modes.feed,
            known: Knowledge::Nothing,
            words: self.coordinate_words(mm_per_unit, [false, false, true]),
        });
        Ok(())
    }
}

/// Calls of subprograms (M98, G65): only a run for Fanuc's controllers leaves them in a program, those that are in none of its files.
impl Interpreter<'_> {
    /// Carries a block that calls a subprogram: the tool is taken to stay where it is; false for any other block.
    pub(super) fn outside_call(
        &mut self,
        program: &Program,
        index: usize,
    ) -> Result<bool, ProgramError> {
        let words = program.words(&program.lines()[index]);
        let call = words.iter().find(|word| {
            word.letter == b'M' && word.value == 98.0 || word.letter == b'G' && word.value == 65.0
        });
        let Some(call) = call else {
            return Ok(false);
        };
        let Some(called) = words.iter().find(|word| word.letter == b'P') else {
            return Ok(false);
        };
        let refused = |kind, reason: &str, remedy: &str| {
            let block = Block::understood(program, index);
            Err(block.refuse(kind, Some(call), reason, remedy))
        };
        let number = called.value as u32;
        if !self.options.of_fanuc_run || f64::from(number) != called.value {
            let what = match call.letter {
                b'M' => "M98",
                _ => "the macro call G65",
            };
            return refused(ProgramErrorKind::Subprogram, &of_subprogram(what), FLATTEN);
        }
        if self.options.moving_calls.contains(&number) {
            return refused(
                ProgramErrorKind::UnknownCode,
                &format!(
                    "O{number} moves the tool, as is stated, and none of the files says where to"
                ),
                "give its file as well, or divide the program at the call",
            );
        }
        let line = program.number_of(index);
        self.outside_calls.entry(number).or_insert(line);
        self.repeated.note(line, &format!("O{number} is in none of the files: it is taken not to move the tool and not to change speed, tool or frame; state it under [calls] if it moves, or give its file"));
        Ok(true)
    }

    /// Names the subprograms that are stated to move the tool, and that nothing calls.
    pub(super) fn warn_of_calls_without_effect(&mut self) {
        for number in self.options.moving_calls.clone() {
            self.warn(1, &format!("O{number}, of which is stated that it moves the tool, is called nowhere, or its file is given: that changes nothing"));
        }
    }
}
