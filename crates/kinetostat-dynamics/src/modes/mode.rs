//! A mode, and what it is.

use nalgebra::{DVector, Vector6};

/// Kind of a mode.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, schemars::JsonSchema, serde::Deserialize,
)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum ModeKind {
    /// Vibration about the equilibrium.
    Vibration,
    /// Nothing holds it: mass without stiffness. Its frequency is zero within rounding.
    Free,
    /// Negative stiffness: the motion diverges. Its frequency is written with a minus sign.
    Unstable,
}

/// A mode of vibration.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Mode {
    /// `w^2`, (rad/s)^2; negative where the equilibrium is unstable. Zero exactly for a free direction.
    pub squared: f64,
    /// Kind of the mode.
    pub kind: ModeKind,
    /// Shape by the independent coordinates, normalised by mass: `phi^T M phi = 1`.
    pub shape: DVector<f64>,
    /// Motion of the tool in it, base axes at the tool's origin: m and rad, in units of `1 / sqrt(kg)`.
    pub tool: Vector6<f64>,
}

impl Mode {
    /// Frequency, Hz; `-sqrt(-w^2) / 2 pi` of an unstable one.
    #[must_use]
    pub fn frequency_hz(&self) -> f64 {
        self.squared.abs().sqrt().copysign(self.squared) / std::f64::consts::TAU
    }
}
