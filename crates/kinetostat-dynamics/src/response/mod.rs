//! Responses to harmonic forces: by the sum of modes with residual flexibility, directly, and by limbs.

pub(crate) mod coupled;
pub(crate) mod direct;
pub(crate) mod modal;

use nalgebra::{Complex, Matrix6};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// 6 x 6: motion (m, rad) of one point by force and moment (N, N m) on another, base axes.
pub type Receptance = Matrix6<Complex<f64>>;

/// Motion that a response describes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, JsonSchema, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Quantity {
    /// Displacement: receptance, m/N.
    #[default]
    Displacement,
    /// Velocity: mobility, m/(N s).
    Velocity,
    /// Acceleration: accelerance, 1/kg. What accelerometers measure.
    Acceleration,
}

impl Quantity {
    /// Factor from a displacement to this quantity at `w` (rad/s).
    #[must_use]
    pub fn factor(self, w: f64) -> Complex<f64> {
        match self {
            Self::Displacement => Complex::new(1.0, 0.0),
            Self::Velocity => Complex::new(0.0, w),
            Self::Acceleration => Complex::new(-w * w, 0.0),
        }
    }
}
