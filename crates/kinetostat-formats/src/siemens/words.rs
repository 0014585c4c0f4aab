//! Words of a block, decoded before the block's effect is known, and its programmable frames: TRANS, ATRANS, ROT, AROT.

use std::ops::Range;

use kinetostat_program::last_digit_mm;
use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};

use crate::corner::Cut;
use crate::siemens::arcs::{FromStart, Stated};
use crate::siemens::block::{How, Item, What};
use crate::siemens::state::Coordinate;

/// Use of the coordinates of a block.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum Purpose {
    /// A motion in the frame in force.
    #[default]
    Motion,
    /// A motion in the machine's axes: G53, G153, SUPA, G74, G75.
    Machine,
    /// G4: F and S are times.
    Dwell,
    /// G25, G26: limits.
    Limits,
}

/// The words of a block.
#[derive(Debug, Clone, Default)]
pub(crate) struct Words {
    pub purpose: Purpose,
    pub frame: Option<Change>,
    /// RPL.
    pub in_plane: Option<f64>,
    /// X, Y, Z.
    pub axes: [Option<Coordinate>; 3],
    /// I, J, K.
    pub centre: [Option<Coordinate>; 3],
    /// I1, J1, K1.
    pub via: [Option<Coordinate>; 3],
    /// CR and AR.
    pub radius: Option<(Range<usize>, f64)>,
    pub opening: Option<(Range<usize>, f64)>,
    /// RND, CHF, CHR, where corners are followed.
    pub corner: Option<(Range<usize>, Cut)>,
    /// A3, B3, C3.
    pub direction: [Option<(Range<usize>, f64)>; 3],
    /// A2, B2, C2, degrees.
    pub angles: [Option<(Range<usize>, f64)>; 3],
    /// Words of rotary axes that are followed: the axis among them, its word in degrees, how it counts.
    pub rotary: Vec<(usize, Coordinate, How)>,
    /// The word of the code of motion.
    pub code: Option<Range<usize>>,
    /// F, and its number where it is one.
    pub feed: Option<(Range<usize>, Option<Range<usize>>)>,
    /// Words that act at the end of the block: G9, M0, M1, M2, M17, M30, RET.
    pub at_end: Vec<Range<usize>>,
    /// G9.
    pub exact: bool,
    /// The tool changes here.
    pub changes_tool: bool,
}

impl Words {
    /// True if a position along X, Y or Z is stated.
    pub(crate) fn has_axes(&self) -> bool {
        self.axes.iter().any(Option::is_some)
    }

    /// True if an angle of a rotary axis is stated.
    pub(crate) fn has_rotary(&self) -> bool {
        !self.rotary.is_empty()
    }

    /// True if an arc is stated.
    pub(crate) fn has_arc(&self) -> bool {
        self.centre.iter().chain(&self.via).any(Option::is_some)
            || self.radius.is_some()
            || self.opening.is_some()
    }

    /// True if a tool direction is stated.
    pub(crate) fn has_direction(&self) -> bool {
        self.direction
            .iter()
            .chain(&self.angles)
            .any(Option::is_some)
    }

    /// Words that say the direction.
    pub(crate) fn direction_words(&self) -> Vec<Range<usize>> {
        self.direction
            .iter()
            .chain(&self.angles)
            .flatten()
            .map(|(word, _)| word.clone())
            .collect()
    }

    /// Words that say the arc, but for the point on it.
    pub(crate) fn arc_words(&self) -> Vec<Range<usize>> {
        let centre = self.centre.iter().flatten().map(|c| c.word.clone());
        let others = [&self.radius, &self.opening].into_iter().flatten();
        centre.chain(others.map(|(word, _)| word.clone())).collect()
    }

    /// Words of an arc in a plane, in a unit of so many mm.
    pub(crate) fn stated_arc(&self, unit_mm: f64) -> Stated {
        let centre = [0, 1, 2].map(|axis| {
            self.centre[axis].as_ref().map(|c| {
                let from = match c.step {
                    true => FromStart::Yes,
                    false => FromStart::No,
                };
                (c.mm, from)
            })
        });
        let all = self.axes.iter().chain(&self.centre).flatten();
        let written: Vec<f64> = all.map(|coordinate| coordinate.written).collect();
        Stated {
            centre,
            radius: self.radius.as_ref().map(|(_, radius)| *radius),
            opening: self.opening.as_ref().map(|(_, opening)| *opening),
            digit_mm: last_digit_mm(&written, unit_mm),
        }
    }

    /// The direction of A3, B3, C3: those that are not stated are zero.
    pub(crate) fn vector(&self) -> Option<Vector3<f64>> {
        let any = self.direction.iter().any(Option::is_some);
        let part = |axis: usize| {
            self.direction[axis]
                .as_ref()
                .map_or(0.0, |(_, value)| *value)
        };
        any.then(|| Vector3::from_fn(|axis, _| part(axis)))
    }
}

/// Group and axis of a coordinate name in capitals.
pub(crate) fn coordinate(name: &str) -> Option<(Group, usize)> {
    let (letters, group) = match name.as_bytes() {
        [letter @ b'X'..=b'Z'] => (*letter - b'X', Group::Axis),
        [letter @ b'I'..=b'K'] => (*letter - b'I', Group::Centre),
        [letter @ b'I'..=b'K', b'1'] => (*letter - b'I', Group::Via),
        [letter @ b'A'..=b'C', b'3'] => (*letter - b'A', Group::Direction),
        [letter @ b'A'..=b'C', b'2'] => (*letter - b'A', Group::Angle),
        _ => return None,
    };
    Some((group, usize::from(letters)))
}

/// Group of a coordinate.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Group {
    Axis,
    Centre,
    Via,
    Direction,
    Angle,
}

/// The coordinate of a word by its value in units of the program.
pub(crate) fn coordinate_of(
    item: &Item,
    written: f64,
    unit_mm: f64,
    step: bool,
) -> Option<Coordinate> {
    let What::Value {
        how,
        value,
        span,
        whole,
        set,
        ..
    } = &item.what
    else {
        return None;
    };
    Some(Coordinate {
        word: item.span.clone(),
        number: span.clone(),
        whole: whole.clone(),
        written,
        mm: written * unit_mm,
        step,
        wrapped: *how != How::Modal,
        literal: matches!(value, crate::siemens::expression::Expression::Number(_))
            || is_negative_number(value),
        set: *set,
    })
}

fn is_negative_number(value: &crate::siemens::expression::Expression) -> bool {
    use crate::siemens::expression::Expression;
    matches!(value, Expression::Negative(inner) if matches!(**inner, Expression::Number(_)))
}

/// A statement of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Change {
    /// TRANS: instead of all before.
    Shift,
    /// ATRANS: in the axes in force.
    FurtherShift,
    /// ROT: instead of all before.
    Turn,
    /// AROT: in the axes in force.
    FurtherTurn,
    /// SCALE or MIRROR without values: all before is taken back.
    Reset,
}

impl Change {
    /// Frame statement of a word in capitals.
    pub(crate) fn of(word: &str) -> Option<Self> {
        Some(match word {
            "TRANS" => Self::Shift,
            "ATRANS" => Self::FurtherShift,
            "ROT" => Self::Turn,
            "AROT" => Self::FurtherTurn,
            "SCALE" | "MIRROR" => Self::Reset,
            _ => return None,
        })
    }

    /// The frame in force behind it: `values` along or about X, Y, Z in mm or degrees, `in_plane` the angle of RPL about the
    /// axis across the plane.
    ///
    /// Several angles are RPY, the setting of machine data 10600 that controls come with: about Z, then the new Y, then the new X.
    pub(crate) fn applied(
        self,
        frame: &Isometry3<f64>,
        values: [f64; 3],
        in_plane: Option<f64>,
        normal: usize,
    ) -> Isometry3<f64> {
        let shift = || {
            let by = Translation3::from(Vector3::from(values));
            Isometry3::from_parts(by, UnitQuaternion::identity())
        };
        let turn = || {
            let mut angles = values.map(f64::to_radians);
            if let Some(angle) = in_plane {
                angles = [0.0; 3];
                angles[normal] = angle.to_radians();
            }
            let turn = UnitQuaternion::from_euler_angles(angles[0], angles[1], angles[2]);
            Isometry3::from_parts(Translation3::identity(), turn)
        };
        match self {
            Self::Shift => shift(),
            Self::FurtherShift => frame * shift(),
            Self::Turn => turn(),
            Self::FurtherTurn => frame * turn(),
            Self::Reset => Isometry3::identity(),
        }
    }
}
