//! Elastostatics of robots by virtual joint modelling.
//!
//! Dependencies between modules point one way:
//! `spatial, saddle <- chain <- kinematics <- loading <- equilibrium <- stiffness <- stability <-
//! mechanism <- posture <- compensation`.

mod beam;
mod builder;
mod chain;
mod compensation;
mod equilibrium;
mod error;
mod inverse;
mod kinematics;
mod loading;
mod mechanism;
mod platform;
mod posture;
mod saddle;
mod settings;
mod spatial;
mod spring;
mod stability;
mod stiffness;

pub use beam::BeamSection;
pub use builder::{ActuatorSpec, ChainBuilder};
pub use chain::{
    Actuator, Body, Chain, Coordinate, Drive, Element, Motion, MotionKind, Role, Scale,
};
pub use compensation::{Compensation, compensate, compensate_from, target_under_load};
pub use equilibrium::{
    ChainProblem, EndCondition, Equilibrium, Prescribed, Residual, solve_chain, unloaded_tip,
};
pub use error::{Error, Result};
pub use inverse::{LimbPosture, inverse_kinematics};
pub use kinematics::Kinematics;
pub use loading::{Load, NodeLoad, NodeTangent};
pub use mechanism::{Limb, Mechanism, MechanismBuilder, Platform};
pub use platform::MechanismState;
pub use posture::{
    LimbEquilibrium, LinearAssembly, MechanismEquilibrium, PlatformStability, Posture,
    UnloadedStiffness,
};
pub use saddle::Inertia;
pub use settings::Settings;
pub use spatial::{
    CartesianStiffness, Pose, Twist, Wrench, hat, moved, pose_residual, shift_matrix, turn_matrix,
};
pub use spring::{ParallelogramLaw, SpringBlock, SpringLaw};
pub use stability::ShapeStability;
pub use stiffness::{ChainStiffness, Direction, DirectionKind, unloaded_stiffness};
