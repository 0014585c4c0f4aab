//! Files of other programs: matrices of one link or of many nodes, meshes, displacements, loads.
//!
//! Takes a [`Text`](crate::Text); gives numbers with their units, or refuses a line with what to do. Computes nothing with
//! them.

pub(crate) mod calculix;
pub(crate) mod displacements;
pub(crate) mod dmig;
pub(crate) mod harwell_boeing;
pub(crate) mod matrix;
pub(crate) mod nodes;
pub(crate) mod superelement;
