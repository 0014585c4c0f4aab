//! TODO

pub(crate) mod compliance;
pub(crate) mod directions;
pub(crate) mod divergence;
pub(crate) mod equilibrium;
pub(crate) mod graded;
pub(crate) mod link_load;
pub(crate) mod material;
pub(crate) mod newton;
pub(crate) mod passive;
pub(crate) mod potential;
pub(crate) mod problem;
pub(crate) mod residual;
pub(crate) mod scaling;
pub(crate) mod stability;
pub(crate) mod stiffness;
pub(crate) mod sweep;
pub(crate) mod system;
