//! The Orthoglide of chapters 5.5.3, 6 and 7.

mod assembly;
pub(crate) mod bars;
mod circle;
mod flat;
mod groove;
mod line;
pub(crate) mod machine;
mod sources_of_error;
mod symmetrical;
mod toggle;

pub(crate) use assembly::{table_6_1, table_6_2};
pub(crate) use flat::{fig_5_11, table_5_3};
pub(crate) use groove::{fig_7_7, fig_7_8};
pub(crate) use line::{fig_6_6, fig_6_7};
pub(crate) use sources_of_error::{fig_7_5, fig_7_6};
pub(crate) use symmetrical::fig_7_2;
