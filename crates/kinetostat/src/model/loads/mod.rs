//! Loads: which wrenches act on which nodes (or platforms) at given poses, how those change, and with which potential.
//!
//! A load on a limb is a [`NodeLoad`](crate::NodeLoad) [R 4.2, 4.22-4.23]; what touches two limbs acts on platforms
//! (`platform`). `check` compares every tangent with differences of its wrenches.
//!
//! Takes poses of nodes or platforms, gives wrenches (N, N m), tangents and potentials (J).
//!
//! ```text
//! dG_j = T_jk dp_k,  T = -d^2 V / dp^2 where the load has a potential V;  a law of length: f(l) along the line
//! ```

pub(crate) mod check;
pub(crate) mod follower;
pub(crate) mod function;
pub(crate) mod length_law;
pub(crate) mod load;
pub(crate) mod node_load;
pub(crate) mod platform;
pub(crate) mod strut;
