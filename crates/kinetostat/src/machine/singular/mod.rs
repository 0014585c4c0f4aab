//! How far a posture is from a singular one, and where: motions that are lost, and motions that nothing holds any more
//! [R 5.5.3].

pub(crate) mod lost_motion;
pub(crate) mod near;
