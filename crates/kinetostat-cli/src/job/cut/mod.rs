//! Cutting forces in a job file: `[material]`, `[stock]`, `[engagement]`, `[spindle]` and the `cutter` of a tool; `[measured]`.
//!
//! Takes the tables; gives the question for [`kinetostat_machining::CutQuestion`] and what was assumed, in words.

pub(crate) mod along;
pub(crate) mod cutters;
mod files_of_cut;
pub(crate) mod material;
pub(crate) mod question;
pub(crate) mod refused;
pub(crate) mod stock;

pub(crate) use along::{MeasuredSetup, measured_setup};
pub(crate) use files_of_cut::FilesOfCut;
pub(crate) use question::{CutSetup, cut_setup};
