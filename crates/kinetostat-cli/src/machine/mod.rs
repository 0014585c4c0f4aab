//! Common descriptions of a machine, and of one equilibrium of it, for several commands.
//!
//! It takes models, mechanisms and equilibria and gives sentences, warnings and parts of answers. It computes
//! nothing: that is for `kinetostat` and `kinetostat-analysis`.

pub(crate) mod displacement_warnings;
pub(crate) mod instability;
pub(crate) mod model_warnings;
pub(crate) mod principal_directions;
pub(crate) mod stiffness_list;
pub(crate) mod units;
pub(crate) mod unstable_joints;
