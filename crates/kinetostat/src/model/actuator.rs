//! Description of an actuator: its motion, its stiffness, home and limits.

use nalgebra::Vector3;
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

use crate::spatial::MotionKind;

/// An actuator as the builder takes it.
///
/// # Examples
///
/// ```
/// # use kinetostat::nalgebra::{Vector3, vector};
/// # use kinetostat::*;
/// let elastic = ActuatorSpec::new(MotionKind::Prismatic, vector![0.0, 3.0, 4.0], 2e6); // along (0, 3, 4), N/m
/// let rigid = ActuatorSpec { stiffness: None, ..elastic.clone() };
/// let preloaded = ActuatorSpec { rest: 1e-4, ..elastic.clone() }; // m
/// let load = Wrench::new(vector![70.0, 300.0, 400.0], Vector3::zeros()); // N, 500 N of it along the slide
/// for (drive, gone) in [(elastic, 500.0 / 2e6), (rigid, 0.0), (preloaded, 500.0 / 2e6 + 1e-4)] {
///     let slide = Chain::builder("slide").actuator("drive", drive).build()?;
///     let home = Pose::identity();
///     let machine = Mechanism::serial(slide, home, Vector3::zeros())?;
///     let moved = machine.posture(&home)?.deflected_by(&load)?.displacement.linear();
///     assert!((moved - vector![0.0, 0.6, 0.8] * gone).norm() < 1e-12);
/// }
/// # Ok::<(), Error>(())
/// ```
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
    /// The motor's rotor, for vibrations; statics do not ask for it.
    pub rotor: Option<DriveRotor>,
}

/// The rotor of a drive on its side of the transmission [D 1]: its servo holds it, and the transmission lies between it and the
/// joint. Vibrations alone know it.
///
/// ```
/// # use kinetostat::nalgebra::Vector3;
/// # use kinetostat::*;
/// use kinetostat::model::DriveRotor;
///
/// let rotor = DriveRotor { inertia: 1e-3, ratio: 100.0, servo_stiffness: 3e5 }; // kg m^2, 100 turns a turn, N m/rad
/// let mut drive = ActuatorSpec::new(MotionKind::Revolute, Vector3::z(), 1e5); // servo and gear in series
/// drive.rotor = Some(rotor);
/// let arm = Chain::builder("arm").actuator("joint", drive).build()?;
/// assert_eq!(arm.actuators()[0].rotor, Some(rotor));
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct DriveRotor {
    /// Inertia about its own axis, kg m^2.
    pub inertia: f64,
    /// Turns (rad) of the rotor by the motion of the joint: a ratio for a joint that turns, rad/m for a slide.
    pub ratio: f64,
    /// Stiffness of the servo as the joint sees it, N m/rad or N/m: more than that of the drive, which is servo and transmission
    /// in series.
    pub servo_stiffness: f64,
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
            rotor: None,
        }
    }
}
