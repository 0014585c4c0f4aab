//! TODO

pub(crate) mod chain;
pub(crate) mod limb;
pub(crate) mod solver;
pub(crate) mod step;
