//! Where the tool goes: the second stage of reading.

use nalgebra::Vector3;

use crate::arc::{self, ArcFrame};
use crate::block::Block;
use crate::curve::Curve;
use crate::error::ProgramError;
use crate::extra::ExtraAxes;
use crate::options::{BlockDelete, ReadOptions, Units};
use crate::path::{
    Change, CoordinateWords, Event, Feed, FeedMode, Knowledge, Motion, Move, MoveKind,
    OffsetChange, Path, PositionOffset, Warning,
};
use crate::program::{LineKind, Program};

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
        let line = &program.lines()[index];
        let skipped = line.block_delete && options.block_delete == BlockDelete::Skip;
        if line.kind == LineKind::AfterEnd || program.words(line).is_empty() || skipped {
            continue;
        }
        let block = Block::of(program, index)?;
        if line.block_delete {
            interpreter.warn_block_delete(block.line_number);
        }
        interpreter.run(&block)?;
    }
    interpreter.finish(program)
}

struct Interpreter<'o> {
    options: &'o ReadOptions,
    units: Option<Units>,
    motion: Option<Motion>,
    incremental: bool,
    absolute_centre: bool,
    /// Axes of the plane and its normal.
    plane: [usize; 3],
    feed_mode: FeedMode,
    feed: Option<Feed>,
    /// The units changed after the F in force was given.
    feed_is_stale: bool,
    work_offset: usize,
    offset: PositionOffset,
    position: Vector3<f64>,
    known: [bool; 3],
    extra: ExtraAxes,
    /// Line of a change of the tool length that no Z word has followed yet.
    length_change: Option<usize>,
    tool_length_on: bool,
    ended: Option<usize>,
    no_feed_warned: bool,
    block_delete_warned: bool,
    moves: Vec<Move>,
    /// For each move: which axes are known before and after it.
    knowledge: Vec<([bool; 3], [bool; 3])>,
    events: Vec<Event>,
    warnings: Vec<Warning>,
}

impl<'o> Interpreter<'o> {
    fn new(options: &'o ReadOptions) -> Self {
        Self {
            options,
            units: options.units,
            motion: None,
            incremental: false,
            absolute_centre: false,
            plane: [0, 1, 2],
            feed_mode: FeedMode::PerMinute,
            feed: None,
            feed_is_stale: false,
            work_offset: 0,
            offset: PositionOffset::default(),
            position: options.start_position_mm.unwrap_or_default(),
            known: [options.start_position_mm.is_some(); 3],
            extra: ExtraAxes::default(),
            length_change: None,
            tool_length_on: false,
            ended: None,
            no_feed_warned: false,
            block_delete_warned: false,
            moves: Vec::new(),
            knowledge: Vec::new(),
            events: Vec::new(),
            warnings: Vec::new(),
        }
    }

    fn warn(&mut self, line: usize, text: &str) {
        self.warnings.push(Warning {
            line,
            text: text.to_owned(),
        });
    }

    fn warn_block_delete(&mut self, line: usize) {
        if !self.block_delete_warned {
            self.block_delete_warned = true;
            self.warn(line, "blocks marked with / are taken as run; the output is right only with the machine's block delete switch off");
        }
    }

    fn run(&mut self, block: &Block<'_>) -> Result<(), ProgramError> {
        if block.is_vendor() {
            self.extra.set_extruder_mode(block.codes.extruder);
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
                None,
                &format!("the block follows the program's end on line {end}: some controllers run on, some stop"),
                "remove the blocks after M2 or M30, or the M2 or M30 before them",
            ));
        }
        self.set_modes(block)?;
        let explicit = block.codes.motion;
        if let Some(motion) = explicit {
            self.motion = Some(motion);
        }
        if block.codes.position_offset.is_some() {
            self.set_position_offset(block, has_axis_words)?;
        } else if has_axis_words || self.is_centre_only(block) {
            self.refuse_parameters_of_calls(block)?;
            self.read_move(block)?;
        } else {
            self.note_no_motion(block, explicit);
        }
        if block.codes.ends {
            self.ended.get_or_insert(block.line_number);
        }
        Ok(())
    }

    /// `G2 I5` is a full circle without an axis word.
    fn is_centre_only(&self, block: &Block<'_>) -> bool {
        matches!(
            self.motion,
            Some(Motion::Clockwise | Motion::CounterClockwise)
        ) && b"IJKR".iter().any(|letter| block.value(*letter).is_some())
    }

    fn note_no_motion(&mut self, block: &Block<'_>, explicit: Option<Motion>) {
        let line = block.line_number;
        // A feed mode that is named again leaves the F in force, which in the output is that of the
        // last piece and not the programmed one.
        let lost = block.codes.feed_mode.is_some() && self.feed.is_none();
        if block.value(b'F').is_some() || lost {
            self.events.push(Event {
                line,
                change: Change::Feed(self.feed),
            });
        }
        if let Some(motion) = explicit {
            self.events.push(Event {
                line,
                change: Change::Motion(motion),
            });
        }
    }

    fn set_modes(&mut self, block: &Block<'_>) -> Result<(), ProgramError> {
        let codes = &block.codes;
        if let Some(code) = codes.feed_mode {
            let mode = match code {
                930 => FeedMode::InverseTime,
                940 => FeedMode::PerMinute,
                _ => FeedMode::PerRevolution,
            };
            if mode != self.feed_mode {
                // An F of another mode is another quantity: controllers want a new one.
                self.feed = None;
            }
            self.feed_mode = mode;
        }
        if let Some(code) = codes.units {
            let units = if code == 200 {
                Units::Inches
            } else {
                Units::Millimetres
            };
            if let Some(before) = self.units
                && before != units
            {
                self.feed_is_stale = self.feed.is_some();
                self.extra
                    .change_units(before.mm_per_unit() / units.mm_per_unit());
            }
            self.units = Some(units);
        }
        if let Some(value) = block.value(b'F') {
            self.set_feed(block, value)?;
        }
        match codes.plane {
            Some(170) => self.plane = [0, 1, 2],
            Some(180) => self.plane = [2, 0, 1],
            Some(_) => self.plane = [1, 2, 0],
            None => {}
        }
        if let Some(code) = codes.distance {
            self.incremental = code == 910;
            self.extra.set_distance_mode(self.incremental);
        }
        self.extra.set_extruder_mode(codes.extruder);
        if let Some(code) = codes.arc_distance {
            self.absolute_centre = code == 901;
        }
        if let Some(code) = codes.work_offset {
            self.work_offset = match code {
                540..=590 if code % 10 == 0 => (code as usize - 540) / 10,
                591..=593 => code as usize - 591 + 6,
                _ => {
                    return Err(block.refuse(
                        None,
                        "an extended work coordinate system is not known here",
                        "use G54 to G59.3",
                    ));
                }
            };
            if block.value(b'P').is_some() {
                return Err(block.refuse(
                    block.word(b'P'),
                    "an extended work coordinate system is not known here",
                    "use G54 to G59.3",
                ));
            }
        }
        match codes.tool_length {
            Some(430) => {
                self.tool_length_on = true;
                self.length_change = Some(block.line_number);
            }
            // Cancelling what was never set is a habit of the first block and changes nothing.
            Some(_) if self.tool_length_on => {
                self.tool_length_on = false;
                self.length_change = Some(block.line_number);
            }
            _ => {}
        }
        Ok(())
    }

    fn set_feed(&mut self, block: &Block<'_>, value: f64) -> Result<(), ProgramError> {
        if value <= 0.0 {
            return Err(block.refuse(
                block.word(b'F'),
                &format!("a feed of {value} is no feed"),
                "write a feed above zero",
            ));
        }
        let scale = match self.feed_mode {
            FeedMode::InverseTime => 1.0,
            // A program may name F before its units; where none are named the first move is refused.
            _ => self.units.map_or(1.0, Units::mm_per_unit),
        };
        self.feed_is_stale = self.feed_mode != FeedMode::InverseTime && self.units.is_none();
        self.feed = Some(Feed {
            mode: self.feed_mode,
            value: value * scale,
        });
        Ok(())
    }

    fn mm_per_unit(&self, block: &Block<'_>) -> Result<f64, ProgramError> {
        self.units.map(Units::mm_per_unit).ok_or_else(|| {
            block.refuse(
                None,
                "the program moves before it names its units",
                "begin it with G21 (mm) or G20 (inch), or give the units by option",
            )
        })
    }

    fn work_offset_mm(&self) -> Vector3<f64> {
        self.options.work_offsets_mm[self.work_offset]
    }

    fn set_position_offset(
        &mut self,
        block: &Block<'_>,
        has_axis_words: bool,
    ) -> Result<(), ProgramError> {
        if block.codes.motion.is_some() {
            return Err(block.refuse(
                None,
                "G92 and a motion word stand in one block",
                "write them in two blocks",
            ));
        }
        let change = match block.codes.position_offset {
            Some(920) => {
                if !has_axis_words {
                    return Err(block.refuse(
                        None,
                        "G92 without an axis is an error to some controllers and means all axes to others",
                        "write each axis with its coordinate",
                    ));
                }
                self.here(block)?
            }
            _ if has_axis_words => {
                return Err(block.refuse(
                    None,
                    "an axis word stands in a block that clears, suspends or resumes G92",
                    "write the motion as a block of its own",
                ));
            }
            Some(921) => OffsetChange::Clear,
            Some(922) => OffsetChange::Suspend,
            _ => OffsetChange::Resume,
        };
        self.offset.apply(&change, &self.position);
        self.note_no_motion(block, None);
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
            let value_mm = value * self.mm_per_unit(block)?;
            coordinates_mm[axis] = Some(value_mm);
            if !self.known[axis] {
                // The user tells where the tool stands: the coordinate is its place in the part.
                establishes[axis] = true;
                self.known[axis] = true;
                self.position[axis] = value_mm + work_offset_mm[axis];
            }
        }
        self.extra.set_here(block);
        Ok(OffsetChange::Here {
            coordinates_mm,
            work_offset_mm,
            establishes,
        })
    }

    /// Words that mean a corner rounding or a call on some controllers.
    fn refuse_parameters_of_calls(&self, block: &Block<'_>) -> Result<(), ProgramError> {
        if block
            .words
            .iter()
            .any(|word| word.letter == b'M' && word.value >= 100.0)
            && block.codes.motion.is_none()
        {
            return Err(block.refuse(
                None,
                "an axis word beside this M code is its parameter to printers and a motion to mills",
                "write the motion as a block of its own, with G0 or G1",
            ));
        }
        if matches!(self.motion, Some(Motion::Rapid | Motion::Feed)) {
            for letter in *b"IJKRP" {
                if let Some(word) = block.word(letter).filter(|_| block.value(letter).is_some()) {
                    return Err(block.refuse(
                        Some(word),
                        &format!(
                            "{} stands in a straight move: some controllers stop, some round a corner",
                            char::from(letter)
                        ),
                        "remove the word, or write the arc with G2 or G3",
                    ));
                }
            }
        }
        Ok(())
    }

    fn read_move(&mut self, block: &Block<'_>) -> Result<(), ProgramError> {
        let motion = match self.motion {
            Some(Motion::Off) | None => {
                return Err(block.refuse(
                    None,
                    "axis words without a motion word before them: what they do depends on the machine",
                    "write G0, G1, G2 or G3 before the first motion (and after G80)",
                ));
            }
            Some(motion) => motion,
        };
        let mm_per_unit = self.mm_per_unit(block)?;
        let kind = if motion == Motion::Rapid {
            MoveKind::Rapid
        } else {
            MoveKind::Feed
        };
        self.check_feed(block, kind)?;

        let start = self.position;
        let known_before = self.known;
        let end = self.end_of_move(block, kind, mm_per_unit)?;
        self.check_tool_length(block, motion)?;
        let curve = match motion {
            Motion::Clockwise | Motion::CounterClockwise => {
                if let Some(axis) = (0..3).find(|axis| {
                    !known_before[*axis] && (self.known[*axis] || self.plane[..2].contains(axis))
                }) {
                    return Err(block.refuse(
                        None,
                        &format!(
                            "the arc starts at a place whose {} the program has not stated",
                            char::from(COORDINATES[axis])
                        ),
                        "move there with G0 first, or give the start position by option",
                    ));
                }
                Curve::Arc(arc::read(
                    block,
                    &ArcFrame {
                        start,
                        end,
                        axes: self.plane,
                        clockwise: motion == Motion::Clockwise,
                        absolute_centre: self.absolute_centre,
                        mm_per_unit,
                        offset_mm: self.work_offset_mm() + self.offset.active_mm,
                        tolerance_mm: self.options.arc_tolerance_mm,
                    },
                )?)
            }
            _ => Curve::Line,
        };
        self.position = end;
        let extra = self.extra.read(block, self.incremental);
        self.knowledge.push((known_before, self.known));
        self.moves.push(Move {
            line: block.line_number,
            kind,
            curve,
            start,
            end,
            extra,
            feed: self.feed,
            known: Knowledge::Whole,
            words: CoordinateWords {
                mm_per_unit,
                incremental: self.incremental,
                work_offset_mm: self.work_offset_mm(),
            },
        });
        Ok(())
    }

    fn check_feed(&mut self, block: &Block<'_>, kind: MoveKind) -> Result<(), ProgramError> {
        if kind == MoveKind::Rapid {
            return Ok(());
        }
        if self.feed_mode == FeedMode::InverseTime && block.value(b'F').is_none() {
            return Err(block.refuse(
                None,
                "with G93 (inverse time) every feed block needs its own F",
                "write F into the block",
            ));
        }
        if self.feed_is_stale {
            return Err(block.refuse(
                None,
                "the units were named after the F in force: its value is read differently by controllers",
                "write F again after G20 or G21",
            ));
        }
        if self.feed.is_none() && !self.no_feed_warned {
            self.no_feed_warned = true;
            self.warn(block.line_number, "the program feeds before it has given an F: the speed is the machine's, and no F is written until the program gives one");
        }
        Ok(())
    }

    fn end_of_move(
        &mut self,
        block: &Block<'_>,
        kind: MoveKind,
        mm_per_unit: f64,
    ) -> Result<Vector3<f64>, ProgramError> {
        let mut end = self.position;
        let offset = self.work_offset_mm() + self.offset.active_mm;
        for axis in 0..3 {
            let letter = COORDINATES[axis];
            let Some(value) = block.value(letter) else {
                continue;
            };
            let value_mm = value * mm_per_unit;
            if self.incremental {
                if !self.known[axis] && kind == MoveKind::Feed {
                    return Err(block.refuse(
                        block.word(letter),
                        &format!(
                            "an incremental feed from a place whose {} the program has not stated",
                            char::from(letter)
                        ),
                        "state the place with an absolute move or G92, or give the start position by option",
                    ));
                }
                end[axis] += value_mm;
            } else {
                end[axis] = value_mm + offset[axis];
                self.known[axis] = true;
            }
            if end[axis].abs() > LARGEST_COORDINATE_MM {
                return Err(block.refuse(
                    block.word(letter),
                    &format!("{} would be at {:.0} mm", char::from(letter), end[axis]),
                    "check the number and the units",
                ));
            }
        }
        Ok(end)
    }

    /// After G43 and G49 the tool point is at another Z than before, unknown until a Z word.
    fn check_tool_length(&mut self, block: &Block<'_>, motion: Motion) -> Result<(), ProgramError> {
        let Some(line) = self.length_change else {
            return Ok(());
        };
        if motion == Motion::Rapid && !self.incremental && block.value(b'Z').is_some() {
            self.length_change = None;
            return Ok(());
        }
        Err(block.refuse(
            None,
            &format!("line {line} changed the tool length, so the height of the tool point is unknown here"),
            "follow G43 and G49 by a rapid (G0) with an absolute Z word, in the same or the next motion block",
        ))
    }

    /// A turned part or head changes where the tool stands in the part, and this reader cannot tell how.
    fn warn_of_carried_axes(&mut self) {
        for letter in "ABCUVW".chars() {
            let moved = |motion: &&Move| motion.extra.iter().any(|extra| extra.letter == letter);
            if let Some(line) = self.moves.iter().find(moved).map(|motion| motion.line) {
                self.warn(line, &format!("axis {letter} is carried along; what it does to the place of the tool in the part is not accounted for"));
            }
        }
    }

    fn finish(mut self, program: &Program) -> Result<Path, ProgramError> {
        let stated = self.known;
        let covers = |known: &[bool; 3]| (0..3).all(|axis| known[axis] || !stated[axis]);
        for (motion, (before, after)) in self.moves.iter_mut().zip(&self.knowledge) {
            motion.known = match (covers(before), covers(after)) {
                (true, _) => Knowledge::Whole,
                (false, true) => Knowledge::End,
                (false, false) => Knowledge::Nothing,
            };
            if motion.known != Knowledge::Whole && motion.curve != Curve::Line {
                let block = Block::of(program, motion.line - 1)?;
                return Err(block.refuse(
                    None,
                    "the arc is made before the program has stated all axes it moves later",
                    "state X, Y and Z before the first arc, or give the start position by option",
                ));
            }
        }
        let unknown = self
            .moves
            .iter()
            .filter(|motion| motion.known == Knowledge::Nothing)
            .count();
        if let Some(first) = self
            .moves
            .first()
            .filter(|_| unknown > 0)
            .map(|motion| motion.line)
        {
            self.warn(first, &format!("{unknown} block(s) move before the program has stated where the tool is; they are carried unchanged (a start position given by option changes this)"));
        }
        self.warn_of_carried_axes();
        self.warnings.sort_by_key(|warning| warning.line);
        Ok(Path {
            moves: self.moves,
            stated,
            warnings: self.warnings,
            events: self.events,
        })
    }
}

/// `G4 X2` dwells two seconds on some controllers; with P or a motion word beside it nobody can tell.
fn refuse_dwell_with_motion(block: &Block<'_>) -> Result<(), ProgramError> {
    let axis = |word: &&crate::program::Word| {
        COORDINATES.contains(&word.letter) || ExtraAxes::LETTERS.contains(&word.letter)
    };
    let time_elsewhere = block
        .words
        .iter()
        .any(|word| matches!(word.letter, b'P' | b'S'));
    let axes = block.words.iter().filter(axis).count();
    if block.codes.dwell && (block.codes.motion.is_some() || axes > usize::from(!time_elsewhere)) {
        return Err(block.refuse(
            None,
            "a dwell and a motion stand in one block: the axis words may belong to either",
            "write them in two blocks",
        ));
    }
    Ok(())
}
