//! An actuator as a chain is told of it.

use nalgebra::Vector3;

use crate::spatial::MotionKind;

/// An actuator as the builder takes it.
#[derive(Clone, Debug, PartialEq)]
pub struct ActuatorSpec {
    /// Prismatic or revolute.
    pub kind: MotionKind,
    /// Axis in the local frame; need not be normalised.
    pub axis: Vector3<f64>,
    /// Stiffness of the drive (N/m or N m/rad); `None` is a rigid drive.
    pub stiffness: Option<f64>,
    /// Deflection at rest, `theta0` (m or rad).
    pub rest: f64,
    /// Command from which inverse kinematics starts (m or rad).
    pub home: f64,
    /// Limits of the command (m or rad).
    pub limits: Option<(f64, f64)>,
}

impl ActuatorSpec {
    /// An actuator with an elastic drive, at home at zero, without limits.
    #[must_use]
    pub fn new(kind: MotionKind, axis: Vector3<f64>, stiffness: f64) -> Self {
        Self {
            kind,
            axis,
            stiffness: Some(stiffness),
            rest: 0.0,
            home: 0.0,
            limits: None,
        }
    }
}
