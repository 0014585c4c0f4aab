//! Equilibrium of the platforms of a mechanism: every limb condensed to what it answers at its end, the platforms
//! solved, the limbs following. One such step is one Newton step of the flattened system.

pub(crate) mod chain;
pub(crate) mod limb;
pub(crate) mod newton;
pub(crate) mod parts;
pub(crate) mod solver;
pub(crate) mod step;
