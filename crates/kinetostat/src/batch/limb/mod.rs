//! One limb in several postures: commands, equilibrium under a wrench at its tip, stiffness, buckling margin.
//!
//! Takes a compiled chain and lanes of targets and wrenches, gives lanes of coordinates, wrenches and stiffnesses.
//!
//! ```text
//! outwards: poses and wrenches from the base;  inwards: K^-1 = sum a_j c_j a_j^T by articulated bodies   [R 3.10-3.13]
//! loaded: tau(q) = J^T F,  K_F = [J (K - H)^-1 J^T]^-1                                                    [R 4.16]
//! ```

pub(crate) mod freed;
pub(crate) mod inwards;
pub(crate) mod law;
pub(crate) mod loaded;
pub(crate) mod newton;
pub(crate) mod newton_stage;
pub(crate) mod outwards;
pub(crate) mod reach;
pub(crate) mod shape;
pub(crate) mod tangent;
pub(crate) mod tangent_own_weight;
pub(crate) mod unloaded;
