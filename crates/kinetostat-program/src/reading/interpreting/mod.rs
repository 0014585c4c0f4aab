//! Block by block: what each of them changes, and where the tool goes.
//!
//! Knows: modes, offsets and places after the last block ([`Interpreter`]). Takes a block ([`interpret`]) and gives its move
//! ([`motion`], [`carried`]) or what it changes ([`offsets`]); in the end the path ([`interpret`]).

pub(crate) mod carried;
pub(crate) mod interpret;
pub(crate) mod motion;
pub(crate) mod offsets;
pub(crate) mod warnings;

use std::collections::BTreeMap;

use nalgebra::Vector3;

use crate::path::moves::{Change, CoordinateWords, Event, Move, Pause, PositionOffset, Warning};
use crate::reading::block::Block;
use crate::reading::extra::RotaryOrigins;
use crate::reading::modes::Modes;
use crate::reading::options::{ReadOptions, ToolCentrePoint};
use crate::reading::places::{Places, Shifts};
use crate::reading::repeated::Repeated;
use crate::reading::rotary::RotaryWords;
use crate::reading::spindle::SpindleWords;
use crate::reading::tools::ToolWords;

/// Modal state while a program is read line by line.
pub(crate) struct Interpreter<'o> {
    pub(in crate::reading) options: &'o ReadOptions,
    pub(super) rotary: RotaryWords<'o>,
    pub(crate) modes: Modes,
    pub(in crate::reading) offset: PositionOffset,
    pub(in crate::reading) shifts: Shifts,
    /// Origins of the work coordinate systems, mm, part frame; `None` if they are not stated.
    pub(in crate::reading) origins_mm: [Option<Vector3<f64>>; 9],
    pub(super) rotary_origins: RotaryOrigins,
    pub(crate) places: Places,
    pub(in crate::reading) ended: Option<usize>,
    pub(super) no_feed_warned: bool,
    pub(super) repeated: Repeated,
    /// Work coordinate system of the first motion.
    pub(super) first_system: Option<usize>,
    pub(super) moves: Vec<Move>,
    /// Known axes before and after each move, and whether one was known before and is so no more.
    pub(super) knowledge: Vec<([bool; 3], [bool; 3], bool)>,
    pub(super) events: Vec<Event>,
    pub(super) pauses: Vec<Pause>,
    pub(super) tools: ToolWords,
    pub(in crate::reading) spindle: SpindleWords,
    pub(super) warnings: Vec<Warning>,
    /// Line of the first lengths without a unit.
    pub(super) units_assumed_on: Option<usize>,
    /// Line of the first feed whose way is not judged.
    pub(super) unjudged_feed_on: Option<usize>,
    /// Subprograms by number that are in none of the files, each with the first line that calls it.
    pub(super) outside_calls: BTreeMap<u32, usize>,
}

/// Modal state that blocks leave for later ones.
pub(crate) struct InterpreterState {
    modes: Modes,
    offset: PositionOffset,
    shifts: Shifts,
    origins_mm: [Option<Vector3<f64>>; 9],
    rotary_origins: RotaryOrigins,
    places: Places,
    ended: Option<usize>,
    no_feed_warned: bool,
    first_system: Option<usize>,
    spindle: SpindleWords,
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
            units_assumed_on: None,
            unjudged_feed_on: None,
            outside_calls: BTreeMap::new(),
        }
    }

    /// All of what was read so far that the blocks behind it depend on.
    pub(crate) fn state(&self) -> InterpreterState {
        InterpreterState {
            modes: self.modes.clone(),
            offset: self.offset,
            shifts: self.shifts,
            origins_mm: self.origins_mm,
            rotary_origins: self.rotary_origins,
            places: self.places.clone(),
            ended: self.ended,
            first_system: self.first_system,
            no_feed_warned: self.no_feed_warned,
            spindle: self.spindle.following(),
        }
    }

    /// An interpreter of the blocks behind others; it has no moves yet.
    pub(crate) fn behind(options: &'o ReadOptions, state: &InterpreterState) -> Self {
        Self {
            modes: state.modes.clone(),
            offset: state.offset,
            shifts: state.shifts,
            origins_mm: state.origins_mm,
            rotary_origins: state.rotary_origins,
            places: state.places.clone(),
            ended: state.ended,
            first_system: state.first_system,
            no_feed_warned: state.no_feed_warned,
            spindle: state.spindle.following(),
            ..Self::new(options)
        }
    }

    /// An interpreter of other blocks from where this one is, in its modes; it has no moves yet.
    pub(crate) fn following(&self) -> Self {
        Self::behind(self.options, &self.state())
    }

    /// Makes room for so many motions.
    pub(crate) fn reserve(&mut self, motions: usize) {
        self.moves.reserve(motions);
        self.knowledge.reserve(motions);
    }

    /// Looks at the motions that were read since the last call, each with the axes that are known before and after it, and keeps none.
    pub(crate) fn pass_moves(&mut self, mut look: impl FnMut(&Move, [[bool; 3]; 2])) {
        self.events.clear();
        self.pauses.clear();
        for (motion, (before, after, _)) in self.moves.iter().zip(&self.knowledge) {
            look(motion, [*before, *after]);
        }
        self.moves.clear();
        self.knowledge.clear();
    }

    /// Puts a motion in the place of all that were taken.
    pub(crate) fn put_move(&mut self, motion: Move) {
        self.moves.push(motion);
        self.knowledge.push(([true; 3], [true; 3], false));
    }

    /// Number of motions read since they were last taken.
    pub(crate) fn move_count(&self) -> usize {
        self.moves.len()
    }

    /// The last motion that was read.
    pub(crate) fn last_move(&self) -> Option<&Move> {
        self.moves.last()
    }

    pub(super) fn warn_of_corrections(&mut self, line: usize, text: &str) {
        self.warnings.push(Warning::of_corrections(line, text));
    }

    pub(super) fn warn(&mut self, line: usize, text: &str) {
        self.warnings.push(Warning::new(line, text.to_owned()));
    }

    pub(super) fn note_no_motion(&mut self, block: &Block<'_>) {
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

    /// Form of the words of a move that goes to machine places along these axes.
    pub(super) fn coordinate_words(
        &self,
        mm_per_unit: f64,
        to_machine: [bool; 3],
    ) -> CoordinateWords {
        CoordinateWords {
            mm_per_unit,
            incremental: self.modes.incremental,
            absolute_centre: self.modes.absolute_centre,
            work_offset_mm: self.work_offset_mm(),
            to_machine,
        }
    }

    pub(in crate::reading) fn work_offset_mm(&self) -> Vector3<f64> {
        let origin = self.origins_mm.get(self.modes.work_offset);
        origin.copied().flatten().unwrap_or_default()
    }

    /// Origin of A, B and C in a work coordinate system.
    pub(super) fn rotary_origin(&self, system: usize) -> [f64; 3] {
        self.rotary_origins.get(system).copied().unwrap_or_default()
    }
}
