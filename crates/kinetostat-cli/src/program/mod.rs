//! A run along a program: solved, written to its files, summarised.

pub(crate) mod aim;
pub(crate) mod outputs;
mod points_table;
pub(crate) mod report;
pub(crate) mod solve;
pub(crate) mod summary;
