//! Equilibrium of the platforms of a mechanism: every limb condensed to what it answers at its end, the platforms
//! solved, the limbs following. One such step is one Newton step of the flattened system.
//!
//! Takes commands, loads and a share of them, gives wrenches, coordinates and poses after a step, and the tangent.
//!
//! ```text
//! [ 0    J_i  ] [ F_i ]   [ T_i dP - closure ]
//! [ J_i^T H-K ] [ x_i ] = [ torques          ]                            limb i by the motion dP of its platforms
//! sum T_i^T F_i(dP) = W                                                   [R 5.28 corrected, 6.21-6.30]
//! ```

pub(crate) mod chain;
pub(crate) mod limb;
pub(crate) mod newton;
pub(crate) mod parts;
pub(crate) mod solver;
pub(crate) mod step;
