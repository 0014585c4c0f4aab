//! The report of a run: what it means, its figures and tables, its pictures, and the page that holds them.
//!
//! Takes a run's result or all of its points; gives HTML or SVG.

pub(crate) mod along;
pub(crate) mod chatter;
pub(crate) mod cutting;
pub(crate) mod facts;
pub(crate) mod force_band;
pub(crate) mod joints;
pub(crate) mod meaning;
pub(crate) mod page;
pub(crate) mod plan;
pub(crate) mod shown;
pub(crate) mod uncertainty;
