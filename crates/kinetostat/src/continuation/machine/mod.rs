//! Curves of a machine by the motions of its tool, everything else condensed; where its tool goes under a load.
//!
//! Takes a posture with what holds and loads its tool. `tool_*` are equilibria and steps one by one; on them stand
//! `free_motion`, `growing_load` and `relaxation`, which find the equilibrium where Newton does not [R 6.28-6.30]; on
//! these `displacement_curve` and [`curves`] [R 5.5.3, Table 5.3].

pub(crate) mod curves;
pub(crate) mod displacement_curve;
pub(crate) mod free_motion;
pub(crate) mod growing_load;
pub(crate) mod relaxation;
pub(crate) mod system;
pub(crate) mod tool_conditions;
pub(crate) mod tool_stability;
pub(crate) mod tool_steps;
