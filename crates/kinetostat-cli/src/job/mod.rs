//! The job of a run along a program, from a job file and options, options over the file: machine,
//! program, placement, load, tolerances, limits and outputs.

pub(crate) mod all_faults;
pub(crate) mod format;
mod limits;
pub(crate) mod machine;
pub(crate) mod setting;
pub(crate) mod source;
