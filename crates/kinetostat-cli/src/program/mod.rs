//! A run along a program: solved, written to its files, summarised.

pub(crate) mod points_table;
pub(crate) mod solve;
pub(crate) mod summary;
