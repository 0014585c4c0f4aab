//! How the tool turns in a motion: what `CirPathMode` and `SingArea` put in force.
//!
//! Source: ABB, Technical reference manual, RAPID Instructions (3HAC050917): without `CirPathMode` the tool turns with the path
//! (`\PathFrame`); without `SingArea` it turns evenly (`\Off`).

use std::ops::Range;

use crate::model::motion::{Motion, MotionKind};
use crate::model::site::TurnsOtherwise;
use crate::rapid::arguments::Arguments;
use crate::rapid::symbols::Symbols;
use crate::rapid::tree::{Statement, TokenFile};
use crate::text::name::Name;

const CIRCLES: &str = "CirPathMode";
const SINGULAR: &str = "SingArea";

/// What puts them in force.
pub(super) const MODES: [&str; 2] = [CIRCLES, SINGULAR];

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

    /// Whether the same is sure, whenever it was stated.
    pub(super) fn holds_as(self, other: Self) -> bool {
        self.object_frame.holds == other.object_frame.holds
            && self.keeps_orientation.holds == other.keeps_orientation.holds
    }

    /// After `CirPathMode` or `SingArea` with its arguments.
    pub(super) fn after(
        mut self,
        file: &TokenFile<'_>,
        tokens: &Range<usize>,
        moment: Moment,
    ) -> Self {
        let arguments = Arguments::of(file, tokens.start + 1..tokens.end);
        // What is given on a condition (`\Off?switch`) is not sure.
        let stated = |word: &str| Sure {
            holds: matches!(arguments.option(word), Some(None)),
            stated: moment,
        };
        match mode_of(file, tokens) {
            Some(CIRCLES) => self.object_frame = stated("OBJECTFRAME"),
            Some(SINGULAR) => self.keeps_orientation = stated("OFF"),
            _ => {}
        }
        self
    }

    /// What is sure at a place that the program may come to from any other: all that is stated anywhere puts it in force.
    pub(super) fn anywhere(files: &[TokenFile<'_>], symbols: &Symbols<'_>) -> Self {
        let mut met = Self::at_first(true, true);
        for home in &symbols.routines {
            let file = &files[home.file];
            let mut see = |tokens: &Range<usize>| met = met.met(met.after(file, tokens, 0));
            each_call(&home.routine.body, &mut see);
            each_call(&home.routine.handlers, &mut see);
        }
        met
    }

    /// Why the tool does not turn evenly in a motion.
    pub(super) fn otherwise(self, motion: &Motion) -> Option<TurnsOtherwise> {
        match motion.kind {
            MotionKind::Joint => None,
            _ if !self.keeps_orientation.holds => Some(TurnsOtherwise {
                reason: "the joints of the wrist turn evenly (SingArea\\Wrist or \\LockAxis4), and with them the tool does not",
                remedy: "write SingArea\\Off, or one orientation at both ends",
                evenly: None,
            }),
            MotionKind::Circular { .. } if !self.object_frame.holds => Some(TurnsOtherwise {
                reason: "on a circle it does not turn evenly: it turns with the path (CirPathMode\\PathFrame, which holds without another), or by the orientation of the place on the circle",
                remedy: "write CirPathMode\\ObjectFrame before it, with the orientations that the tool is to have",
                evenly: Some("CirPathMode\\ObjectFrame;"),
            }),
            _ => None,
        }
    }
}

/// The word of a statement that puts one in force.
pub(super) fn mode_of(file: &TokenFile<'_>, tokens: &Range<usize>) -> Option<&'static str> {
    let name = Name::of(file.word(tokens.start))?;
    MODES
        .into_iter()
        .find(|mode| name.letters().eq_ignore_ascii_case(mode.as_bytes()))
}

/// Sees all calls of a block, in order.
fn each_call(block: &[Statement], see: &mut impl FnMut(&Range<usize>)) {
    for statement in block {
        match statement {
            Statement::Call { tokens } => see(tokens),
            Statement::Branches { blocks, .. } => {
                blocks.iter().for_each(|block| each_call(block, see));
            }
            Statement::Loop { block, .. } => each_call(block, see),
            Statement::Assignment { .. } | Statement::Label { .. } | Statement::Leaves { .. } => {}
        }
    }
}
