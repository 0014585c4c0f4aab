//! Measured motions and their units.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The motion that a response is by a force of 1 N.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema, Deserialize)]
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
    /// Order of the time derivative of the displacement.
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

/// Feet and inches, m.
const FOOT: f64 = 0.3048;
const INCH: f64 = 0.0254;

/// A spelling without blanks, powers' signs and Greek letters.
fn plain(text: &str) -> String {
    text.trim()
        .to_lowercase()
        .replace(['^', '*', ' '], "")
        .replace('\u{b2}', "2")
        .replace(['\u{b5}', '\u{3bc}'], "u")
        .replace("sec", "s")
}

/// A unit of motion by its usual spellings, with its size in SI.
pub(crate) fn motion_unit(text: &str) -> Option<(Motion, f64)> {
    let plain = plain(text);
    let gravity = ["g", "gn", "g's", "gs"].contains(&plain.as_str());
    if gravity {
        return Some((Motion::Acceleration, GRAVITY));
    }
    let (length, motion) = match plain.split_once('/') {
        None => (plain.as_str(), Motion::Displacement),
        Some((length, "s")) => (length, Motion::Velocity),
        Some((length, "s2" | "s/s")) => (length, Motion::Acceleration),
        Some(_) => return None,
    };
    let size = match length {
        "m" => 1.0,
        "cm" => 1e-2,
        "mm" => 1e-3,
        "um" => 1e-6,
        "in" | "inch" => INCH,
        "ft" => FOOT,
        _ => return None,
    };
    Some((motion, size))
}

/// A unit of motion by force, as `mm/N`, with its size in SI.
pub(crate) fn response_unit(text: &str) -> Option<(Motion, f64)> {
    let plain = plain(text).replace(['(', ')'], "");
    let (moved, by) = plain.rsplit_once('/')?;
    let (motion, size) = motion_unit(moved)?;
    Some((motion, size / force_unit(by)?))
}

/// A unit of force, with its size in SI.
pub(crate) fn force_unit(text: &str) -> Option<f64> {
    Some(match text.trim().to_lowercase().as_str() {
        "n" => 1.0,
        "mn" => 1e-3,
        "kn" => 1e3,
        "lbf" | "lb" => 4.448_221_615_260_5,
        _ => return None,
    })
}

/// A unit of frequency, with its size in Hz.
pub(crate) fn frequency_unit(text: &str) -> Option<f64> {
    Some(match plain(text).as_str() {
        "hz" | "1/s" | "cycles/s" | "cps" => 1.0,
        "khz" => 1e3,
        "rad/s" => std::f64::consts::TAU.recip(),
        "rpm" | "1/min" => 1.0 / 60.0,
        _ => return None,
    })
}
