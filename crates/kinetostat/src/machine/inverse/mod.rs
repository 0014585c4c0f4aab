//! Inverse kinematics from nominal geometry with springs at rest: of one limb, and of a graph of platforms.
//!
//! Takes poses of the ends, gives commands and passive joints, or the nearest pose that was found.
//!
//! ```text
//! dq = J^T (J J^T + damping)^-1 dx                                        least motion (Levenberg, Marquardt)
//! ```

pub(crate) mod graph;
pub(crate) mod limb;
pub(crate) mod nearest;
