//! Modal state of a controller after the last block.

use nalgebra::Vector3;

use crate::path::moves::{FeedMode, Motion};
use crate::path::spindle::{Spindle, SpindleRotation};
use crate::reading::interpreting::Interpreter;
use crate::reading::options::{OtherAxes, Units};

/// First of the numbered parameters that say where the tool is, in program coordinates and units: X, Y, Z.
const PLACE: u32 = 5420;

/// A hundredth of an inch.
const PECK_BACK_MM: f64 = 0.254;

impl Interpreter<'_> {
    /// The end of the program was read.
    pub(crate) fn has_ended(&self) -> bool {
        self.ended.is_some()
    }

    /// Reason for which rotary axes, whose words are only carried, may have turned the tool; `None` if they have not.
    pub(crate) fn carried_turn(&self) -> Option<String> {
        if self.options.other_axes != OtherAxes::Carried {
            return None;
        }
        if self.modes.tool_centre_point {
            return Some("tool centre point control (G43.4) is on".to_owned());
        }
        let mut angles = ['A', 'B', 'C'].into_iter().filter_map(|letter| {
            let angle = self.modes.extra.place(letter)?;
            Some((letter, angle))
        });
        let (letter, angle) = angles.find(|(_, angle)| *angle != 0.0)?;
        Some(format!("axis {letter} stands at {angle} deg"))
    }

    /// Axes of the plane, and the one across it.
    pub(crate) fn plane_axes(&self) -> [usize; 3] {
        self.modes.plane
    }

    /// G91.
    pub(crate) fn is_incremental(&self) -> bool {
        self.modes.incremental
    }

    /// G90.1.
    pub(crate) fn centres_are_places(&self) -> bool {
        self.modes.absolute_centre
    }

    /// True if places without a motion code are the ends of arcs.
    pub(crate) fn moves_in_arcs(&self) -> bool {
        matches!(
            self.modes.motion,
            Some(Motion::Clockwise | Motion::CounterClockwise)
        )
    }

    /// The code of motion in force: `G0` to `G3`; none behind G80 and before the first.
    pub(crate) fn motion_code(&self) -> Option<&'static str> {
        match self.modes.motion? {
            Motion::Rapid => Some("G0"),
            Motion::Feed => Some("G1"),
            Motion::Clockwise => Some("G2"),
            Motion::CounterClockwise => Some("G3"),
            Motion::Off => None,
        }
    }

    /// Units in force, where they are named.
    pub(crate) fn units(&self) -> Option<Units> {
        self.modes.units()
    }

    /// Tool position in the part frame, mm; `None` if it is not known.
    pub(crate) fn place_mm(&self, axis: usize) -> Option<f64> {
        self.places.known[axis].then_some(self.places.position[axis])
    }

    /// A place in the part frame (mm) in program coordinates and units; mm where no units are named.
    pub(crate) fn in_program(&self, axis: usize, place_mm: f64) -> f64 {
        let unit = self.modes.units().map_or(1.0, Units::mm_per_unit);
        let offset = self.work_offset_mm() + self.offset.active_mm;
        (place_mm - offset[axis]) / unit
    }

    /// G93, G94, G95.
    pub(crate) fn feed_mode(&self) -> FeedMode {
        self.modes.feed_mode()
    }

    /// The F in force, in program units; `None` if there is none.
    pub(crate) fn feed_in_units(&self) -> Option<f64> {
        let feed = self.modes.feed?;
        let unit = self.modes.units().map_or(1.0, Units::mm_per_unit);
        Some(match feed.mode {
            FeedMode::InverseTime => feed.value,
            _ => feed.value / unit,
        })
    }

    /// Index of the work coordinate system: 0 for G54, from 9 on additional ones.
    pub(crate) fn work_system(&self) -> usize {
        self.modes.work_offset
    }

    /// True if a tool length is in force along an axis.
    pub(crate) fn has_tool_length_along(&self, axis: usize) -> bool {
        self.modes.has_tool_length(axis)
    }

    /// True if a tool length is in force.
    pub(crate) fn has_tool_length(&self) -> bool {
        (0..3).any(|axis| self.has_tool_length_along(axis))
    }

    /// The offset of G92 along an axis, mm; `None` if only the machine knows it.
    pub(crate) fn position_offset_mm(&self, axis: usize) -> Option<f64> {
        (!self.shifts.now[axis]).then_some(self.offset.active_mm[axis])
    }

    /// Origin of the program's coordinates, mm, part frame.
    pub(crate) fn origin_mm(&self) -> Vector3<f64> {
        self.work_offset_mm() + self.offset.active_mm
    }

    /// The program counts from another place now; the tool stands still.
    pub(crate) fn stand_at(&mut self, place_mm: Vector3<f64>) {
        self.places.position = place_mm;
    }

    /// True if cycles retract to level R (G99), false if to their start (G98); `None` before the program states it.
    pub(crate) fn retracts_to_level(&self) -> Option<bool> {
        self.modes.retract_mode.map(|code| code == 990)
    }

    /// Spindle state.
    pub(crate) fn spindle(&self) -> Spindle {
        self.spindle.now()
    }

    pub(crate) fn spindle_rotation(&self) -> SpindleRotation {
        self.spindle.now().rotation
    }

    /// Height above its last depth at which a peck begins, in program units (LinuxCNC 2.9, `G83_RAPID_DELTA`).
    pub(crate) fn peck_back(&self) -> f64 {
        match self.modes.units() {
            Some(Units::Inches) => PECK_BACK_MM / Units::Inches.mm_per_unit(),
            _ => PECK_BACK_MM,
        }
    }

    /// Tool position in program coordinates and units; the error is the reason for which it is not known.
    pub(crate) fn coordinate(&self, axis: usize) -> Result<f64, String> {
        let unit = self.modes.units().map(Units::mm_per_unit);
        match (self.places.known[axis], unit) {
            (true, Some(unit)) => {
                let offset = self.work_offset_mm() + self.offset.active_mm;
                Ok((self.places.position[axis] - offset[axis]) / unit)
            }
            _ => Err(format!(
                "where the tool is along {} is not known here",
                ["X", "Y", "Z"][axis]
            )),
        }
    }

    /// A numbered parameter that the controller keeps; `None` for those that programs set.
    pub(crate) fn numbered_state(&self, number: u32) -> Option<Result<f64, String>> {
        match number {
            PLACE..=5422 => Some(self.coordinate((number - PLACE) as usize)),
            5220 if self.modes.work_offset < 9 => Some(Ok(1.0 + self.modes.work_offset as f64)),
            5161..=5390 | 5400..=5428 => Some(self.kept(number).ok_or_else(|| format!(
                "#{number} is kept by the controller, and its value is not known here: give it as a parameter, or with the machine's zero and work offsets"
            ))),
            _ => None,
        }
    }

    /// Reference points, offsets of G92 and origins of systems, in mm, where they are known.
    fn kept(&self, number: u32) -> Option<f64> {
        let zero = || self.options.machine_zero_mm;
        match number {
            5161..=5163 => Some(self.options.reference_points_mm[0]?[(number - 5161) as usize]),
            5181..=5183 => Some(self.options.reference_points_mm[1]?[(number - 5181) as usize]),
            5211..=5213 => {
                let axis = (number - 5211) as usize;
                let sure = self.shifts.is_sure(axis);
                sure.then_some(self.offset.active_mm[axis])
            }
            5221..=5390 => {
                let (system, index) = ((number - 5221) / 20, (number - 5221) % 20);
                let origin = self.origins_mm[system as usize]?;
                match index {
                    0..=2 => Some(origin[index as usize] - zero()?[index as usize]),
                    // The system is not turned.
                    9 => Some(0.0),
                    _ => None,
                }
            }
            _ => None,
        }
    }

    /// A named parameter of the state; `None` if there is none of this name.
    pub(crate) fn named_state(&self, name: &str) -> Result<Option<f64>, String> {
        let truth = |holds: bool| Ok(Some(f64::from(u8::from(holds))));
        match name {
            "_x" => self.coordinate(0).map(Some),
            "_y" => self.coordinate(1).map(Some),
            "_z" => self.coordinate(2).map(Some),
            "_metric" => truth(self.modes.units() == Some(Units::Millimetres)),
            "_imperial" => truth(self.modes.units() == Some(Units::Inches)),
            "_incremental" => truth(self.modes.incremental),
            "_absolute" => truth(!self.modes.incremental),
            _ => Ok(None),
        }
    }
}
