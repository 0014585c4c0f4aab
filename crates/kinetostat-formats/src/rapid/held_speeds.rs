//! Speeds that the program assigned, as they are held while it is walked.

use std::collections::BTreeMap;

use crate::rapid::symbols::Symbols;

/// What the program gave speeds for certain, as far as it was walked.
#[derive(Debug, Default)]
pub(crate) struct AssignedSpeeds {
    /// By datum; none where it is not in numbers, or whether it was assigned is not certain.
    pub(super) held: BTreeMap<usize, Option<[f64; 4]>>,
    /// The routine that is walked runs once, and no statement of it ran on a condition: these are the values that it finds.
    pub(super) is_certain: bool,
}

impl AssignedSpeeds {
    /// What a datum holds in a statement of a routine.
    pub(crate) fn held(
        &self,
        symbols: &Symbols<'_>,
        (routine, index): (usize, usize),
    ) -> Option<[f64; 4]> {
        let datum = symbols.data.get(index)?;
        let is_followed = self.is_certain && !datum.is_changed_otherwise;
        // The statements of several routines follow one another as the calls do; here calls take away what is held.
        let is_own = datum.assigned_in.is_none_or(|own| own == routine);
        *self.held.get(&index).filter(|_| is_followed && is_own)?
    }
}
