//! TODO

pub(crate) mod block;
pub(crate) mod bowing;
pub(crate) mod jet;
pub(crate) mod logarithm;
pub(crate) mod parallelogram;
pub(crate) mod response;
