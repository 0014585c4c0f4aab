//! TODO

pub(crate) mod lost_motion;
pub(crate) mod near;
