//! Chapter 3: stiffness of links with passive joints, and of the Stewart-Gough platform.

pub(crate) mod passive_joints;
pub(crate) mod stewart_gough;
