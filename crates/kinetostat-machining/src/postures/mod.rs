//! Many postures of one machine under load.
//!
//! Takes poses and wrenches; gives where the tool goes, or what to command, all at once where starting from home leads to
//! the branch of a search from neighbour to neighbour, and by that search elsewhere. Knows nothing of programs.

pub(crate) mod arm_course;
pub(crate) mod configurations;
pub(crate) mod neighbour;
