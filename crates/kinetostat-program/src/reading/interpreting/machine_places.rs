//! Places that are the machine's: tool lengths, G28, G30, G53.

use crate::error::{ProgramError, ProgramErrorKind};
use crate::path::curve::Curve;
use crate::path::moves::{Knowledge, Move, MoveKind};
use crate::reading::beside::COORDINATES;
use crate::reading::block::Block;
use crate::reading::interpreting::interpreter::Interpreter;
use crate::reading::machine::MachinePlace;
use crate::reading::options::Units;
use crate::reading::places::Cause;

impl Interpreter<'_> {
    /// G43, G49 and their like: the tool stays, and its point is at a coordinate that is not in the program.
    pub(super) fn change_tool_length(&mut self, block: &Block<'_>) -> Result<(), ProgramError> {
        let by_words = matches!(block.codes.tool_length, Some(431 | 432));
        if by_words && (block.codes.motion.is_some() || block.codes.position_offset.is_some()) {
            return Err(block.refuse(
                ProgramErrorKind::Ambiguous,
                None,
                "axis words beside G43.1 or G43.2 are lengths to some controllers and a motion to others",
                "write the motion as a block of its own",
            ));
        }
        let axes = self.modes.set_tool_length(block);
        for axis in (0..3).filter(|axis| axes[*axis]) {
            self.places.lose(axis, Cause::ToolLength, block.line_number);
        }
        Ok(())
    }

    /// G28, G30, G53: one move, to where the axes end; the point on the way there is not looked at.
    pub(super) fn go_to_machine_place(&mut self, block: &Block<'_>, place: &MachinePlace) {
        if COORDINATES
            .iter()
            .any(|letter| block.value(*letter).is_some_and(|value| value != 0.0))
        {
            self.modes.use_units();
        }
        let start = self.places.position;
        let known_before = self.places.known;
        for axis in (0..3).filter(|axis| place.axes[*axis]) {
            self.places.position[axis] = place.places_mm[axis].unwrap_or(0.0);
            match place.places_mm[axis] {
                Some(_) => self.places.state(axis),
                None => self.places.lose(axis, Cause::Machine, block.line_number),
            }
        }
        self.modes.extra.forget(block, place.all);
        self.knowledge
            .push((known_before, self.places.known, false));
        let mm_per_unit = self.modes.units().map_or(1.0, Units::mm_per_unit);
        self.moves.push(Move {
            line: block.line_number,
            kind: MoveKind::Rapid,
            curve: Curve::Line,
            start,
            end: self.places.position,
            tool_turn: None,
            extra: Vec::new(),
            feed: self.modes.feed,
            known: Knowledge::Nothing,
            words: self.coordinate_words(mm_per_unit, place.axes),
        });
    }
}
