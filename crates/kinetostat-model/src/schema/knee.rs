//! A spring with two stiffnesses: what its table says beyond the first one.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Bilinear spring: knee, the same in both senses, and the stiffness beyond it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Knee {
    /// Deflection at which the stiffness changes, mm.
    pub at_mm: Option<f64>,
    /// Deflection at which the stiffness changes, m.
    pub at_m: Option<f64>,
    /// Deflection at which the stiffness changes, degrees.
    pub at_deg: Option<f64>,
    /// Deflection at which the stiffness changes, rad.
    pub at_rad: Option<f64>,
    /// Stiffness beyond, N/m.
    pub then_n_per_m: Option<f64>,
    /// Stiffness beyond, N/mm.
    pub then_n_per_mm: Option<f64>,
    /// Stiffness beyond, N m/rad.
    pub then_n_m_per_rad: Option<f64>,
    /// Stiffness beyond, N mm/rad.
    pub then_n_mm_per_rad: Option<f64>,
}
