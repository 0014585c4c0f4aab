//! TODO

pub(crate) mod following;
pub(crate) mod target;
