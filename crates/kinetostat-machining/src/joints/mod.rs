//! Figures of joint values and drive loads: distance to limits, share of ratings, configuration of an arm.
//!
//! Takes the mechanism, joint values and drive loads; gives plain data. Closed forms of the nominal geometry, no equilibrium is solved.

pub(crate) mod arm;
pub(crate) mod figures;
