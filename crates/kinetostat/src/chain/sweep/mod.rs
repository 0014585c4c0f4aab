//! The linear system of a long chain, eliminated stage by stage: cost and memory grow with the number of coordinates
//! and no faster.

pub(crate) mod end_spring;
pub(crate) mod factor;
pub(crate) mod solve;
pub(crate) mod stages;
