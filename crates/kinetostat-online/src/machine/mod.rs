//! The machine in one cycle: from joints to the pose of the program, and from the wrench on the tool to the target that must be commanded.
//!
//! ```text
//! model      what never changes of a machine
//! joints     joints of the nominal chain that follow a target
//! limb       one limb under load: springs, passive joints, wrench                          [R 4.16]
//! forward    pose of the tool from commanded joints, of machines with loops
//! equilibrium  one pass: target, limbs, platform                                            [R 6.21-6.30, 7.7-7.13]
//! supported  what a plan accepts
//! ```

pub(crate) mod equilibrium;
pub(crate) mod forward;
pub(crate) mod joints;
pub(crate) mod limb;
pub(crate) mod model;
pub(crate) mod supported;
