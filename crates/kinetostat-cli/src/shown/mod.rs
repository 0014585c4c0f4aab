//! A machine in three dimensions: states of it and the path of its program, for a page with a server and for one without.

pub(crate) mod answer;
mod curve;
mod cutting;
pub(crate) mod in_report;
mod map;
mod modes;
mod opened;
pub(crate) mod path;
pub(crate) mod session;
mod state;
mod stock;
pub(crate) mod viewed;
