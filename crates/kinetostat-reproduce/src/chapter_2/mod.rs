//! Chapter 2: cutting forces.

mod cutting;
mod text_and_table;

pub(crate) use text_and_table::{table_2_3, text_2_2};
