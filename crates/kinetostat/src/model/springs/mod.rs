//! Spring laws: what a block of coordinates stores, and with which torque and tangent stiffness it answers.
//!
//! A law is one file with one struct: energy, torque and tangent at a deflection [R 3.2, 4.9]. `block` holds the law of a
//! group of coordinates in a chain and adds its share to the chain's system.

pub(crate) mod block;
pub(crate) mod bowing;
pub(crate) mod jet;
pub(crate) mod logarithm;
pub(crate) mod parallelogram;
pub(crate) mod response;
