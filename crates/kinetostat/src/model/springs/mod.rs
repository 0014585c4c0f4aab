//! Spring laws: what a group of coordinates stores, and with which torque and tangent stiffness it answers.
//!
//! A law is one file with one struct [R 3.2, 4.9], written once for every number that an engine calculates with
//! ([`crate::linalg::derivatives`]), and registered in [`block`].
//!
//! ```text
//! curved         six coordinates with strains of their own   bowing, logarithm
//! bilinear       one coordinate, and what such laws share
//! parallelogram  a matrix that depends on the posture
//! block          all laws, and a law in a chain: its share in energy, torques and tangent
//! ```

pub(crate) mod bilinear;
pub(crate) mod block;
pub(crate) mod bowing;
pub(crate) mod curved;
pub(crate) mod logarithm;
pub(crate) mod parallelogram;
