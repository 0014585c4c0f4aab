//! All entries as one page: formulas as the report writes them, numbers beside their print.

pub(crate) mod formula;
pub(crate) mod html;
pub(crate) mod mathml;
