//! TODO

pub(crate) mod graph;
pub(crate) mod limb;
pub(crate) mod nearest;
