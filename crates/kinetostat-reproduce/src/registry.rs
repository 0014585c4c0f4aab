//! The list of entries in the order of the report.

use rayon::prelude::*;

use crate::{Cause, Contents, Entry, ReproduceError, orthoglide};

/// How an entry is computed.
type Compute = fn() -> Result<Contents, Cause>;

/// Id, title and computation of every entry.
const ENTRIES: &[(&str, &str, Compute)] = &[
    (
        "table-5.3",
        "Orthoglide near its flat singularity: critical force and displacement",
        orthoglide::table_5_3,
    ),
    (
        "fig-5.11",
        "Orthoglide: force against displacement near the flat singularity",
        orthoglide::fig_5_11,
    ),
    (
        "table-6.1",
        "Orthoglide: displacements from an assembly error of one degree in each leg",
        orthoglide::table_6_1,
    ),
    (
        "table-6.2",
        "Orthoglide: internal forces and moments of the assembled legs",
        orthoglide::table_6_2,
    ),
    (
        "fig-6.6",
        "Orthoglide: errors along a straight cut from Q2 to Q4, case A",
        orthoglide::fig_6_6,
    ),
    (
        "fig-6.7",
        "Orthoglide: errors along a straight cut from Q2 to Q4, case B",
        orthoglide::fig_6_7,
    ),
    (
        "fig-7.5",
        "Milling with the Orthoglide: what the sources of error make of the trajectory",
        orthoglide::fig_7_5,
    ),
    (
        "fig-7.6",
        "Milling with the Orthoglide: superposition of the sources of error",
        orthoglide::fig_7_6,
    ),
    (
        "fig-7.7",
        "Milling with the Orthoglide: compensation along a circle",
        orthoglide::fig_7_7,
    ),
    (
        "fig-7.8",
        "Milling with the Orthoglide: compensation at several places",
        orthoglide::fig_7_8,
    ),
];

/// The ids, in the order of the report.
pub const IDS: [&str; ENTRIES.len()] = ids();

const fn ids() -> [&'static str; ENTRIES.len()] {
    let mut list = [""; ENTRIES.len()];
    let mut i = 0;
    while i < list.len() {
        list[i] = ENTRIES[i].0;
        i += 1;
    }
    list
}

/// Computes one entry.
///
/// # Errors
///
/// [`ReproduceError::Unknown`] if there is no such id (see [`IDS`]); [`ReproduceError::Failed`] if
/// the computation ends without an answer.
pub fn one(id: &str) -> Result<Entry, ReproduceError> {
    let (id, title, compute) = ENTRIES
        .iter()
        .find(|(known, ..)| *known == id)
        .ok_or_else(|| ReproduceError::Unknown(id.to_owned()))?;
    match compute() {
        Ok(contents) => Ok(Entry {
            id,
            title: (*title).to_owned(),
            items: contents.items,
            plots: contents.plots,
        }),
        Err(cause) => Err(ReproduceError::Failed { id, cause }),
    }
}

/// Computes all entries, in the order of [`IDS`] whatever the number of threads. `done` is told each
/// id as it is finished, in any order.
///
/// # Errors
///
/// The first, in the order of the report, of the errors of [`one`].
pub fn all(done: impl Fn(&str) + Sync) -> Result<Vec<Entry>, ReproduceError> {
    let found: Vec<Result<Entry, ReproduceError>> = IDS
        .par_iter()
        .map(|id| {
            let entry = one(id);
            done(id);
            entry
        })
        .collect();
    found.into_iter().collect()
}
