//! Modal state between two blocks.

use std::collections::BTreeMap;
use std::ops::Range;

use nalgebra::{Isometry3, UnitQuaternion, Vector3};

use crate::standing::Standing;

/// Shift of a frame that is none, mm.
pub(crate) const NO_SHIFT_MM: f64 = 1e-9;

/// Motion code: type of interpolation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum Code {
    /// G0.
    Rapid,
    /// G1.
    #[default]
    Line,
    /// G2.
    Clockwise,
    /// G3.
    Counterclockwise,
    /// CIP.
    Through,
}

impl Code {
    /// Code as a block states it.
    pub(crate) fn word(self) -> &'static str {
        match self {
            Self::Rapid => "G0",
            Self::Line => "G1",
            Self::Clockwise => "G2",
            Self::Counterclockwise => "G3",
            Self::Through => "CIP",
        }
    }

    /// Motion code of a word in capitals.
    pub(crate) fn of(word: &str) -> Option<Self> {
        Some(match word {
            "G0" => Self::Rapid,
            "G1" => Self::Line,
            "G2" => Self::Clockwise,
            "G3" => Self::Counterclockwise,
            "CIP" => Self::Through,
            _ => return None,
        })
    }

    /// True for circular interpolation.
    pub(crate) fn is_arc(self) -> bool {
        !matches!(self, Self::Rapid | Self::Line)
    }
}

/// Type of feed: meaning of F.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum FeedMode {
    /// G94.
    #[default]
    PerMinute,
    /// G95, G96.
    PerTurn,
}

/// Rotation of the master spindle as far as the program states it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Turning {
    /// S, rpm; none where it is not known.
    pub rpm: Option<f64>,
    /// M3 or M4.
    pub on: bool,
    /// S is a cutting speed: G96, G961.
    pub by_cutting_speed: bool,
}

impl Turning {
    /// S.
    pub(crate) fn state(&mut self, speed: Option<f64>) {
        self.rpm = speed.filter(|speed| *speed > 0.0 && !self.by_cutting_speed);
    }

    /// G96 and the like, or back to turns.
    pub(crate) fn count(&mut self, by_cutting_speed: bool) {
        if self.by_cutting_speed != by_cutting_speed {
            self.rpm = None;
        }
        self.by_cutting_speed = by_cutting_speed;
    }

    /// The turns in a minute, where it turns and they are known.
    pub(crate) fn in_force(&self) -> Option<f64> {
        self.rpm.filter(|_| self.on)
    }
}

/// A feed as it was written.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Feed {
    pub value: f64,
    pub text: String,
}

/// Meaning of the angles A2, B2, C2.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Angles {
    /// ORIEULER.
    Euler,
    /// ORIRPY.
    Rpy,
}

/// An axis beside X, Y and Z.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct OtherAxis {
    /// Position of the axis as programmed.
    pub at: Option<f64>,
    /// A place of the machine was stated behind that.
    pub elsewhere: bool,
}

/// The number of an axis where its last word was, and how the frame of it was turned.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Counted {
    pub number_mm: f64,
    pub turn: UnitQuaternion<f64>,
}

/// Modal state.
#[derive(Debug, Clone, Default)]
pub(crate) struct State {
    pub code: Code,
    /// Axis across the plane of arcs: 2 for G17.
    pub normal: usize,
    /// Length of the unit of coordinates, mm.
    pub unit_mm: f64,
    /// G70, G71, G700 or G710 was read, or it was remarked that none is stated.
    pub unit_stated: bool,
    /// Length of the unit of the feed, mm.
    pub feed_unit_mm: f64,
    /// G91.
    pub steps: bool,
    pub feed_mode: FeedMode,
    pub feed: Option<Feed>,
    pub spindle: Turning,
    /// G60.
    pub exact: bool,
    /// Programmable frame: from its axes to those of the part, mm.
    pub frame: Isometry3<f64>,
    pub work_object: String,
    pub tool: String,
    /// Selected, and taken by M6.
    pub next_tool: Option<String>,
    pub edge: Option<u64>,
    /// TRAORI.
    pub oriented: bool,
    pub angles: Option<Angles>,
    /// ORIMKS.
    pub machine_orientation: bool,
    /// ORIAXES; or ORIVECT: the tool's axis goes on a great circle. Where neither is stated, ORIMKS turns the axes evenly, and ORIVECT
    /// is the basic setting.
    pub even_axes: Option<bool>,
    /// The missing ORIAXES or ORIVECT was reported.
    pub law_remarked: bool,
    /// Blocks behind a slash were remarked.
    pub slash_remarked: bool,
    /// The machine's rotary axes whose words are followed.
    pub standing: Standing,
    /// Direction of the tool in the part's axes, where it was stated.
    pub direction: Option<Vector3<f64>>,
    /// Tool position in the frame's axes, mm.
    pub place: [Option<f64>; 3],
    /// Numbers of the axes' last words, from which steps count.
    pub counted: [Option<Counted>; 3],
    /// The last motion.
    pub last: Option<usize>,
    pub others: BTreeMap<Vec<u8>, OtherAxis>,
    /// M30 or the like was read.
    pub ended: bool,
    /// Something was refused: what follows from it is not reported again.
    pub lost: bool,
    /// Words that were stated since the last motion.
    pub stated: StatedModes,
}

/// Modal words that the blocks between two motions state.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct StatedModes {
    /// A code of motion.
    pub code: bool,
    pub feed: bool,
}

impl State {
    /// State at the start of a program; `standing` holds the rotary axes whose words are followed.
    pub(crate) fn new(standing: Standing) -> Self {
        Self {
            normal: 2,
            unit_mm: 1.0,
            feed_unit_mm: 1.0,
            work_object: "PART".to_owned(),
            tool: "TOOL".to_owned(),
            standing,
            ..Self::default()
        }
    }

    /// Tool position in the frame's axes; `None` if an axis is unknown.
    pub(crate) fn known_place(&self) -> Option<Vector3<f64>> {
        let [x, y, z] = self.place;
        Some(Vector3::new(x?, y?, z?))
    }

    /// Puts another programmable frame in force; the tool stays where it is.
    pub(crate) fn set_frame(&mut self, frame: Isometry3<f64>) {
        let between = frame.inverse() * self.frame;
        let turn = between.rotation.to_rotation_matrix();
        let old = self.place;
        self.place = [0, 1, 2].map(|axis| {
            let mut sum = between.translation.vector[axis];
            for from in 0..3 {
                let share = turn[(axis, from)];
                if share.abs() > NO_SHARE {
                    sum += share * old[from]?;
                }
            }
            Some(sum)
        });
        self.frame = frame;
    }

    /// The place is not known any longer.
    pub(crate) fn forget(&mut self) {
        self.place = [None; 3];
    }
}

/// Parts of a rotation below this are rounding.
const NO_SHARE: f64 = 1e-12;

/// A coordinate of a block, mm.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Coordinate {
    /// The whole word.
    pub word: Range<usize>,
    /// The number or expression.
    pub number: Range<usize>,
    /// The value with what is around it, behind `=`.
    pub whole: Range<usize>,
    /// The value as written, in units of the program.
    pub written: f64,
    pub mm: f64,
    /// Incremental value.
    pub step: bool,
    /// `AC(` or the like stands around the number.
    pub wrapped: bool,
    /// The value is a number, not an expression.
    pub literal: bool,
    /// `=` stands before it.
    pub set: bool,
}
