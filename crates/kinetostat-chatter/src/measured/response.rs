//! One measured curve: motion at a place by a force at another, over the frequency, with its units.

use std::f64::consts::TAU;

use nalgebra::Complex;
use serde::{Deserialize, Serialize};

use crate::error::{ChatterError, ChatterErrorKind, Result};
use crate::number::Complex64;
use crate::response::ToolResponse;

/// A measured frequency response by a force of 1 N, in SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredResponse {
    /// Place and direction of the measurement, in the words of its file.
    pub name: String,
    /// Number of the place that moves.
    pub response_node: i64,
    /// Direction of the motion: 1, 2, 3 for x, y, z, negative against it; 0 where it is not stated.
    pub response_direction: i32,
    /// Number of the place of the force.
    pub reference_node: i64,
    /// Direction of the force, as that of the motion.
    pub reference_direction: i32,
    /// Measured motion.
    pub motion: Motion,
    /// Frequencies, Hz, rising.
    pub frequencies_hz: Vec<f64>,
    /// Motion by force at each: m, m/s or m/s^2 by N.
    pub values: Vec<Complex<f64>>,
    /// True if the file states its units; otherwise SI units are assumed.
    pub units_stated: bool,
}

impl MeasuredResponse {
    /// The curve that a model of a tool has, as if it were measured: direction `i` by force along `j`, of x, y, z from 0.
    ///
    /// # Errors
    /// A direction above 2.
    pub fn of_model(
        tool: &ToolResponse,
        i: usize,
        j: usize,
        frequencies_hz: &[f64],
    ) -> Result<Self> {
        if i > 2 || j > 2 {
            return Err(ChatterError::new(
                ChatterErrorKind::Setting,
                "direction",
                i.max(j),
                "0, 1 or 2 for x, y, z",
            ));
        }
        let axes = ["x", "y", "z"];
        let at = |frequency: &f64| tool.receptance(*frequency)[(i, j)];
        Ok(Self {
            name: format!("{} by force along {}", axes[i], axes[j]),
            response_node: 1,
            response_direction: i as i32 + 1,
            reference_node: 1,
            reference_direction: j as i32 + 1,
            motion: Motion::Displacement,
            frequencies_hz: frequencies_hz.to_vec(),
            values: frequencies_hz.iter().map(at).collect(),
            units_stated: true,
        })
    }

    /// Displacement by force at each frequency above 0, `(Hz, m/N)`: velocity and acceleration are divided by `i w` and its
    /// square.
    #[must_use]
    pub fn receptance(&self) -> Vec<(f64, Complex<f64>)> {
        let pairs = self.frequencies_hz.iter().zip(&self.values);
        pairs
            .filter(|(frequency, _)| **frequency > 0.0)
            .map(|(frequency, value)| {
                let rate = Complex64::new(0.0, TAU * frequency);
                (*frequency, value / rate.powi(self.motion.order()))
            })
            .collect()
    }

    /// Returns the response if its numbers are valid.
    pub(crate) fn checked(self, line: usize) -> Result<Self> {
        let fault = |quantity: &str, found: String, expected: &str| {
            let kind = ChatterErrorKind::File;
            Err(ChatterError::new(kind, quantity, found, expected).at_line(line))
        };
        if self.frequencies_hz.is_empty() {
            return fault("response", "no points".into(), "at least one");
        }
        let rising = self.frequencies_hz.windows(2).all(|pair| pair[1] > pair[0]);
        let first = self.frequencies_hz[0];
        if !rising
            || first.is_nan()
            || first < 0.0
            || !self.frequencies_hz.iter().all(|f| f.is_finite())
        {
            let found = format!("from {first} Hz, not rising or not finite");
            return fault("frequencies", found, "rising from 0 Hz or above");
        }
        let odd = self
            .values
            .iter()
            .position(|v| !(v.re.is_finite() && v.im.is_finite()));
        if let Some(at) = odd {
            let found = format!("no finite number at {} Hz", self.frequencies_hz[at]);
            return fault("response", found, "finite numbers");
        }
        Ok(self)
    }
}

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
