//! The path of a program: what [`crate::interpret`] makes of the words.

use std::collections::BTreeMap;
use std::ops::Range;

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::path::curve::{Curve, NO_LENGTH_MM};
use crate::path::spindle::SpindleChange;
use crate::path::tool_turn::ToolTurn;

/// Rapid traverse or feed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum MoveKind {
    /// G0.
    Rapid,
    /// G1, G2, G3.
    Feed,
}

/// Feed mode, the meaning of the F word.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FeedMode {
    /// G94: length in a minute.
    #[default]
    PerMinute,
    /// G93: blocks in a minute.
    InverseTime,
    /// G95: length in a turn of the spindle.
    PerRevolution,
}

/// A programmed feed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Feed {
    /// Feed mode of the value.
    pub mode: FeedMode,
    /// Value in mm/min, 1/min, or mm per revolution; inches are converted.
    pub value: f64,
}

/// Extent to which a move's place in the part is known from the program and the options.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Knowledge {
    /// The whole move: it is corrected all along.
    Whole,
    /// Only its end (an axis was first stated by this very block): only the end is corrected.
    End,
    /// Not even its end, or it goes to a place of the machine (G28, G30, G53): it is carried without a correction.
    Nothing,
}

/// Distance mode of an extra axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum ExtraMode {
    /// The word is the end.
    Absolute,
    /// The word is the way.
    Incremental,
    /// An E word after M82 or M83 and a later G90 or G91 that says otherwise: firmwares disagree
    /// which of them counts.
    Disputed,
}

/// The motion of one axis other than X, Y, Z in a move.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ExtraAxis {
    /// Letter, one of A B C E U V W.
    pub letter: char,
    /// The number as written: the end or the way, in the block's units.
    pub word: f64,
    /// Start of the axis, in program coordinates and the block's units; `None` if the program has not stated it.
    pub start: Option<f64>,
    /// Distance mode of the word.
    pub mode: ExtraMode,
}

/// One motion of the tool point, in mm, part frame (work offset and G92 included).
#[derive(Debug, Clone, PartialEq)]
pub struct Move {
    /// Line of the block, counted from 1.
    pub line: usize,
    /// Rapid or feed.
    pub kind: MoveKind,
    /// Straight or arc.
    pub curve: Curve,
    /// Start of the move, in mm.
    pub start: Vector3<f64>,
    /// End of the move, in mm.
    pub end: Vector3<f64>,
    /// Orientation of the tool; `None` in a program of positions, where the caller knows it.
    pub tool_turn: Option<Box<ToolTurn>>,
    /// Words of other axes, in the order of the block.
    pub extra: Vec<ExtraAxis>,
    /// The F in force, `None` before the first F word.
    pub feed: Option<Feed>,
    /// Knowledge of start and end.
    pub known: Knowledge,
    /// Form of the block's coordinate words.
    pub words: CoordinateWords,
}

/// Form of a block's coordinate words.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CoordinateWords {
    /// Millimetres in one unit of the words.
    pub mm_per_unit: f64,
    /// G91: words are ways, not places.
    pub incremental: bool,
    /// G90.1: I J K of arcs are places; ways from the start otherwise (G91.1).
    pub absolute_centre: bool,
    /// Origin of the work coordinate system in the part frame, in mm.
    pub work_offset_mm: Vector3<f64>,
    /// X, Y, Z where the block sends them to a place of the machine (G28, G30, G53). Such a block is
    /// carried byte for byte: the place has no correction.
    pub to_machine: [bool; 3],
}

impl CoordinateWords {
    /// True if the block goes to a place in machine coordinates.
    ///
    /// ```
    /// use kinetostat_program::{Program, ReadOptions, interpret};
    ///
    /// let program = Program::read("G21 G90\nG0 X0 Y0 Z5\nG53 G0 Z0\n")?;
    /// let path = interpret(&program, &ReadOptions::default())?;
    /// let machine: Vec<bool> = path.moves.iter().map(|m| m.words.is_to_machine()).collect();
    /// assert_eq!(machine, [false, true]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn is_to_machine(&self) -> bool {
        self.to_machine != [false; 3]
    }
}

impl Move {
    /// Point at a share of the length (0 start, 1 end), in mm.
    pub fn point(&self, share: f64) -> Vector3<f64> {
        self.curve.point(&self.start, &self.end, share)
    }

    /// Direction of motion at a share, a unit vector; `None` for a move without length.
    pub fn tangent(&self, share: f64) -> Option<Vector3<f64>> {
        self.curve.tangent(&self.start, &self.end, share)
    }

    /// True if the move is a feed from a known place: it is corrected all along.
    ///
    /// ```
    /// use kinetostat_program::{Program, ReadOptions, interpret};
    ///
    /// let program = Program::read("G21 G90\nG1 X0 Y0 Z0 F600\nG1 X10\nG0 Z5\n")?;
    /// let path = interpret(&program, &ReadOptions::default())?;
    /// // From where the first one starts is stated nowhere; the last one is a rapid.
    /// let known: Vec<bool> = path.moves.iter().map(|m| m.is_known_feed()).collect();
    /// assert_eq!(known, [false, true, false]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn is_known_feed(&self) -> bool {
        self.kind == MoveKind::Feed && self.known == Knowledge::Whole
    }

    /// Length of the move, in mm.
    pub fn length_mm(&self) -> f64 {
        self.length_between_mm(0.0, 1.0)
    }

    /// Length of the move, in mm; 0 of one from a place that the program does not tell, which has no length that counts.
    ///
    /// ```
    /// # use kinetostat_program::{Program, ReadOptions, interpret};
    /// let program = Program::read("G21 G90\nG1 X0 Y0 Z0 F600\nG1 X10\n")?;
    /// let path = interpret(&program, &ReadOptions::default())?;
    /// let lengths: Vec<f64> = path.moves.iter().map(|m| m.known_length_mm()).collect();
    /// assert_eq!(lengths, [0.0, 10.0]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn known_length_mm(&self) -> f64 {
        match self.known {
            Knowledge::Whole => self.length_mm(),
            _ => 0.0,
        }
    }

    /// True if the move is longer than the rounding of increments and inches between equal places.
    pub fn has_length(&self) -> bool {
        self.length_mm() > NO_LENGTH_MM
    }

    /// Length of the move between two shares, in mm.
    pub fn length_between_mm(&self, from: f64, to: f64) -> f64 {
        self.curve.length_between(&self.start, &self.end, from, to)
    }
}

/// The interpreted program.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Path {
    /// The motions, in the order of the program; at most one a line.
    pub moves: Vec<Move>,
    /// Unit vector from the tool's tip to its holder, in axes of the tool, where moves state the orientation
    /// ([`Move::tool_turn`]).
    pub tool_axis: Vector3<f64>,
    /// True for each of X, Y, Z that is ever stated (or given by the start position). The others are never written.
    pub stated: [bool; 3],
    /// Warnings, with lines.
    pub warnings: Vec<Warning>,
    /// Tool changes, in the order of lines; see [`Path::tool_on`].
    pub tool_changes: Vec<ToolChange>,
    /// Spindle changes, in the order of lines; see [`Path::spindle_on`].
    pub spindle_changes: Vec<SpindleChange>,
    /// Blocks in which the tool stands still, in the order of lines; see [`Path::pauses_between`].
    pub pauses: Vec<Pause>,
    /// Changes between the moves that matter to the writer.
    pub(crate) events: Vec<Event>,
    /// Position in a longer path; `None` for a whole one.
    pub part: Option<PathPart>,
    /// First line with lengths whose unit the program does not state: they are taken for millimetres.
    pub units_assumed_on: Option<usize>,
    /// First line with a feed of which no way is judged, because its start is not known or its way is the controller's own.
    pub unjudged_feed_on: Option<usize>,
    /// Subprograms by number that are in none of the files and are taken not to move the tool, each with the first line that calls it.
    pub outside_calls: BTreeMap<u32, usize>,
}

/// Something the user should know; not an error.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, schemars::JsonSchema)]
pub struct Warning {
    /// Line of the input program, counted from 1.
    pub line: usize,
    /// Text of the warning, with its consequence.
    pub text: String,
    /// Use of the program for which it matters.
    #[serde(skip)]
    pub topic: WarningTopic,
}

/// Use of a program for which a warning matters.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum WarningTopic {
    /// Every use.
    #[default]
    Program,
    /// The program is corrected.
    Corrections,
    /// The program is corrected, and for one tool length and one load.
    OneTool,
}

impl Warning {
    /// A warning for every use of the program.
    #[must_use]
    pub fn new(line: usize, text: impl Into<String>) -> Self {
        Self {
            line,
            text: text.into(),
            topic: WarningTopic::Program,
        }
    }

    /// A warning that matters only where the program is corrected.
    #[must_use]
    pub fn of_corrections(line: usize, text: impl Into<String>) -> Self {
        Self {
            topic: WarningTopic::Corrections,
            ..Self::new(line, text)
        }
    }
}

/// A change on a line.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Event {
    pub line: usize,
    pub change: Change,
}

#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Change {
    /// F or the feed mode changed on a line without motion.
    Feed(Option<Feed>),
    /// A motion word on a line without motion.
    Motion(Motion),
    /// The position offset (G92) changed.
    Offset(OffsetChange),
}

/// The modal motion word.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) enum Motion {
    Rapid,
    Feed,
    Clockwise,
    CounterClockwise,
    Off,
}

impl Path {
    /// Indices of the moves that are its own: all of them, but for a part of a longer path.
    pub fn own_moves(&self) -> Range<usize> {
        match &self.part {
            Some(part) => part.moves.clone(),
            None => 0..self.moves.len(),
        }
    }

    /// Moves of the whole path before the first of these.
    pub(crate) fn moves_before(&self) -> usize {
        self.part.as_ref().map_or(0, |part| part.moves_before)
    }

    /// True if nothing of the program comes before the path's own moves.
    pub fn begins(&self) -> bool {
        self.part.as_ref().is_none_or(|part| part.begins)
    }

    /// Number of the tool that the block on a line is made with, as the program says it: by `T` and `M6`;
    /// without any M6 by `T`; without any T by the `H` of `G43`. `None` before the first of them.
    pub fn tool_on(&self, line: usize) -> Option<u32> {
        let after = self
            .tool_changes
            .partition_point(|change| change.line <= line);
        Some(self.tool_changes.get(after.checked_sub(1)?)?.number)
    }
}

/// A block from which on another tool is used.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
pub struct ToolChange {
    /// Line of the block, counted from 1.
    pub line: usize,
    /// Number of the tool that is used from this block on.
    pub number: u32,
}

/// Position of a path within a longer one.
#[derive(Debug, Clone, PartialEq)]
pub struct PathPart {
    /// Indices of the moves that are its own: the others say how these begin and end (directions, corners, the way on which a
    /// load comes), and belong to the parts beside it.
    pub moves: Range<usize>,
    /// Moves of the whole path before the first of all of these.
    pub moves_before: usize,
    /// Nothing of the program comes before its own moves.
    pub begins: bool,
    /// Length of the path before its own moves, mm, of all moves from known places.
    pub before_mm: f64,
    /// Length of all that the whole program cuts, mm.
    pub whole_feed_mm: f64,
    /// Arcs at feed in the whole program.
    pub whole_feed_arcs: usize,
}

/// A block in which the tool stands still.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Pause {
    /// Line of the block, counted from 1.
    pub line: usize,
    /// Kind of the pause.
    pub kind: PauseKind,
}

/// Kind of a pause.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum PauseKind {
    /// A dwell (G4) with the number of its P: seconds on some controllers, milliseconds on others.
    Dwell(f64),
    /// A dwell with X or U, which are seconds where controllers have them.
    DwellSeconds(f64),
    /// A dwell whose time is not stated, or is stated in turns of the spindle.
    DwellUnknown,
    /// A stop until somebody starts again (M0, M1, M60).
    Stop,
    /// A change of tools (M6).
    ToolChange,
}

impl PauseKind {
    /// Kind in words.
    ///
    /// ```
    /// use kinetostat_program::PauseKind;
    ///
    /// assert_eq!(PauseKind::ToolChange.description(), "a change of tools (M6)");
    /// ```
    #[must_use]
    pub fn description(self) -> &'static str {
        match self {
            Self::Dwell(_) | Self::DwellSeconds(_) | Self::DwellUnknown => "a dwell (G4)",
            Self::Stop => "a stop (M0, M1 or M60)",
            Self::ToolChange => "a change of tools (M6)",
        }
    }
}

/// Change of the position offset by a block.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum OffsetChange {
    /// G92: the place where the tool stands gets these coordinates (in mm).
    Here {
        coordinates_mm: [Option<f64>; 3],
        work_offset_mm: Vector3<f64>,
        /// The axis was unknown: its place is what the word says.
        establishes: [bool; 3],
    },
    /// G92.1
    Clear,
    /// G92.2
    Suspend,
    /// G92.3
    Resume,
}

/// The position offset of one run of a program: the one in the input, or the one in the output.
///
/// The two differ: the controller takes its commanded position as the reference of G92, and in the
/// output that is the corrected one.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct PositionOffset {
    pub active_mm: Vector3<f64>,
    saved_mm: Vector3<f64>,
}

impl PositionOffset {
    /// Applies a change while the tool is at `position_mm`.
    pub fn apply(&mut self, change: &OffsetChange, position_mm: &Vector3<f64>) {
        match change {
            OffsetChange::Here {
                coordinates_mm,
                work_offset_mm,
                ..
            } => {
                for axis in 0..3 {
                    if let Some(coordinate) = coordinates_mm[axis] {
                        self.active_mm[axis] =
                            position_mm[axis] - work_offset_mm[axis] - coordinate;
                    }
                }
                self.saved_mm = self.active_mm;
            }
            OffsetChange::Clear => *self = Self::default(),
            OffsetChange::Suspend => self.active_mm = Vector3::zeros(),
            OffsetChange::Resume => self.active_mm = self.saved_mm,
        }
    }
}
