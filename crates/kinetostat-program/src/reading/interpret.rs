//! Where the tool goes: the second stage of reading.

use nalgebra::Vector3;

use crate::error::{ProgramError, ProgramErrorKind};
use crate::path::curve::Curve;
use crate::path::moves::{
    Change, CoordinateWords, Event, ExtraMode, Knowledge, Motion, Move, MoveKind, Path, Warning,
};
use crate::path::pause::Pause;
use crate::path::position_offset::{OffsetChange, PositionOffset};
use crate::reading::arc::{self, ArcFrame};
use crate::reading::beside::{
    OTHER_AXES, check_codes_beside_motion, refuse_dwell_with_motion, refuse_other_axes,
    refuse_parameters_of_calls,
};
use crate::reading::block::Block;
use crate::reading::extra::{ExtraAxes, RotaryOrigins};
use crate::reading::machine::{MachinePlace, machine_place};
use crate::reading::modes::Modes;
use crate::reading::options::{BlockDelete, OtherAxes, ReadOptions, ToolCentrePoint, Units};
use crate::reading::pause::pause;
use crate::reading::places::{Cause, Places};
use crate::reading::repeated::Repeated;
use crate::reading::rotary::RotaryWords;
use crate::reading::settings::{Setting, other_axes, setting};
use crate::reading::shifts::Shifts;
use crate::reading::spindle::SpindleWords;
use crate::reading::tools::ToolWords;
use crate::text::line::LineKind;
use crate::text::program::Program;

/// Coordinates beyond this are no machine's, in mm.
const LARGEST_COORDINATE_MM: f64 = 1e6;

const COORDINATES: [u8; 3] = *b"XYZ";

/// Interprets the motions of a program.
///
/// Modal state before the first word that sets it: absolute coordinates (G90), incremental arc
/// centres (G91.1), plane XY (G17), feed per minute (G94), the first work coordinate system (G54), no
/// motion word. Units must be named. Once M82 or M83 was met they alone decide about E words, before
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

/// What is known while a program is read line by line.
pub(crate) struct Interpreter<'o> {
    pub(super) options: &'o ReadOptions,
    rotary: RotaryWords<'o>,
    pub(crate) modes: Modes,
    pub(super) offset: PositionOffset,
    pub(super) shifts: Shifts,
    /// Origins of the work coordinate systems, mm, part frame; none where they are not stated.
    pub(super) origins_mm: [Option<Vector3<f64>>; 9],
    rotary_origins: RotaryOrigins,
    pub(crate) places: Places,
    pub(super) ended: Option<usize>,
    no_feed_warned: bool,
    repeated: Repeated,
    /// Work coordinate system of the first motion.
    first_system: Option<usize>,
    moves: Vec<Move>,
    /// For each move: which axes are known before and after it, and whether one was known before and is so no
    /// more.
    knowledge: Vec<([bool; 3], [bool; 3], bool)>,
    events: Vec<Event>,
    pauses: Vec<Pause>,
    tools: ToolWords,
    pub(super) spindle: SpindleWords,
    warnings: Vec<Warning>,
}

impl<'o> Interpreter<'o> {
    pub(crate) fn new(options: &'o ReadOptions) -> Self {
        Self {
            options,
            rotary: RotaryWords::new(options),
            modes: {
                let mut modes = Modes::new(options.units);
                modes.tool_centre_point = options.tool_centre_point == ToolCentrePoint::Throughout;
                modes
            },
            offset: PositionOffset::default(),
            shifts: Shifts::default(),
            origins_mm: options.work_offsets_mm,
            rotary_origins: RotaryOrigins::default(),
            places: Places::new(options.start_position_mm),
            ended: None,
            no_feed_warned: false,
            repeated: Repeated::default(),
            first_system: None,
            moves: Vec::new(),
            knowledge: Vec::new(),
            events: Vec::new(),
            pauses: Vec::new(),
            tools: ToolWords::default(),
            spindle: SpindleWords::default(),
            warnings: Vec::new(),
        }
    }

    /// An interpreter of other blocks from where this one is, in its modes; it has no moves yet.
    pub(crate) fn following(&self) -> Self {
        Self {
            modes: self.modes.clone(),
            offset: self.offset,
            shifts: self.shifts,
            origins_mm: self.origins_mm,
            rotary_origins: self.rotary_origins,
            places: self.places.clone(),
            ended: self.ended,
            first_system: self.first_system,
            spindle: self.spindle.following(),
            ..Self::new(self.options)
        }
    }

    /// The last motion that was read.
    pub(crate) fn last_move(&self) -> Option<&Move> {
        self.moves.last()
    }

    fn warn(&mut self, line: usize, text: &str) {
        self.warnings.push(Warning {
            line,
            text: text.to_owned(),
        });
    }

    fn warn_block_delete(&mut self, line: usize) {
        self.repeated.note(line, "blocks marked with / are taken as run; the output is right only with the machine's block delete switch off (--block-delete skip leaves them out)");
    }

    /// Two work coordinate systems in one program are at different places, or one would do; with no
    /// offset for either, the places are not known.
    fn warn_of_systems_without_offsets(&mut self, line: usize) {
        let now = self.modes.work_offset;
        let first = *self.first_system.get_or_insert(now);
        let offsets = &self.origins_mm;
        let origin = |system: usize| offsets[system].unwrap_or_default();
        if offsets[now].is_none() && offsets.iter().any(Option::is_some) {
            self.repeated.note(line, "the origin of this work coordinate system is not stated, that of another is: it is taken to be the part's; state it (--work-offset, or work_offset_mm under [reading] in the job file), or these blocks are corrected for the wrong place");
        } else if now != first
            && origin(now) == origin(first)
            && self.rotary_origins[now] == self.rotary_origins[first]
        {
            self.repeated.note(line, "a second work coordinate system is used, but both have the same origin here: state where they are in the part (--work-offset, or work_offset_mm under [reading] in the job file), or these blocks are corrected for the wrong place");
        }
    }

    pub(crate) fn run_line(&mut self, program: &Program, index: usize) -> Result<(), ProgramError> {
        let line = &program.lines()[index];
        let skipped = line.block_delete && self.options.block_delete == BlockDelete::Skip;
        if line.kind == LineKind::AfterEnd {
            self.warn_of_text_after_end(program, index);
        }
        if line.kind == LineKind::AfterEnd || program.words(line).is_empty() || skipped {
            return Ok(());
        }
        let block = Block::of(program, index)?;
        if line.block_delete {
            self.warn_block_delete(block.line_number);
        }
        self.run(&block)
    }

    fn warn_of_text_after_end(&mut self, program: &Program, index: usize) {
        let text = program.bytes()[program.content(&program.lines()[index])].trim_ascii_start();
        let comment = text.starts_with(b"(") || text.starts_with(b";");
        if !comment && text.iter().any(u8::is_ascii_alphanumeric) {
            self.repeated.note(index + 1, "text follows the closing tape mark %: it is carried unchanged, and is taken to be for people");
        }
    }

    fn run(&mut self, block: &Block<'_>) -> Result<(), ProgramError> {
        if block.is_vendor() {
            self.modes.extra.set_extruder_mode(block.codes.extruder);
            return Ok(());
        }
        refuse_dwell_with_motion(block)?;
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
        if self.modes.overrides_options(block) {
            self.warn(block.line_number, "the program names its units before it moves: they hold, and not those given (--units, or units under [reading] in the job file)");
        }
        self.modes.set(block)?;
        self.modes
            .extra
            .count_from(self.rotary_origins[self.modes.work_offset]);
        self.rotary.set_tool_centre_point(block, &mut self.modes)?;
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
        } else if block.codes.position_offset.is_some() {
            self.set_position_offset(block, has_axis_words)?;
        } else if has_axis_words || self.is_centre_only(block) {
            refuse_parameters_of_calls(block, self.modes.motion)?;
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

    /// `G2 I5` is a full circle without an axis word.
    fn is_centre_only(&self, block: &Block<'_>) -> bool {
        matches!(
            self.modes.motion,
            Some(Motion::Clockwise | Motion::CounterClockwise)
        ) && b"IJKR".iter().any(|letter| block.value(*letter).is_some())
    }

    fn note_no_motion(&mut self, block: &Block<'_>) {
        let line = block.line_number;
        // A feed mode that is named again leaves the F in force, which in the output is that of the
        // last piece and not the programmed one.
        let lost = block.codes.feed_mode.is_some() && self.modes.feed.is_none();
        if block.value(b'F').is_some() || lost {
            self.events.push(Event {
                line,
                change: Change::Feed(self.modes.feed),
            });
        }
        if let Some(motion) = block.codes.motion {
            self.events.push(Event {
                line,
                change: Change::Motion(motion),
            });
        }
    }

    pub(super) fn work_offset_mm(&self) -> Vector3<f64> {
        self.origins_mm[self.modes.work_offset].unwrap_or_default()
    }

    /// G10: the tool stands still; where it is in the part stays known.
    fn set_offsets(&mut self, block: &Block<'_>) -> Result<(), ProgramError> {
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
        self.modes.extra.count_from(self.rotary_origins[now]);
    }

    fn set_position_offset(
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
    fn refuse_shifted(&self, block: &Block<'_>) -> Result<(), ProgramError> {
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

    /// The way of a move: a line, or an arc from a place that the program has stated.
    fn curve_of_move(
        &self,
        block: &Block<'_>,
        (motion, mm_per_unit): (Motion, f64),
        (start, end): (Vector3<f64>, Vector3<f64>),
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
                Ok(Curve::Arc(arc::read(
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
                )?))
            }
            _ => Ok(Curve::Line),
        }
    }

    fn read_move(&mut self, block: &Block<'_>) -> Result<(), ProgramError> {
        let motion = match self.modes.motion {
            Some(Motion::Off) | None => {
                return Err(block.refuse(
                    ProgramErrorKind::Ambiguous, None,
                    "axis words without a motion word before them: what they do depends on the machine",
                    "write G0, G1, G2 or G3 before the first motion (and after G80)",
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

        if kind == MoveKind::Feed {
            self.refuse_cut_from_lost_place(block)?;
        }
        self.modes.use_units();
        let start = self.places.position;
        let known_before = self.places.known;
        let end = self.end_of_move(block, kind, mm_per_unit)?;
        let ends = (start, end);
        let curve = self.curve_of_move(block, (motion, mm_per_unit), ends, known_before)?;
        self.places.position = end;
        let angles = self.rotary.angles(&self.modes);
        let extra = self.modes.extra.read(block, self.modes.incremental);
        let tool_turn =
            self.rotary
                .turn_of_move(block, kind, (&angles, &self.modes), &mut self.places)?;
        let lost = self.places.first_lost();
        if let Some((axis, ..)) = lost {
            self.repeated.note(block.line_number, &format!(
                "where the tool is along {} is not known here (a tool length, G28, G30, G53 or a rotary axis changed it): the block is carried without a correction, as all are until the program states the axis again",
                char::from(COORDINATES[axis])
            ));
        }
        // Where the slides go while a rotary axis turns is no way of the tip.
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
            words: CoordinateWords {
                mm_per_unit,
                incremental: self.modes.incremental,
                absolute_centre: self.modes.absolute_centre,
                work_offset_mm: self.work_offset_mm(),
                to_machine: [false; 3],
            },
        };
        self.rotary.refuse_turn_per_revolution(block, &motion)?;
        self.moves.push(motion);
        Ok(())
    }

    /// G43, G49 and their like: the tool stays, and its point is at a coordinate that is not in the program.
    fn change_tool_length(&mut self, block: &Block<'_>) -> Result<(), ProgramError> {
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
    fn go_to_machine_place(&mut self, block: &Block<'_>, place: &MachinePlace) {
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
            words: CoordinateWords {
                mm_per_unit: self.modes.units().map_or(1.0, Units::mm_per_unit),
                incremental: self.modes.incremental,
                absolute_centre: self.modes.absolute_centre,
                work_offset_mm: self.work_offset_mm(),
                to_machine: place.axes,
            },
        });
    }

    /// What is cut from an unknown place is cut somewhere else than the program says.
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

    /// The user said that these axes stand still; the program may say otherwise.
    fn warn_of_moved_axes(&mut self) {
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
                self.warn(line, &format!("axis {letter} moves {from} though it is said to stand still: from here on the corrections are right only if that does not change where the tool is in the part"));
            } else if let Some((line, _)) = words().next() {
                self.warn(
                    line,
                    &format!("axis {letter} is carried along and taken to stand still"),
                );
            }
        }
    }

    pub(crate) fn finish(mut self, program: &Program) -> Result<Path, ProgramError> {
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
                let block = Block::of(program, motion.line - 1)?;
                return Err(block.refuse(
                    ProgramErrorKind::Ambiguous, None,
                    "the arc is made before the program has stated all axes it moves later",
                    "state X, Y and Z before the first arc, or give the start position (--start-position-mm, or start_position_mm under [reading] in the job file)",
                ));
            }
        }
        let mut before_the_first =
            self.moves
                .iter()
                .zip(&self.knowledge)
                .filter(|(motion, (.., lost))| {
                    motion.known == Knowledge::Nothing && !motion.words.is_to_machine() && !lost
                });
        if let Some(first) = before_the_first.next().map(|(motion, _)| motion.line) {
            let unknown = 1 + before_the_first.count();
            let (blocks, carried) = match unknown {
                1 => ("1 block moves".to_owned(), "it is"),
                _ => (format!("{unknown} blocks move"), "they are"),
            };
            self.warn(first, &format!("{blocks} before the program has stated where the tool is; {carried} carried unchanged (a start position changes this: --start-position-mm, or start_position_mm under [reading] in the job file)"));
        }
        self.warn_of_moved_axes();
        self.warnings.extend(self.repeated.finish());
        let mut path = Path {
            // Where all rotary axes stand at zero the spindle is along z of the part.
            tool_axis: match &self.options.rotary {
                Some(rotary) => rotary.tool_at_zero.inverse() * Vector3::z(),
                None => Vector3::z(),
            },
            moves: self.moves,
            stated,
            warnings: self.warnings,
            tool_changes: Vec::new(),
            spindle_changes: self.spindle.finish(),
            pauses: self.pauses,
            events: self.events,
        };
        self.tools.finish(&mut path, program, self.options)?;
        path.warnings.sort_by_key(|warning| warning.line);
        Ok(path)
    }
}
