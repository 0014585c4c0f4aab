//! What several commands say of a machine and of one equilibrium of it.

pub(crate) mod instability;
pub(crate) mod unstable_joints;
