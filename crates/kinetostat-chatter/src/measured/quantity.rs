//! What was measured, and in which unit.

use serde::{Deserialize, Serialize};

/// The motion that a response is by a force of 1 N.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Motion {
    /// Displacement, m/N: receptance.
    Displacement,
    /// Velocity, m/(s N): mobility.
    Velocity,
    /// Acceleration, m/(s^2 N): accelerance.
    Acceleration,
}

impl Motion {
    /// How often a displacement is differentiated for it.
    pub(crate) fn order(self) -> i32 {
        match self {
            Self::Displacement => 0,
            Self::Velocity => 1,
            Self::Acceleration => 2,
        }
    }
}

/// Standard gravity, m/s^2: `g` as a unit.
const GRAVITY: f64 = 9.80665;

/// A unit of motion by its usual spellings, with its size in SI.
pub(crate) fn motion_unit(text: &str) -> Option<(Motion, f64)> {
    let plain: String = text
        .trim()
        .to_lowercase()
        .replace(['^', '*', ' '], "")
        .replace('\u{b2}', "2")
        .replace('\u{b5}', "u");
    Some(match plain.as_str() {
        "m" => (Motion::Displacement, 1.0),
        "mm" => (Motion::Displacement, 1e-3),
        "um" => (Motion::Displacement, 1e-6),
        "m/s" => (Motion::Velocity, 1.0),
        "mm/s" => (Motion::Velocity, 1e-3),
        "m/s2" | "m/sec2" | "m/s/s" => (Motion::Acceleration, 1.0),
        "mm/s2" => (Motion::Acceleration, 1e-3),
        "g" => (Motion::Acceleration, GRAVITY),
        _ => return None,
    })
}

/// A unit of force, with its size in SI.
pub(crate) fn force_unit(text: &str) -> Option<f64> {
    Some(match text.trim().to_lowercase().as_str() {
        "n" => 1.0,
        "mn" => 1e-3,
        "kn" => 1e3,
        "lbf" => 4.448_221_615_260_5,
        _ => return None,
    })
}
