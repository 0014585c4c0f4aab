//! Distance of a posture from singular ones: motions that are lost, and motions that nothing holds any more [R 5.5.3].
//!
//! Finds the singular postures near a posture: which motion, which limb, how far, in which direction.
//!
//! ```text
//! lost: a singular value of a limb's Jacobian falls to zero;  gained: one of the wrenches that the limbs carry
//! distance = value / |d value / d motion|, followed by Newton's steps to the posture itself
//! ```

pub(crate) mod lost_motion;
pub(crate) mod near;
