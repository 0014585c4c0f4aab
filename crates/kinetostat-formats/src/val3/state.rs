//! What a run of VAL3 keeps beside its data.

use std::collections::BTreeMap;

use nalgebra::Isometry3;

use crate::interpreter::run;
use crate::interpreter::symbols::Symbols;
use crate::interpreter::token::TokenFile;
use crate::options::ReadOptions;
use crate::text::name::Name;

/// A run of a VAL3 program.
pub(super) type Run<'r, 'p> = run::Run<'r, 'p, Val3>;

/// What a run keeps beside its data.
pub(crate) struct Val3 {
    /// Frames that the caller states.
    pub stated: BTreeMap<Name, Isometry3<f64>>,
    /// Motions were commanded, and nothing waited for their ends.
    pub is_moving: bool,
}

impl Val3 {
    /// A run that has not begun.
    pub(super) fn run<'r, 'p>(
        files: &'p [TokenFile<'p>],
        symbols: &'r Symbols<'p>,
        options: &'r ReadOptions,
    ) -> Run<'r, 'p> {
        let stated = options.frames.iter();
        let stated = stated.filter_map(|(name, frame)| Some((Name::of(name.as_bytes())?, *frame)));
        let own = Self {
            stated: stated.collect(),
            is_moving: false,
        };
        Run::new(files, symbols, options, own)
    }
}
