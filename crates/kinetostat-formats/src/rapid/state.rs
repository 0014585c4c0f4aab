//! State of a RAPID run beside its data: modal state, and cached frames.
//!
//! Modal state of how the tool turns in a motion: `CirPathMode` and `SingArea`.
//!
//! Source: ABB, Technical reference manual, RAPID Instructions (3HAC050917): without `CirPathMode` the tool turns with the path
//! (`\PathFrame`); without `SingArea` it turns evenly (`\Off`).

use std::collections::BTreeMap;
use std::ops::Range;
use std::rc::Rc;

use nalgebra::Isometry3;

use crate::interpreter::run;
use crate::interpreter::symbols::Symbols;
use crate::interpreter::token::TokenFile;
use crate::interpreter::value::Datum;
use crate::model::motion::{FrameUse, Motion, MotionKind};
use crate::model::site::TurnsOtherwise;
use crate::options::ReadOptions;
use crate::rapid::lex::Arguments;
use crate::text::Name;

/// A run of a RAPID program.
pub(crate) type Run<'r, 'p> = run::Run<'r, 'p, Rapid>;

/// A frame and the value that it was read from.
pub(crate) type KnownFrame = (Rc<Vec<Datum>>, FrameUse);

/// Modal state of a RAPID program, and the frames that it has used.
pub(crate) struct Rapid {
    pub modes: Modes,
    /// Program displacement, in the axes of the work object, mm.
    pub displacement: Option<Isometry3<f64>>,
    /// Frames that the caller states.
    pub stated: BTreeMap<Name, Isometry3<f64>>,
    /// Frames of tools and work objects by the values that they were read from.
    pub frames: BTreeMap<(bool, Name), KnownFrame>,
}

impl Rapid {
    /// A run that has not begun.
    pub(crate) fn run<'r, 'p>(
        files: &'p [TokenFile<'p>],
        symbols: &'r Symbols<'p>,
        options: &'r ReadOptions,
    ) -> Run<'r, 'p> {
        let stated = options.frames.iter();
        let stated = stated.filter_map(|(name, frame)| Some((Name::of(name.as_bytes())?, *frame)));
        let own = Self {
            modes: Modes::BASIC,
            displacement: None,
            stated: stated.collect(),
            frames: BTreeMap::new(),
        };
        Run::new(files, symbols, options, own)
    }
}

const CIRCLES: &str = "CirPathMode";
const SINGULAR: &str = "SingArea";

/// Modal state of turning.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Modes {
    /// `CirPathMode\ObjectFrame`: on a circle the tool turns evenly in the work object.
    object_frame: bool,
    /// `SingArea\Off`: between its ends the tool turns evenly.
    keeps_orientation: bool,
}

impl Modes {
    /// The state in which a program begins.
    pub(super) const BASIC: Self = Self {
        object_frame: false,
        keeps_orientation: true,
    };

    /// The state after `CirPathMode` or `SingArea` with its arguments. An argument that is given on a condition (`\Off?switch`) is taken
    /// not to be given.
    pub(super) fn after(mut self, file: &TokenFile<'_>, tokens: &Range<usize>) -> Self {
        let arguments = Arguments::of(file, tokens.start + 1..tokens.end);
        let is_given = |word: &str| matches!(arguments.option(word), Some(None));
        match mode_of(file, tokens) {
            Some(CIRCLES) => self.object_frame = is_given("OBJECTFRAME"),
            Some(SINGULAR) => self.keeps_orientation = is_given("OFF"),
            _ => {}
        }
        self
    }

    /// The reason why the tool does not turn evenly in a motion.
    pub(super) fn otherwise(self, motion: &Motion) -> Option<TurnsOtherwise> {
        match motion.kind {
            MotionKind::Joint => None,
            _ if !self.keeps_orientation => Some(TurnsOtherwise {
                reason: "the joints of the wrist turn evenly (SingArea\\Wrist or \\LockAxis4), and with them the tool does not",
                remedy: "write SingArea\\Off, or one orientation at both ends",
                evenly: None,
            }),
            MotionKind::Circular { .. } if !self.object_frame => Some(TurnsOtherwise {
                reason: "on a circle it does not turn evenly: it turns with the path (CirPathMode\\PathFrame, which holds without another), or by the orientation of the place on the circle",
                remedy: "write CirPathMode\\ObjectFrame before it, with the orientations that the tool is to have",
                evenly: Some("CirPathMode\\ObjectFrame;"),
            }),
            _ => None,
        }
    }
}

/// The word of a statement that sets a mode.
pub(super) fn mode_of(file: &TokenFile<'_>, tokens: &Range<usize>) -> Option<&'static str> {
    let name = Name::of(file.word(tokens.start))?;
    [CIRCLES, SINGULAR]
        .into_iter()
        .find(|mode| name.letters().eq_ignore_ascii_case(mode.as_bytes()))
}
