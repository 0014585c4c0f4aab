//! How the tool turns in a motion: what `CirPathMode` and `SingArea` put in force.
//!
//! Source: ABB, Technical reference manual, RAPID Instructions (3HAC050917): without `CirPathMode` the tool turns with the path
//! (`\PathFrame`); without `SingArea` it turns evenly (`\Off`).

use crate::model::motion::{Motion, MotionKind};

/// What puts them in force.
pub(super) const MODES: [&str; 2] = ["CirPathMode", "SingArea"];

/// Something that is in force for sure, or not.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Sure {
    holds: bool,
    /// When it was stated, counted in [`Moment`]s: what was stated within a loop or a routine does not depend on how that is entered.
    stated: Moment,
}

/// Statements of modes, and beginnings of loops and routines, in the order in which they are walked.
pub(super) type Moment = usize;

impl Sure {
    fn met(self, other: Self) -> Self {
        Self {
            holds: self.holds && other.holds,
            stated: self.stated.min(other.stated),
        }
    }
}

/// What is in force for sure, whichever way the program takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Modes {
    /// `CirPathMode\ObjectFrame`: on a circle the tool turns evenly in the work object.
    object_frame: Sure,
    /// `SingArea\Off`: between its ends the tool turns evenly.
    keeps_orientation: Sure,
}

impl Modes {
    const fn at_first(object_frame: bool, keeps_orientation: bool) -> Self {
        Self {
            object_frame: Sure {
                holds: object_frame,
                stated: 0,
            },
            keeps_orientation: Sure {
                holds: keeps_orientation,
                stated: 0,
            },
        }
    }

    /// As a program begins.
    pub(super) const BASIC: Self = Self::at_first(false, true);

    /// Nothing is sure: a routine calls itself.
    pub(super) const NOTHING: Self = Self::at_first(false, false);

    /// What is sure where two ways meet.
    pub(super) fn met(self, other: Self) -> Self {
        Self {
            object_frame: self.object_frame.met(other.object_frame),
            keeps_orientation: self.keeps_orientation.met(other.keeps_orientation),
        }
    }

    /// What is sure where what was in force at a moment may have been otherwise, too.
    pub(super) fn met_before(self, moment: Moment, other: Self) -> Self {
        let of = |own: Sure, other: Sure| match own.stated < moment {
            true => own.met(other),
            false => own,
        };
        Self {
            object_frame: of(self.object_frame, other.object_frame),
            keeps_orientation: of(self.keeps_orientation, other.keeps_orientation),
        }
    }

    /// After `CirPathMode` or `SingArea` with its arguments.
    pub(super) fn after(mut self, name: &str, arguments: &str, moment: Moment) -> Self {
        let arguments = arguments.to_ascii_uppercase();
        let stated = |word: &str| Sure {
            holds: arguments.contains(word),
            stated: moment,
        };
        if name.eq_ignore_ascii_case("CirPathMode") {
            self.object_frame = stated("OBJECTFRAME");
        } else if name.eq_ignore_ascii_case("SingArea") {
            self.keeps_orientation = stated("OFF");
        }
        self
    }

    /// Why the tool does not turn evenly in a motion.
    pub(super) fn otherwise(self, motion: &Motion) -> Option<(&'static str, &'static str)> {
        match motion.kind {
            MotionKind::Joint => None,
            _ if !self.keeps_orientation.holds => Some((
                "the joints of the wrist turn evenly (SingArea\\Wrist or \\LockAxis4), and with them the tool does not",
                "write SingArea\\Off, or one orientation at both ends",
            )),
            MotionKind::Circular { .. } if !self.object_frame.holds => Some((
                "on a circle it does not turn evenly: it turns with the path (CirPathMode\\PathFrame, which holds without another), or by the orientation of the place on the circle",
                "write CirPathMode\\ObjectFrame before it, with the orientations that the tool is to have",
            )),
            _ => None,
        }
    }
}
