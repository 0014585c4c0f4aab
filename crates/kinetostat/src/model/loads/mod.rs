//! TODO

pub(crate) mod check;
pub(crate) mod follower;
pub(crate) mod function;
pub(crate) mod length_law;
pub(crate) mod load;
pub(crate) mod node_load;
pub(crate) mod platform;
pub(crate) mod potential;
pub(crate) mod strut;
