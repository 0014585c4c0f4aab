//! Inverse kinematics from nominal geometry with springs at rest: of one limb, and of a graph of platforms.

pub(crate) mod graph;
pub(crate) mod limb;
pub(crate) mod nearest;
