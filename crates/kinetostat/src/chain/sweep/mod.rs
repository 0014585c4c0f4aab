//! The linear system of a long chain, eliminated stage by stage: cost and memory grow with the number of coordinates
//! and no faster.
//!
//! Takes a chain at a state with its loads, gives the same answers as the dense matrices of `chain::system`: Newton's
//! step, stiffness at the end, stability.
//!
//! ```text
//! H_ij = s_i^T (G_j + A_j / 2) s_j for i beyond j, G_j and A_j sums over what lies beyond j    [R 4.21]
//! stage by stage from the tip: three 6 x 6 matrices carry all that lies beyond
//! ```

pub(crate) mod factor;
pub(crate) mod solve;
pub(crate) mod stages;
