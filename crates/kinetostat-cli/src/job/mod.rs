//! The job of a run along a program, from a job file and options, options over the file: machine,
//! program, placement, load, tolerances, limits and outputs.

pub(crate) mod all_faults;
pub(crate) mod arguments;
pub(crate) mod format;
pub(crate) mod job_file;
mod limits;
mod load;
pub(crate) mod machine;
pub(crate) mod output_paths;
mod placement;
pub(crate) mod program;
mod reading;
pub(crate) mod run_warnings;
pub(crate) mod setting;
pub(crate) mod source;
mod toml_tree;
mod tools;
mod values;
