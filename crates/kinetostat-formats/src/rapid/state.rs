//! State of a RAPID run beside its data: modal state, and cached frames.

use std::collections::BTreeMap;
use std::rc::Rc;

use nalgebra::Isometry3;

use crate::interpreter::run;
use crate::interpreter::symbols::Symbols;
use crate::interpreter::token::TokenFile;
use crate::interpreter::value::Datum;
use crate::model::frame::FrameUse;
use crate::options::ReadOptions;
use crate::rapid::turning::Modes;
use crate::text::name::Name;

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
