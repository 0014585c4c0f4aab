//! The list of entries in the order of the report.

use rayon::prelude::*;

use crate::chapter_3::{passive_joints, stewart_gough};
use crate::chapter_4::{two_link_matrices, two_links};
use crate::chapter_5::{elastic_figures, three_link_figures, three_links, toggle, two_chains};
use crate::{Cause, Contents, Entry, ReproduceError, chapter_2, orthoglide};

/// Computation of an entry.
type Compute = fn() -> Result<Contents, Cause>;

/// Id, title and computation of every entry.
const ENTRIES: &[(&str, &str, Compute)] = &[
    (
        "fig-2.2",
        "Cutting force over the cutting speed",
        chapter_2::fig_2_2,
    ),
    (
        "fig-2.3",
        "Cutting forces over one revolution of a milling cutter",
        chapter_2::fig_2_3,
    ),
    (
        "text-2.2",
        "Cutting forces and torques named in the text of 2.2",
        chapter_2::text_2_2,
    ),
    (
        "table-2.1",
        "Correction factors of the cutting force",
        chapter_2::table_2_1,
    ),
    (
        "table-2.2",
        "Specific cutting forces of high performance materials",
        chapter_2::table_2_2,
    ),
    (
        "eq-2.2",
        "Specific cutting force and force per width over the chip thickness",
        chapter_2::eq_2_2,
    ),
    (
        "eq-2.3",
        "Rational law of the cutting force",
        chapter_2::eq_2_3,
    ),
    (
        "table-2.3",
        "Cutting forces for high performance materials",
        chapter_2::table_2_3,
    ),
    (
        "table-3.1",
        "A planar link with a passive joint",
        passive_joints::table_3_1,
    ),
    (
        "table-3.2",
        "A link with a trivial passive joint",
        passive_joints::table_3_2,
    ),
    ("eq-3.26", "Stiffness of a beam", passive_joints::eq_3_26),
    (
        "table-3.3",
        "A link with a quasi-trivial passive joint",
        passive_joints::table_3_3,
    ),
    (
        "eq-3.34",
        "Stewart-Gough platform, case A",
        stewart_gough::eq_3_34,
    ),
    (
        "eq-3.35",
        "Stewart-Gough platform, case B",
        stewart_gough::eq_3_35,
    ),
    (
        "text-4.4",
        "Sizes of the linear systems",
        two_link_matrices::text_4_4,
    ),
    (
        "eq-4.31",
        "Force of two rigid links under a load on the middle",
        two_links::eq_4_31,
    ),
    (
        "eq-4.32",
        "Stiffness of two rigid links under a load on the middle",
        two_links::eq_4_32,
    ),
    (
        "text-4.6.1",
        "Two rigid links: stiffnesses named in the text",
        two_links::text_4_6_1,
    ),
    (
        "fig-4.3",
        "Two rigid links: force and stiffness against displacement",
        two_links::fig_4_3,
    ),
    (
        "table-4.1",
        "Two rigid links: Jacobians and Hessians",
        two_link_matrices::table_4_1,
    ),
    (
        "fig-4.4",
        "Two elastic links: force against displacement, limit points",
        elastic_figures::fig_4_4,
    ),
    (
        "table-4.2",
        "Two elastic links: Jacobians and Hessians",
        two_link_matrices::table_4_2,
    ),
    (
        "fig-4.5",
        "Two elastic links: all shapes",
        elastic_figures::fig_4_5,
    ),
    (
        "fig-5.2",
        "Two chains of three links with one tool: stable and unstable shapes",
        two_chains::fig_5_2,
    ),
    (
        "eq-5.32",
        "Three links, straight at rest: force of the arch",
        three_links::eq_5_32,
    ),
    (
        "eq-5.33",
        "Three links, straight at rest: force of the zigzag",
        three_links::eq_5_33,
    ),
    (
        "eq-5.34",
        "Three links, straight at rest: posture of the zigzag",
        three_links::eq_5_34,
    ),
    (
        "fig-5.5",
        "Three links: energy over the first angle",
        three_link_figures::fig_5_5,
    ),
    (
        "fig-5.6",
        "Three links, straight at rest: shapes",
        three_link_figures::fig_5_6,
    ),
    (
        "fig-5.7",
        "Three links, straight at rest: force and stability",
        three_link_figures::fig_5_7,
    ),
    (
        "fig-5.8",
        "Three links, zigzag at rest: shapes, force and buckling",
        three_link_figures::fig_5_8,
    ),
    (
        "eq-5.41",
        "Three links: product of the Jacobian with itself",
        three_links::eq_5_41,
    ),
    (
        "eq-5.42",
        "Three links: its characteristic equation",
        three_links::eq_5_42,
    ),
    (
        "text-5.5.1",
        "Three links: numbers and statements of the text",
        three_links::text_5_5_1,
    ),
    (
        "table-5.1",
        "Three links: force, stiffness and stability",
        three_links::table_5_1,
    ),
    (
        "table-5.2",
        "Two rigid links: stiffness and stability coefficient",
        two_links::table_5_2,
    ),
    (
        "eq-5.45",
        "Toggle frame: critical displacement and force",
        toggle::eq_5_45,
    ),
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
        "Orthoglide assembled with 1 mm of error along each slider (Case A)",
        orthoglide::table_6_1,
    ),
    (
        "table-6.2",
        "Orthoglide assembled with one degree of error about each slider (Case B)",
        orthoglide::table_6_2,
    ),
    (
        "fig-6.6",
        "Orthoglide: errors along a straight cut from Q2 to Q5, Case A",
        orthoglide::fig_6_6,
    ),
    (
        "fig-6.7",
        "Orthoglide: errors along a straight cut from Q2 to Q5, Case B",
        orthoglide::fig_6_7,
    ),
    (
        "fig-7.2",
        "Method of the symmetrical trajectory, on the groove of the Orthoglide",
        orthoglide::fig_7_2,
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

/// Computes all entries, in the order of [`IDS`] whatever the number of threads. `done` is called with each
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
