//! The words that hold until others of their kind replace them.

use crate::error::{ProgramError, ProgramErrorKind};
use crate::path::moves::{Feed, FeedMode, Motion, MoveKind};
use crate::reading::block::Block;
use crate::reading::extra::ExtraAxes;
use crate::reading::options::Units;

/// The modal state of the input.
#[derive(Clone, Default)]
pub(crate) struct Modes {
    pub motion: Option<Motion>,
    pub incremental: bool,
    /// G90.1: centre words are places.
    pub absolute_centre: bool,
    /// Axes of the plane and its normal.
    pub plane: [usize; 3],
    pub feed: Option<Feed>,
    /// Index of the work coordinate system: 0 for G54, from 9 on additional ones.
    pub work_offset: usize,
    pub extra: ExtraAxes,
    /// G98 or G99, in tenths; `None` before the program says it.
    pub retract_mode: Option<u32>,
    units: Option<Units>,
    /// The units are those of the options: the program has named none and nothing has moved.
    units_are_assumed: bool,
    /// The program has given lengths before any unit, which were taken for millimetres.
    units_by_default: bool,
    feed_mode: FeedMode,
    /// The units changed after the F in force was given, or in its block.
    feed_is_stale: bool,
    /// Axes along which a tool offset is in force.
    tool_length_on: [bool; 3],
    /// Places are those of the tool's tip in the part, however the rotary axes stand.
    pub tool_centre_point: bool,
    /// Interpolation of the tool between directions I, J and K (G43.5); `None` if angles state its orientation.
    pub directions: Option<DirectionLaw>,
    /// A block that began tool centre point control was refused: what its axes do is not asked until the next one.
    pub axes_in_doubt: bool,
    /// H of the G43 in force, where it names one.
    length_number: Option<f64>,
}

/// Index of the first work coordinate system behind G59.3: G54.1 P1.
const FIRST_ADDITIONAL: usize = 9;

/// Index of G154 P1, which is behind all of G54.1.
const FIRST_OF_HAAS: usize = 1000;

/// Interpolation of the tool from one direction to the next.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum DirectionLaw {
    /// Each axis evenly (G43.5, or with P0).
    Evenly,
    /// The tool's axis on a great circle: tool posture control (G43.5 P1).
    GreatCircle,
}

impl Modes {
    pub fn new(units: Option<Units>) -> Self {
        Self {
            plane: [0, 1, 2],
            units,
            units_are_assumed: units.is_some(),
            ..Self::default()
        }
    }

    /// A block that began tool centre point control was refused: lines behind it have no fault because of it.
    pub fn doubt_axes(&mut self, by_direction: bool) {
        self.tool_centre_point = true;
        self.axes_in_doubt = true;
        self.directions = by_direction.then_some(DirectionLaw::Evenly);
    }

    /// Takes over the modal words of a block, in the order in which controllers do, but for the tool length.
    pub fn set(&mut self, block: &Block<'_>) -> Result<(), ProgramError> {
        let codes = &block.codes;
        if let Some(code) = codes.feed_mode {
            self.set_feed_mode(code);
        }
        if codes.units == Some(200) && self.units_by_default {
            return Err(block.refuse(
                ProgramErrorKind::Ambiguous,
                None,
                "G20 follows lengths that were given before any unit, and that were taken for millimetres",
                "begin the program with G20 or G21, or give the units (--units, or units under [reading] in the job file)",
            ));
        }
        self.units_by_default &= codes.units.is_none();
        let units_changed = codes.units.is_some_and(|code| self.set_units(code));
        if let Some(value) = block.value(b'F') {
            self.set_feed(block, value, units_changed)?;
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
        self.retract_mode = codes.retract_mode.or(self.retract_mode);
        if let Some(code) = codes.arc_distance {
            self.absolute_centre = code == 901;
        }
        if let Some(code) = codes.work_offset {
            self.set_work_offset(block, code)?;
        }
        if let Some(motion) = codes.motion {
            self.motion = Some(motion);
        }
        Ok(())
    }

    fn set_feed_mode(&mut self, code: u32) {
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

    /// Sets the units; returns true if others were in force before.
    fn set_units(&mut self, code: u32) -> bool {
        let units = match code {
            200 => Units::Inches,
            _ => Units::Millimetres,
        };
        // Options say what holds where the program says nothing.
        let assumed = std::mem::take(&mut self.units_are_assumed) && self.feed.is_none();
        let before = self.units.replace(units);
        let before = before.filter(|before| *before != units && !assumed);
        if let Some(before) = before {
            self.feed_is_stale = self.feed.is_some();
            self.extra
                .change_units(before.mm_per_unit() / units.mm_per_unit());
        }
        before.is_some()
    }

    fn set_feed(
        &mut self,
        block: &Block<'_>,
        value: f64,
        units_changed: bool,
    ) -> Result<(), ProgramError> {
        if value <= 0.0 {
            return Err(block.refuse(
                ProgramErrorKind::Malformed,
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
        // LinuxCNC reads F beside a change of units in the old ones, grbl in the new ones.
        self.feed_is_stale =
            self.feed_mode != FeedMode::InverseTime && (self.units.is_none() || units_changed);
        self.feed = Some(Feed {
            mode: self.feed_mode,
            value: value * scale,
        });
        Ok(())
    }

    fn set_work_offset(&mut self, block: &Block<'_>, code: u32) -> Result<(), ProgramError> {
        self.work_offset = match code {
            540..=590 if code.is_multiple_of(10) && block.value(b'P').is_none() => {
                (code as usize - 540) / 10
            }
            591..=593 => code as usize - 591 + 6,
            _ => {
                let mut words = block.words.iter();
                let word = words.find(|word| word.letter == b'P');
                let (name, first, most) = match code {
                    1540 => ("G154", FIRST_OF_HAAS, 99),
                    _ => ("G54.1", FIRST_ADDITIONAL, 300),
                };
                let number = (1..=most).find(|n| word.map(|p| p.value) == Some(*n as f64));
                let Some(number) = number.filter(|_| matches!(code, 541 | 1540)) else {
                    return Err(block.refuse(
                        ProgramErrorKind::UnknownCode,
                        word,
                        "P names no additional work coordinate system",
                        &format!("write {name} P1 to {name} P{most}, or G54 to G59.3"),
                    ));
                };
                first + number - 1
            }
        };
        Ok(())
    }

    /// Axes along which the block changes the length of the tool: the tool's point is at another
    /// coordinate than before, and at which is not in the program.
    pub fn set_tool_length(&mut self, block: &Block<'_>) -> [bool; 3] {
        const Z: [bool; 3] = [false, false, true];
        let Some(code) = block.codes.tool_length else {
            return [false; 3];
        };
        let number = block.value(b'H').filter(|_| code == 430);
        let before = std::mem::replace(&mut self.length_number, number);
        match code {
            // The length in force is selected again.
            430 if number.is_some() && number == before => [false; 3],
            // Cancelling what was never set is a habit of the first block and changes nothing.
            490 => std::mem::take(&mut self.tool_length_on),
            code => {
                let named = block.codes.length_axes;
                let axes = match code != 430 && named != [false; 3] {
                    true => named,
                    false => Z,
                };
                for axis in (0..3).filter(|axis| axes[*axis]) {
                    self.tool_length_on[axis] = true;
                }
                axes
            }
        }
    }

    /// The table of tools has changed: the next G43 may bring another length.
    pub fn forget_length_number(&mut self) {
        self.length_number = None;
    }

    /// True if a tool offset is in force along an axis.
    pub fn has_tool_length(&self, axis: usize) -> bool {
        self.tool_length_on[axis]
    }

    /// Faults that would be found again in every block that follows are reported once.
    pub fn go_on_after_fault(&mut self) {
        self.units.get_or_insert(Units::Millimetres);
        self.motion.get_or_insert(Motion::Feed);
        self.feed_is_stale = false;
    }

    /// Takes millimetres where the program gives lengths before any unit; false where it has named one.
    pub fn assume_units(&mut self) -> bool {
        let assumed = self.units.is_none();
        if assumed {
            self.units = Some(Units::Millimetres);
            self.units_by_default = true;
            self.feed_is_stale = false;
        }
        assumed
    }

    /// Something moved, or was placed: the units in force were used.
    pub fn use_units(&mut self) {
        self.units_are_assumed = false;
    }

    /// True if the units of the options are in force and the block names others.
    pub fn overrides_options(&self, block: &Block<'_>) -> bool {
        let named = match block.codes.units {
            Some(200) => Some(Units::Inches),
            Some(_) => Some(Units::Millimetres),
            None => None,
        };
        self.units_are_assumed && named.is_some_and(|named| self.units != Some(named))
    }

    /// G93, G94, G95.
    pub fn feed_mode(&self) -> FeedMode {
        self.feed_mode
    }

    /// Units in force, where they are named.
    pub fn units(&self) -> Option<Units> {
        self.units
    }

    /// Millimetres in one unit; a motion needs it.
    pub fn mm_per_unit(&self, block: &Block<'_>) -> Result<f64, ProgramError> {
        self.units.map(Units::mm_per_unit).ok_or_else(|| {
            block.refuse(
                ProgramErrorKind::Ambiguous, None,
                "the program moves before it names its units",
                "begin it with G21 (mm) or G20 (inch), or give the units (--units, or units under [reading] in the job file)",
            )
        })
    }

    /// Checks that the F in force determines the speed of the block.
    pub fn check_feed(&self, block: &Block<'_>, kind: MoveKind) -> Result<(), ProgramError> {
        if kind == MoveKind::Rapid {
            return Ok(());
        }
        if self.feed_mode == FeedMode::InverseTime && block.value(b'F').is_none() {
            return Err(block.refuse(
                ProgramErrorKind::Ambiguous,
                None,
                "with G93 (inverse time) every feed block needs its own F",
                "write F into the block",
            ));
        }
        if self.feed_is_stale {
            return Err(block.refuse(
                ProgramErrorKind::Ambiguous, None,
                "the units were named after the F in force, or changed in its block: its value is read differently by controllers",
                "write F again in a block after G20 or G21",
            ));
        }
        Ok(())
    }
}
