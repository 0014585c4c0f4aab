//! Spring laws: what a group of coordinates stores, and with which torque and tangent stiffness it answers.
//!
//! A law is one file with one struct [R 3.2, 4.9], written once for every number that an engine calculates with
//! ([`crate::linalg::derivatives`]), and registered in [`law`].
//!
//! ```text
//! law            all laws, and the two kinds of them that are not a constant matrix:
//! curved         six coordinates with strains of their own   bowing, logarithm; rotation: what both share
//! single         one coordinate                              bilinear
//! parallelogram  a matrix that depends on the posture
//! block          a law in a chain: its share in energy, torques and tangent
//! ```

pub(crate) mod bilinear;
pub(crate) mod block;
pub(crate) mod bowing;
pub(crate) mod curved;
pub(crate) mod logarithm;
pub(crate) mod parallelogram;
