//! The job of a run along a program, from a job file and options; options go over the file.
//!
//! It takes both and gives two parts: the [`setting`] (program, how it is read and written, limits, outputs) and
//! the [`machine`] (model, tool, placement, load). What is wrong is reported with its line, all of it at once
//! ([`all_faults`]).

pub(crate) mod all_faults;
pub(crate) mod arguments;
mod cell;
pub(crate) mod chatter;
pub(crate) mod cut;
mod cut_tables;
mod dialect_word;
mod expand_table;
pub(crate) mod expansion;
pub(crate) mod feature_lines;
pub(crate) mod features;
pub(crate) mod file_endings;
pub(crate) mod format;
pub(crate) mod free_turn;
pub(crate) mod job_file;
pub(crate) mod limits;
mod load;
pub(crate) mod machine;
pub(crate) mod of_model;
pub(crate) mod output_paths;
pub(crate) mod over_part;
mod part_stated;
pub(crate) mod place_table;
mod placement;
pub(crate) mod program;
pub(crate) mod reading;
pub(crate) mod robot;
pub(crate) mod robot_arguments;
pub(crate) mod robot_table;
pub(crate) mod rotary;
pub(crate) mod run_warnings;
pub(crate) mod setting;
pub(crate) mod source;
pub(crate) mod target_word;
pub(crate) mod template_file;
mod toml_tree;
pub(crate) mod tool_mass;
mod tools;
pub(crate) mod turn_arguments;
pub(crate) mod uncertain;
pub(crate) mod units_word;
mod values;
