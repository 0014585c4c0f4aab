//! TODO

pub(crate) mod negative_stiffness;
pub(crate) mod participation;
