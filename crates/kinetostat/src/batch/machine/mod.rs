//! A machine in several postures: its limbs, the platform that they hold, the target that compensates a load.
//!
//! Takes limbs and a group of postures, gives equilibria, stiffness and stability of each lane.
//!
//! ```text
//! sum T_i^T F_i = W                                    [R 6.21-6.30];   t0F <- t0F + (t - f^-1(F | t0F))   [R 7.13]
//! ```

pub(crate) mod compensate;
pub(crate) mod converge;
pub(crate) mod corrector;
pub(crate) mod extrapolated;
pub(crate) mod group;
pub(crate) mod kept;
pub(crate) mod loaded;
pub(crate) mod platform;
pub(crate) mod start;
