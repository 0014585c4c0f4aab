//! Steps of a made program, and exact stops of the tool.

use std::ops::Range;

use nalgebra::{UnitQuaternion, Vector3};

use crate::making::events::{EventAction, EventKind};

/// Path of a made motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Way {
    Joint,
    Line,
    /// Circle through an auxiliary point, with the tool orientation there.
    Circle {
        via: Vector3<f64>,
        via_orientation: Option<UnitQuaternion<f64>>,
    },
    /// Arc or helix about the z axis of the part, with a centre.
    AboutZ {
        centre: Vector3<f64>,
        clockwise: bool,
    },
}

/// Arm configurations at the positions of a move, as the language writes them.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct StatedConfiguration {
    pub end: Option<String>,
    /// Configuration at the auxiliary point.
    pub via: Option<String>,
    /// The controller goes by that of a joint motion (RAPID: unless `ConfJ\Off`).
    pub is_followed: bool,
    /// A joint motion that goes to another one than was stated before: on a straight way the arm would keep that.
    pub changes: bool,
}

/// One motion.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct MadeMotion {
    /// The move of the path that it is of, and which part of it: shares of its length.
    pub source: usize,
    pub shares: [f64; 2],
    pub line: usize,
    pub way: Way,
    pub end: Vector3<f64>,
    pub orientation: Option<UnitQuaternion<f64>>,
    /// Direction from the tool's tip to its holder.
    pub axis: Vector3<f64>,
    pub speed_mm_per_s: f64,
    /// Speeds of turning and of external axes, where the source states them in the same language (RAPID).
    pub other_speeds: Option<Box<str>>,
    pub rapid: bool,
    /// The first of the program: from wherever the arm is.
    pub first: bool,
    /// The motion ends with an exact stop.
    pub exact: bool,
    /// Arm configurations of the motion, if the source states them.
    pub configuration: Option<Box<StatedConfiguration>>,
}

impl MadeMotion {
    /// Arm configuration at the end.
    pub(crate) fn end_configuration(&self) -> Option<&str> {
        self.configuration.as_ref()?.end.as_deref()
    }

    /// Arm configuration at the auxiliary point.
    pub(crate) fn via_configuration(&self) -> Option<&str> {
        let stated = self.configuration.as_ref()?;
        stated.via.as_deref().or(stated.end.as_deref())
    }

    /// Places that a program needs for it.
    pub(crate) fn places(&self) -> usize {
        match self.way {
            Way::Circle { .. } => 2,
            _ => 1,
        }
    }
}

/// One step.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Step {
    /// Text of the source.
    Note(String),
    /// Action that the language has.
    Action(EventAction),
    /// A statement of the template in the language of the program.
    Statement(String),
    /// Another tool, by its number.
    Tool(u32),
    Motion(MadeMotion),
}

impl Step {
    pub(crate) fn motion(&self) -> Option<&MadeMotion> {
        match self {
            Self::Motion(motion) => Some(motion),
            _ => None,
        }
    }
}

/// Ranges of the steps, one for each part.
pub(crate) fn parts(steps: &[Step], most: usize) -> Vec<Range<usize>> {
    let mut parts = Vec::new();
    let (mut start, mut places) = (0, 0);
    for (index, step) in steps.iter().enumerate() {
        let more = step.motion().map_or(0, |motion| motion.places());
        if places + more > most && places > 0 {
            parts.push(start..index);
            (start, places) = (index, 0);
        }
        places += more;
    }
    parts.push(start..steps.len());
    parts
}

/// Motions that stop: before a pause and another tool, where rapids and feeds meet, motions by joints and others, and at the end.
pub(crate) fn stops(steps: &mut [Step]) {
    let mut next: Option<[bool; 2]> = None;
    for step in steps.iter_mut().rev() {
        match step {
            Step::Motion(motion) => {
                let own = [motion.rapid, motion.way == Way::Joint];
                motion.exact |= next != Some(own);
                next = Some(own);
            }
            Step::Action(action) => {
                if matches!(action.kind(), EventKind::Dwell | EventKind::Stop) {
                    next = None;
                }
            }
            Step::Tool(_) | Step::Statement(_) => next = None,
            Step::Note(_) => {}
        }
    }
}
