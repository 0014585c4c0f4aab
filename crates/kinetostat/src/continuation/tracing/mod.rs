//! A curve of equilibria followed step by step: predicted along the tangent, corrected across it; special points between
//! two steps, branches that leave there, jumps.
//!
//! Takes a system ([`system`]), gives branches and special points. Knows neither chains nor machines.

pub(crate) mod bifurcation;
pub(crate) mod branch_switching;
pub(crate) mod describe;
pub(crate) mod jumps;
pub(crate) mod segment;
pub(crate) mod special_points;
pub(crate) mod system;
pub(crate) mod tracer;
