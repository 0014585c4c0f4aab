//! Modal state between two blocks, with cutter compensation, tool centre point control (M128, FUNCTION TCPM) and tilted working planes
//! (PLANE).

use std::collections::BTreeMap;

use nalgebra::{Vector2, Vector3};

use crate::heidenhain::arcs::Plane;
use crate::heidenhain::datum::{Bend, Datum};
use crate::heidenhain::words::{Value, Word};
use crate::model::motion::Speed;
use crate::standing::Standing;

/// The pole of polar coordinates and the centre of circles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Pole {
    pub plane: Plane,
    /// Pole position in the plane, in the programmed axes, mm.
    pub at: Vector2<f64>,
    /// The centre was stated relative to the tool position.
    pub relative: bool,
}

/// Modal state.
#[derive(Debug, Clone, Default)]
pub(crate) struct State {
    /// Tool position in the programmed axes, mm; `None` if unknown.
    pub place: [Option<f64>; 3],
    /// A mirror image or a scaling began or ended, and not all axes were stated since.
    pub unstated: bool,
    /// A rotation began or ended, and X and Y were not stated since: where a block with one of them goes is not known.
    pub unsettled: bool,
    /// The working plane, across the tool's axis of the last TOOL CALL.
    pub plane: Plane,
    pub pole: Option<Pole>,
    /// The last polar radius about this pole, mm.
    pub radius_mm: Option<f64>,
    /// Direction in which the last block ended.
    pub direction: Option<Vector3<f64>>,
    /// Feed as programmed.
    pub feed: Option<f64>,
    pub feed_text: String,
    /// F of the last TOOL CALL.
    pub tool_feed: Option<f64>,
    pub per_turn: bool,
    /// S of the last TOOL CALL that states one, rpm.
    pub turns_per_minute: Option<f64>,
    /// M3, M4, M13 or M14.
    pub spindle_on: bool,
    pub tool: String,
    /// The control's preset by its name.
    pub preset: String,
    pub datum: Datum,
    pub tilt: Tilt,
    /// The last motion.
    pub last: Option<usize>,
    /// Axis of the tool in the programmed axes.
    pub axis: Vector3<f64>,
    /// A direction of the tool was stated.
    pub directed: bool,
    /// The surface normal that the last motion stated, as programmed.
    pub normal: Option<Vector3<f64>>,
    /// The last cycle that was defined for a call.
    pub cycle: Option<u32>,
    /// M89 is on.
    pub calls: bool,
    /// The path is moved aside by the tool's radius.
    pub aside: Option<Aside>,
    /// Radii of TOOL DEF by the tool, and that of the tool in force with DR of TOOL CALL, mm.
    pub cutters_mm: BTreeMap<String, f64>,
    pub cutter_mm: Option<f64>,
    pub tip: TipControl,
    /// M126: rotary axes turn the shorter way.
    pub shorter: bool,
    /// The machine's rotary axes whose words are followed.
    pub standing: Standing,
}

impl State {
    /// State at the start of a file; `standing` holds the rotary axes whose words are followed.
    pub(crate) fn new(standing: Standing) -> Self {
        Self {
            tool: "TOOL".to_owned(),
            preset: "PRESET".to_owned(),
            axis: Vector3::z(),
            standing,
            ..Self::default()
        }
    }

    /// Tool position in a plane, as far as words count from there.
    pub(crate) fn in_plane(&self, plane: Plane) -> Option<Vector2<f64>> {
        plane.known(self.counts_from())
    }

    /// The place that words of a block count from.
    pub(crate) fn counts_from(&self) -> [Option<f64>; 3] {
        match self.unsettled {
            true => [None, None, self.place[2]],
            false => self.place,
        }
    }

    /// A block moves in the plane.
    pub(crate) fn settle(&mut self) {
        self.place = self.counts_from();
        self.unsettled = false;
    }

    /// The tool's length or the machine's axes are others now.
    pub(crate) fn lost(&mut self) {
        self.place = [None; 3];
        self.unstated = false;
        self.direction = None;
        self.last = None;
    }

    /// Shifts the datum along an axis: the tool stays, and is at other coordinates.
    pub(crate) fn shift(&mut self, axis: usize, to_mm: f64) {
        let by = to_mm - self.datum.shift_mm[axis];
        self.datum.shift_mm[axis] = to_mm;
        if by != 0.0 {
            self.place[axis] = self.place[axis].map(|at| at - by);
            self.pole = None;
            self.direction = None;
        }
    }

    /// Mirrors, turns or scales. Axes that a mirror image leaves as they are stay where they are; what else is not
    /// stated again behind it or a scaling is not known. Behind a rotation the tool stays where it is
    /// until X or Y is stated.
    pub(crate) fn bend(&mut self, bend: Bend) {
        if bend == self.datum.bend {
            return;
        }
        let in_plane = matches!(
            (bend, self.datum.bend),
            (
                Bend::None | Bend::Rotation(_),
                Bend::None | Bend::Rotation(_)
            )
        );
        let before = self.datum;
        self.datum.bend = bend;
        self.place = match (in_plane, self.place) {
            (true, [Some(x), Some(y), z]) => {
                self.unsettled = true;
                let there = before.preset(&Vector3::new(x, y, 0.0));
                let here = self.datum.programmed(&there);
                [Some(here.x), Some(here.y), z]
            }
            (true, [_, _, z]) => [None, None, z],
            (false, place) => {
                let stays = |axis: usize| {
                    bend.factor(axis).is_some() && bend.factor(axis) == before.bend.factor(axis)
                };
                let kept = [0, 1, 2].map(|axis| place[axis].filter(|_| stays(axis)));
                self.unstated = true;
                kept
            }
        };
        self.pole = None;
        self.direction = None;
    }

    /// The speed in force as it is written, for a unit of so many mm.
    pub(crate) fn speed(&self, unit_mm: f64) -> Speed {
        // Programs in inches state feeds in tenths of an inch in a minute.
        let per_unit = match unit_mm == 1.0 {
            true => 1.0,
            false => unit_mm / 10.0,
        };
        let per_minute = match self.per_turn {
            false => Some(per_unit),
            // The unit of M136 in inch programs is not modelled.
            true => self
                .turns_per_minute
                .filter(|_| self.spindle_on && unit_mm == 1.0),
        };
        let value = self.feed.zip(per_minute);
        Speed {
            mm_per_s: value.map(|(feed, per_minute)| feed * per_minute / 60.0),
            text: self.feed_text.clone(),
        }
    }
}

/// The side of the contour on which the tool goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Aside {
    /// RL.
    Left,
    /// RR.
    Right,
}

/// Mode of tool centre point control.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct TipControl {
    pub on: bool,
    /// AXIS SPAT: words of rotary axes are angles in space.
    pub spatial: bool,
    /// PATHCTRL VECTOR: the tool's axis stays in a plane.
    pub by_vector: bool,
}

/// Position of the rotary axes.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) enum Stands {
    /// Angles of their words.
    #[default]
    AsWords,
    /// Angles at which the tool lies along a direction, in the axes of the preset.
    Along(Vector3<f64>),
    /// Words turned them from such angles, and the model has no rotary axes.
    Unknown,
}

/// State that PLANE leaves in force.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Tilt {
    /// Normal of the last plane, in the axes of the preset; `None` after a reset.
    pub across: Option<Vector3<f64>>,
    pub stands: Stands,
    /// Axes whose datum a cycle shifted while the plane was tilted.
    pub shifted: [bool; 3],
    /// A cut was refused since the plane or the axes changed.
    pub told: bool,
}

/// True for a word that turns a rotary axis to its angle of the plane: `A+Q120`, `B+Q121`, `C+Q122`.
pub(crate) fn is_of_plane(word: &Word, bytes: &[u8]) -> bool {
    let name = match word.letters.letters() {
        b"A" => b"Q120",
        b"B" => b"Q121",
        b"C" => b"Q122",
        _ => return false,
    };
    matches!(&word.value, Value::Parameter { sign, name: own, .. } if *sign > 0.0 && bytes[own.clone()].eq_ignore_ascii_case(name))
}
