//! Curves of a chain: all of its coordinates and reactions, and the parameter, are unknowns [R 4.12-4.16].
//!
//! Takes a chain with its end condition and what grows, gives what [`crate::continuation::tracing`] needs: residual,
//! matrix, stability, an equilibrium with all of its numbers.
//!
//! ```text
//! G(x, f, lambda) = (g(x) - t(lambda), tau(x) + sum J_j^T G_j(lambda) + J^T f) = 0
//! ```

pub(crate) mod linearisation;
pub(crate) mod stability;
pub(crate) mod start;
pub(crate) mod system;
