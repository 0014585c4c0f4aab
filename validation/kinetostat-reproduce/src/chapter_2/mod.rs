//! Chapter 2: cutting forces, by the laws of `kinetostat-cutting`.

mod factors;
mod laws;
mod library;
mod materials;
mod revolution;
mod speed;
mod text_and_table;

pub(crate) use factors::table_2_1;
pub(crate) use laws::{eq_2_2, eq_2_3};
pub(crate) use materials::table_2_2;
pub(crate) use revolution::fig_2_3;
pub(crate) use speed::fig_2_2;
pub(crate) use text_and_table::{table_2_3, text_2_2};
