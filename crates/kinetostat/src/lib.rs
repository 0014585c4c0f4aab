//! Elastostatics of robots by virtual joint modelling.
//!
//! Dependencies between modules point one way:
//! `spatial, saddle <- chain <- kinematics <- loading <- equilibrium <- stiffness <- stability <-
//! mechanism <- posture <- compensation`.

mod beam;
mod builder;
mod chain;
mod error;
mod mechanism;
mod spatial;
mod spring;

pub use beam::BeamSection;
pub use builder::{ActuatorSpec, ChainBuilder};
pub use chain::{
    Actuator, Body, Chain, Coordinate, Drive, Element, Motion, MotionKind, Role, Scale,
};
pub use error::{Error, Result};
pub use mechanism::{Limb, Mechanism, MechanismBuilder, Platform};
pub use spatial::{
    CartesianStiffness, Pose, Twist, Wrench, hat, moved, pose_residual, shift_matrix, turn_matrix,
};
pub use spring::{ParallelogramLaw, SpringBlock, SpringLaw};
