//! Canned cycles that stay as they are written: rigid taps, and borings whose way is the controller's own.
//!
//! The expansion for Fanuc writes each hole as `G99 G84 Z-3. R1.` (back boring as `G98 G87`), without a place in the plane: the
//! tool is over the hole, and ends at the level R, which G98 does not leave for a cycle that begins there.

use crate::error::{ProgramError, ProgramErrorKind};
use crate::path::curve::Curve;
use crate::path::moves::{Knowledge, Motion, Move, MoveKind};
use crate::reading::block::Block;
use crate::reading::dialect::{Treatment, lookup};
use crate::reading::interpreting::interpreter::Interpreter;

/// G87: the tool ends where it began.
const BACK_BORING: u32 = 870;

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
        self.repeated.note(block.line_number, &format!(
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
