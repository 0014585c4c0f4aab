//! G0 to G3: where a block goes, and on which way; and places that are the machine's (tool lengths, G28, G30, G53).

use nalgebra::Vector3;

use crate::error::{ProgramError, ProgramErrorKind};
use crate::path::curve::Curve;
use crate::path::moves::{Knowledge, Motion, Move, MoveKind};
use crate::reading::arc::{self, ArcFrame};
use crate::reading::beside::{COORDINATES, check_codes_beside_motion};
use crate::reading::block::Block;
use crate::reading::directions::with_circle;
use crate::reading::interpreting::Interpreter;
use crate::reading::machine::MachinePlace;
use crate::reading::options::Units;
use crate::reading::places::Cause;

/// Coordinates beyond this are no machine's, in mm.
const LARGEST_COORDINATE_MM: f64 = 1e6;

impl Interpreter<'_> {
    pub(super) fn read_move(&mut self, block: &Block<'_>) -> Result<(), ProgramError> {
        let motion = match self.modes.motion {
            Some(Motion::Off) | None => {
                return Err(block.refuse(
                    ProgramErrorKind::Ambiguous, None,
                    "axis words without a motion word before them: what they do depends on the machine",
                    "write G0, G1, G2 or G3 before the first motion and after G80 (behind G80 the one before it holds on Fanuc and Haas: --expand with --dialect fanuc)",
                ));
            }
            Some(motion) => motion,
        };
        self.warn_of_systems_without_offsets(block.line_number);
        self.refuse_shifted(block)?;
        let mm_per_unit = self.modes.mm_per_unit(block)?;
        let kind = if motion == Motion::Rapid {
            MoveKind::Rapid
        } else {
            MoveKind::Feed
        };
        check_codes_beside_motion(block, kind, self.options, &mut self.repeated)?;
        self.modes.check_feed(block, kind)?;
        if kind == MoveKind::Feed && self.modes.feed.is_none() && !self.no_feed_warned {
            self.no_feed_warned = true;
            self.warn(block.line_number, "the program feeds before it has given an F: the speed is the machine's, and no F is written until the program gives one");
        }

        let lost_before = self.places.first_lost().filter(|_| kind == MoveKind::Feed);
        if lost_before.is_some() && !self.may_feed_from_lost_place(block, motion) {
            self.refuse_cut_from_lost_place(block)?;
        }
        self.modes.use_units();
        let start = self.places.position;
        let known_before = self.places.known;
        let end = self.end_of_move(block, kind, mm_per_unit)?;
        let curve = self.curve_of_move(block, motion, mm_per_unit, start, end, known_before)?;
        self.places.position = end;
        let angles = self.rotary.angles(&self.modes);
        let circle = self
            .rotary
            .take_direction(block, kind, motion, &mut self.modes)?;
        let extra = self.modes.extra.read(block, self.modes.incremental);
        let tool_turn = self
            .rotary
            .turn_of_move(block, kind, &angles, &self.modes, &mut self.places)?
            .map(|turn| with_circle(turn, circle));
        let lost = self.places.first_lost();
        if lost_before.is_some() {
            self.unjudged_feed_on.get_or_insert(block.line_number);
        }
        if let (Some((axis, ..)), None) = (lost_before, lost) {
            self.repeated.note_of_corrections(block.line_number, &format!(
                "where this feed starts along {} is not known (a tool length, G28, G30 or G53 changed it): only its end is corrected, and its way is in no length and no verdict",
                char::from(COORDINATES[axis])
            ));
        }
        if let Some((axis, cause, line)) = lost {
            let text = match cause {
                Cause::Rotary if !self.modes.tool_centre_point => format!(
                    "line {line} turned a rotary axis, and tool centre point control is off: X, Y and Z are places of the machine's slides here. The block is carried without a correction, as all are until a rapid states X, Y and Z under G43.4, or with the axes back at zero"
                ),
                _ => format!(
                    "where the tool is along {} is not known here (a tool length, G28, G30, G53 or a rotary axis changed it): the block is carried without a correction, as all are until the program states the axis again",
                    char::from(COORDINATES[axis])
                ),
            };
            self.repeated.note_of_corrections(block.line_number, &text);
        }
        // The path of the slides while a rotary axis turns is not that of the tip.
        let known_before = match lost {
            Some((_, Cause::Rotary, _)) => [false; 3],
            _ => known_before,
        };
        self.knowledge
            .push((known_before, self.places.known, lost.is_some()));
        let motion = Move {
            line: block.line_number,
            kind,
            curve,
            start,
            end,
            tool_turn,
            extra,
            feed: self.modes.feed,
            known: Knowledge::Whole,
            words: self.coordinate_words(mm_per_unit, [false; 3]),
        };
        self.rotary.refuse_turn_per_revolution(block, &motion)?;
        self.moves.push(motion);
        Ok(())
    }

    /// True for a straight feed that states all lost axes, or leaves them at a place of the machine: it is an approach.
    fn may_feed_from_lost_place(&self, block: &Block<'_>, motion: Motion) -> bool {
        let stated = |axis: usize| block.value(COORDINATES[axis]).is_some();
        motion == Motion::Feed
            && !self.modes.incremental
            && self.places.all_lost().all(|(axis, cause)| match cause {
                Cause::ToolLength => stated(axis),
                Cause::Machine => true,
                Cause::Rotary => false,
            })
    }

    /// Refuses a cut from an unknown place: it lies elsewhere than the program says.
    fn refuse_cut_from_lost_place(&self, block: &Block<'_>) -> Result<(), ProgramError> {
        let Some((axis, cause, _)) = self.places.first_lost() else {
            return Ok(());
        };
        if cause == Cause::Rotary {
            let angles = self.rotary.angles(&self.modes);
            self.rotary
                .refuse_cut_at_angles(block, &self.modes, &angles)?;
        }
        let letter = char::from(COORDINATES[axis]);
        let why = self.places.why_lost(axis).unwrap_or_default();
        let also = match cause {
            Cause::ToolLength | Cause::Rotary => "",
            Cause::Machine => {
                ", or give the machine's zero and its reference points (--machine-zero-mm, --g28-mm, --g30-mm, or machine_zero_mm, g28_mm, g30_mm under [reading] in the job file)"
            }
        };
        Err(block.refuse(
            ProgramErrorKind::Ambiguous,
            None,
            &format!(
                "{why}, so where the tool is along {letter} is not known here, and this block cuts"
            ),
            &format!(
                "state the axis before it, with a rapid (G0) and an absolute {letter} word{also}"
            ),
        ))
    }

    fn end_of_move(
        &mut self,
        block: &Block<'_>,
        kind: MoveKind,
        mm_per_unit: f64,
    ) -> Result<Vector3<f64>, ProgramError> {
        let mut end = self.places.position;
        let offset = self.work_offset_mm() + self.offset.active_mm;
        for axis in 0..3 {
            let letter = COORDINATES[axis];
            let Some(value) = block.value(letter) else {
                continue;
            };
            let value_mm = value * mm_per_unit;
            if self.modes.incremental {
                if !self.places.known[axis] && kind == MoveKind::Feed {
                    return Err(block.refuse(
                        ProgramErrorKind::Ambiguous, block.word(letter),
                        &format!(
                            "an incremental feed from a place whose {} the program has not stated",
                            char::from(letter)
                        ),
                        "state the place with an absolute move or G92, or give the start position (--start-position-mm, or start_position_mm under [reading] in the job file)",
                    ));
                }
                end[axis] += value_mm;
            } else {
                end[axis] = value_mm + offset[axis];
                self.places.state(axis);
            }
            if end[axis].abs() > LARGEST_COORDINATE_MM {
                return Err(block.refuse(
                    ProgramErrorKind::Malformed,
                    block.word(letter),
                    &format!("{} would be at {:.0} mm", char::from(letter), end[axis]),
                    "check the number and the units",
                ));
            }
        }
        Ok(end)
    }

    /// The way of a move: a line, or an arc from a place that the program has stated.
    fn curve_of_move(
        &mut self,
        block: &Block<'_>,
        motion: Motion,
        mm_per_unit: f64,
        start: Vector3<f64>,
        end: Vector3<f64>,
        known_before: [bool; 3],
    ) -> Result<Curve, ProgramError> {
        match motion {
            Motion::Clockwise | Motion::CounterClockwise => {
                if let Some(axis) = (0..3).find(|axis| {
                    !known_before[*axis]
                        && (self.places.known[*axis] || self.modes.plane[..2].contains(axis))
                }) {
                    return Err(block.refuse(
                        ProgramErrorKind::Ambiguous, None,
                        &format!(
                            "the arc starts at a place whose {} the program has not stated",
                            char::from(COORDINATES[axis])
                        ),
                        "move there with G0 first, or give the start position (--start-position-mm, or start_position_mm under [reading] in the job file)",
                    ));
                }
                let (arc, is_doubtful) = arc::read(
                    block,
                    &ArcFrame {
                        start,
                        end,
                        axes: self.modes.plane,
                        clockwise: motion == Motion::Clockwise,
                        absolute_centre: self.modes.absolute_centre,
                        mm_per_unit,
                        offset_mm: self.work_offset_mm() + self.offset.active_mm,
                        tolerance_mm: self.options.arc_tolerance_mm,
                    },
                )?;
                if is_doubtful {
                    self.repeated.note(block.line_number, "the ends of an arc are no further apart than its words are rounded: it is taken for the short arc between them, as LinuxCNC and grbl take it, and not for a full circle, which a control with coarser places may make of it. End a full circle exactly where it starts");
                }
                Ok(Curve::Arc(arc))
            }
            _ => Ok(Curve::Line),
        }
    }
}

/// Places that are the machine's: tool lengths, G28, G30, G53.
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
