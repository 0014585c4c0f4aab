//! The job of a run along a program, from a job file and options, options over the file: machine,
//! program, placement, load, tolerances, limits and outputs.

pub(crate) mod all_faults;
pub(crate) mod arguments;
pub(crate) mod format;
pub(crate) mod job_file;
mod limits;
mod load;
pub(crate) mod machine;
mod placement;
pub(crate) mod program;
mod reading;
pub(crate) mod setting;
pub(crate) mod source;
pub(crate) mod targets;
mod toml_tree;
mod tools;
mod values;
