//! Data of joints: kinds, springs with two stiffnesses, damping, and rotors of drives.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Kind of a joint of one degree of freedom.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum JointKind {
    /// Slides along its axis.
    Prismatic,
    /// Turns about its axis.
    Revolute,
}

/// Motions that a passive joint leaves free.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum PassiveKind {
    /// Slides along its axis.
    Prismatic,
    /// Turns about its axis.
    Revolute,
    /// Turns about its first axis, then about its second.
    Universal,
    /// Turns about x, then y, then z.
    Spherical,
}

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

/// Damping of all vibrations of the machine: one of `ratio`, `ratios`, `rayleigh` and `loss_factor`. Dampers of single
/// joints and springs are written there instead.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DampingTable {
    /// Ratio to critical damping of all modes: 0.03 is 3 %.
    pub ratio: Option<f64>,
    /// Ratios to critical damping of the lowest modes, the last for all above.
    #[schemars(length(min = 1, max = 1000))]
    pub ratios: Option<Vec<f64>>,
    /// Shares of mass and stiffness.
    pub rayleigh: Option<RayleighTable>,
    /// Loss factor of all springs: a force that goes with the deflection, a quarter of a period late.
    pub loss_factor: Option<f64>,
    /// Source of the figures.
    pub source: Option<String>,
    /// Assumption behind the figures.
    pub assumption: Option<String>,
}

/// Damping as a share of the mass and one of the stiffness.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RayleighTable {
    /// Times the mass, 1/s.
    pub mass_per_s: f64,
    /// Times the stiffness of the springs, s.
    pub stiffness_s: f64,
}

/// The rotor of a drive's motor, before the transmission. Its servo holds it: that stiffness and the one of the transmission
/// in series are the stiffness of the drive.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RotorTable {
    /// Inertia of the rotor about its own axis, with what turns with it, kg m^2.
    pub inertia_kg_m2: f64,
    /// Turns of the rotor for one turn of the joint.
    pub ratio: Option<f64>,
    /// Travel of a sliding joint per turn of the rotor, mm.
    pub lead_mm_per_turn: Option<f64>,
    /// Travel of a sliding joint per turn of the rotor, m.
    pub lead_m_per_turn: Option<f64>,
    /// Stiffness of the servo along a sliding joint, N/m.
    pub servo_stiffness_n_per_m: Option<f64>,
    /// Stiffness of the servo along a sliding joint, N/mm.
    pub servo_stiffness_n_per_mm: Option<f64>,
    /// Stiffness of the servo about a turning joint, as the joint feels it, N m/rad.
    pub servo_stiffness_n_m_per_rad: Option<f64>,
    /// Stiffness of the servo about a turning joint, as the joint feels it, N mm/rad.
    pub servo_stiffness_n_mm_per_rad: Option<f64>,
    /// Source of the figures.
    pub source: Option<String>,
    /// Assumption behind the figures.
    pub assumption: Option<String>,
}
