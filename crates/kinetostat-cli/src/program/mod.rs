//! A run along a program: solved, written to its files, summarised.
//!
//! It takes the setting and the machine of a job and gives the run, its files and its text: what `compensate`,
//! `deflect` and `demo` share.

pub(crate) mod aim;
pub(crate) mod chatter;
pub(crate) mod features;
pub(crate) mod flat_lines;
mod joint_columns;
pub(crate) mod outputs;
pub(crate) mod paper;
pub(crate) mod path_vtk;
#[cfg(feature = "parquet")]
pub(crate) mod places;
mod points_columns;
pub(crate) mod points_parquet;
pub(crate) mod points_table;
pub(crate) mod report;
pub(crate) mod solve;
pub(crate) mod summary;
pub(crate) mod uncertainty;
pub(crate) mod work;
