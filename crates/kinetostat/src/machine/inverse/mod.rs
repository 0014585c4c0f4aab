//! TODO

pub(crate) mod forward;
pub(crate) mod graph;
pub(crate) mod limb;
pub(crate) mod mobility;
pub(crate) mod nearest;
