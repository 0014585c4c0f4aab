//! How the tool turns in a motion: what `CirPathMode` and `SingArea` put in force.
//!
//! Source: ABB, Technical reference manual, RAPID Instructions (3HAC050917): without `CirPathMode` the tool turns with the path
//! (`\PathFrame`); without `SingArea` it turns evenly (`\Off`).

use crate::model::motion::{Motion, MotionKind};

/// What puts them in force.
pub(super) const MODES: [&str; 2] = ["CirPathMode", "SingArea"];

/// What is in force for sure, whichever way the program takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Modes {
    /// `CirPathMode\ObjectFrame`: on a circle the tool turns evenly in the work object.
    pub object_frame: bool,
    /// `SingArea\Off`: between its ends the tool turns evenly.
    pub keeps_orientation: bool,
}

impl Modes {
    /// As a program begins.
    pub(super) const BASIC: Self = Self {
        object_frame: false,
        keeps_orientation: true,
    };

    /// Nothing is sure: a routine calls itself.
    pub(super) const NOTHING: Self = Self {
        object_frame: false,
        keeps_orientation: false,
    };

    /// What is sure where two ways meet.
    pub(super) fn met(self, other: Self) -> Self {
        Self {
            object_frame: self.object_frame && other.object_frame,
            keeps_orientation: self.keeps_orientation && other.keeps_orientation,
        }
    }

    /// Behind `CirPathMode` or `SingArea` with its arguments.
    pub(super) fn behind(mut self, name: &str, arguments: &str) -> Self {
        let arguments = arguments.to_ascii_uppercase();
        if name.eq_ignore_ascii_case("CirPathMode") {
            self.object_frame = arguments.contains("OBJECTFRAME");
        } else if name.eq_ignore_ascii_case("SingArea") {
            self.keeps_orientation = arguments.contains("OFF");
        }
        self
    }

    /// Why the tool does not turn evenly in a motion.
    pub(super) fn otherwise(self, motion: &Motion) -> Option<(&'static str, &'static str)> {
        match motion.kind {
            MotionKind::Joint => None,
            _ if !self.keeps_orientation => Some((
                "the joints of the wrist turn evenly (SingArea\\Wrist or \\LockAxis4), and with them the tool does not",
                "write SingArea\\Off, or one orientation at both ends",
            )),
            MotionKind::Circular { .. } if !self.object_frame => Some((
                "on a circle it does not turn evenly: it turns with the path (CirPathMode\\PathFrame, which holds without another), or by the orientation of the place on the circle",
                "write CirPathMode\\ObjectFrame before it, with the orientations that the tool is to have",
            )),
            _ => None,
        }
    }
}
