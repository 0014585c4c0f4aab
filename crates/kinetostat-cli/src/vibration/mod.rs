//! A machine that vibrates at a place: what `modes`, `frf` and `lobes` share.
//!
//! It takes a model, a place, a load, what holds the tool, and damping, and gives the machine about its equilibrium.

pub(crate) mod arguments;
pub(crate) mod damping;
pub(crate) mod damping_numbers;
pub(crate) mod pair;
pub(crate) mod stability;
pub(crate) mod subject;
