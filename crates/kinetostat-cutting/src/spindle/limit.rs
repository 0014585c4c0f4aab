//! Points of a curve, what there is at a speed, what a cut exceeds.

use std::f64::consts::TAU;
use std::fmt;

/// A point of a spindle's curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpindlePoint {
    /// Speed, rpm.
    pub speed_rpm: f64,
    /// Torque that the spindle gives there, N m.
    pub torque_n_m: f64,
}

impl SpindlePoint {
    /// A point given by its torque, N m.
    #[must_use]
    pub fn of_torque(speed_rpm: f64, torque_n_m: f64) -> Self {
        Self {
            speed_rpm,
            torque_n_m,
        }
    }

    /// A point given by its power, W; its speed must be above zero.
    ///
    /// ```
    /// use kinetostat_cutting::SpindlePoint;
    ///
    /// let point = SpindlePoint::of_power(9549.3, 5000.0);
    /// assert!((point.torque_n_m - 5.0).abs() < 1e-5);
    /// ```
    #[must_use]
    pub fn of_power(speed_rpm: f64, power_w: f64) -> Self {
        Self::of_torque(speed_rpm, power_w / turn_rate(speed_rpm))
    }
}

/// Limit of a spindle at a speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpindleLimit {
    /// Largest torque, N m.
    pub torque_n_m: f64,
    /// Largest power, W.
    pub power_w: f64,
}

/// Limit of a spindle that a cut exceeds.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum SpindleFinding {
    /// A speed above the largest, below zero or no number.
    Speed {
        /// Speed of the cut, rpm.
        speed_rpm: f64,
        /// Largest speed of the spindle, rpm.
        most_rpm: f64,
    },
    /// A torque, and with it a power, that the spindle does not have at this speed: it slows down or stops.
    Torque {
        /// Speed of the cut, rpm.
        speed_rpm: f64,
        /// Torque of the cut, N m.
        torque_n_m: f64,
        /// Available torque and power.
        limit: SpindleLimit,
    },
}

impl fmt::Display for SpindleFinding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Speed {
                speed_rpm,
                most_rpm,
            } => {
                write!(
                    f,
                    "the cut needs {speed_rpm} rpm, the spindle turns from 0 to {most_rpm} rpm"
                )
            }
            Self::Torque {
                speed_rpm,
                torque_n_m,
                limit,
            } => write!(
                f,
                "the cut needs {torque_n_m:.3} N m ({:.0} W) at {speed_rpm} rpm, the spindle gives {:.3} N m ({:.0} W)",
                torque_n_m * turn_rate(*speed_rpm),
                limit.torque_n_m,
                limit.power_w,
            ),
        }
    }
}

/// rad/s of rpm.
pub(crate) fn turn_rate(rpm: f64) -> f64 {
    TAU * rpm / 60.0
}
