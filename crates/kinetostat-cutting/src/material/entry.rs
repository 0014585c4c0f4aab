//! A material: what its file says of it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::law::{EdgeForce, ForceLaw, Law, RakeReference};

/// Family of materials.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Group {
    /// Aluminium and its alloys.
    Aluminium,
    /// Magnesium and its alloys.
    Magnesium,
    /// Copper, brass and bronze.
    Copper,
    /// Steel and cast steel that is not stainless.
    Steel,
    /// Stainless steel.
    Stainless,
    /// Grey, nodular and malleable cast iron.
    CastIron,
    /// Titanium and its alloys.
    Titanium,
    /// Nickel and its alloys.
    Nickel,
    /// Plastics, filled or not.
    Plastic,
    /// Wood and boards.
    Wood,
    /// Anything else.
    Other,
}

impl Group {
    /// Row of the rake factor of [R Table 2.1]: cast iron has its own, all others take that of steel.
    ///
    /// The report gives no line for other metals.
    #[must_use]
    pub fn rake_reference(self) -> RakeReference {
        match self {
            Self::CastIron => RakeReference::CastIron,
            _ => RakeReference::Steel,
        }
    }
}

/// The kind of test in which coefficients were measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Process {
    /// A lathe: one edge that never leaves the cut.
    Turning,
    /// A mill: teeth that enter and leave.
    Milling,
}

/// The test in which coefficients were measured.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MeasuredIn {
    /// Turning or milling.
    pub process: Process,
    /// Rake angle of the test, degrees, where it is known.
    #[serde(default)]
    pub rake_deg: Option<f64>,
    /// Cutting speed of the test, m/min, where it is known.
    #[serde(default)]
    pub speed_m_per_min: Option<f64>,
}

/// A material with its law of force, and how far that can be trusted.
///
/// It is a [`ForceLaw`]: that of the test, without correction ([`Material::for_milling`] has the factors).
///
/// ```
/// use kinetostat_cutting::{ForceLaw, Materials};
///
/// let materials = Materials::library();
/// let steel = materials.find("C 45")?;
/// assert!((steel.edge_force(1.0).tangential - 2085.0).abs() < 1e-9); // k_c1.1, N/mm
/// assert_eq!(steel.known_between_mm(), Some((0.113, 1.131)));
/// # Ok::<(), kinetostat_cutting::CutError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Material {
    /// Name of the material.
    pub name: String,
    /// Other designations of it.
    pub aliases: Vec<String>,
    /// Family of the material.
    pub group: Group,
    /// Force per length of edge as measured.
    pub law: Law,
    /// Spread of the force between batches, tools or tables: half width, as a share of the force.
    pub spread: f64,
    /// Source of the coefficients.
    pub source: String,
    /// Assumptions in place of measurements.
    pub assumptions: Vec<String>,
    /// The test.
    pub measured_in: MeasuredIn,
    /// Thicknesses of chip, mm, between which the law was measured.
    pub chip_mm: Option<(f64, f64)>,
    /// Cutting speeds, m/min, between which the law was measured.
    pub speed_m_per_min: Option<(f64, f64)>,
}

impl ForceLaw for Material {
    #[inline]
    fn edge_force(&self, chip_mm: f64) -> EdgeForce {
        self.law.edge_force(chip_mm)
    }

    fn known_between_mm(&self) -> Option<(f64, f64)> {
        self.chip_mm
    }
}
