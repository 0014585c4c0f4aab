//! Cutting forces in a job file: `[material]`, `[stock]`, `[engagement]`, `[spindle]` and the `cutter` of a tool.
//!
//! Takes the tables; gives the question for [`kinetostat_machining::CutQuestion`] and what was assumed, in words.

pub(crate) mod along;
mod engagement;
mod files_of_cut;
mod material;
mod question;
mod stock;

pub(crate) use question::{CutSetup, cut_setup};
