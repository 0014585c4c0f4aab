//! What several commands say of a machine and of one equilibrium of it.

pub(crate) mod displacement_warnings;
pub(crate) mod instability;
pub(crate) mod model_warnings;
pub(crate) mod principal_directions;
pub(crate) mod stiffness_list;
pub(crate) mod units;
pub(crate) mod unstable_joints;
