//! A material of the library, and its law with the factors by which a cut differs from the test [R 2.1], [R Table 2.1].

use std::fmt;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::error::Result;
use crate::law::{
    Coolant, Corrected, Correction, CuttingMaterial, EdgeForce, ForceLaw, Law, RakeReference,
};
use crate::number::plain;

/// `K_PRO` for coefficients of turning tests, where none is given: the middle of 1.2 to 1.4 [R Table 2.1].
const PROCESS: f64 = 1.3;
/// Half of that range.
const PROCESS_SPREAD: f64 = 0.1;

/// A factor that was applied, and why.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct AppliedFactor {
    /// Symbol in the report, such as `K_PRO`.
    pub symbol: &'static str,
    /// Factor on the force.
    pub value: f64,
    /// Reason in words.
    pub reason: String,
}

impl fmt::Display for AppliedFactor {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(to, "{} = {:.3}: {}", self.symbol, self.value, self.reason)
    }
}

/// The law of a material for a cut, and what was done to it.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Applied {
    /// The law times the product of all factors.
    pub law: Corrected<Material>,
    /// Uncertainty of the force by that law: half width, as a share of the force. It is the root of the sum of squares
    /// of the material's own and, unless given, of that of `K_PRO`.
    pub spread: f64,
    /// The factors, in the order of the report; none where the coefficients hold as they are.
    pub factors: Vec<AppliedFactor>,
}

impl Material {
    /// The law for milling, with the factors of a correction [R 2.1] and those that the test demands.
    ///
    /// - Coefficients of turning tests take `K_PRO` = 1.3 unless the correction gives another: the report has 1.2 to 1.4 for
    ///   them [R Table 2.1], and this is the middle; the half width of 0.1 goes into the spread.
    /// - Their axial part is turned: an edge of turning is pushed back along itself, and a helix that lifts the chip presses the
    ///   chip towards the spindle, so that the tool is drawn to the part (oblique cutting, friction below 1).
    /// - `K_V` and `K_gamma` compare the cut with the test: where speed or rake of the test are known, the factor is divided
    ///   by its value there; else it is that of the table, which is 1 at about 100 m/min and at 7.5 degrees (cast iron 2.5).
    /// - The line of the rake factor is that of the material's group; `rake_reference` of the correction is not asked.
    ///
    /// ```
    /// use kinetostat_cutting::{Correction, ForceLaw, Materials};
    ///
    /// let materials = Materials::library();
    /// let worn = Correction { wear: Some(1.4), ..Correction::default() };
    /// let applied = materials.find("AlMg4.5Mn")?.for_milling(&worn)?;
    /// assert!((applied.law.factor - 1.3 * 1.4).abs() < 1e-12);
    /// assert!((applied.law.edge_force(1.0).tangential - 780.0 * 1.82).abs() < 1e-9); // N/mm
    /// let words: Vec<String> = applied.factors.iter().map(ToString::to_string).collect();
    /// assert!(words[0].starts_with("K_PRO = 1.300: milling with coefficients of turning tests"));
    /// # Ok::<(), kinetostat_cutting::CutError>(())
    /// ```
    ///
    /// # Errors
    /// A speed, rake or factor beyond what the table is made for.
    pub fn for_milling(&self, correction: &Correction) -> Result<Applied> {
        let correction = Correction {
            rake_reference: self.group.rake_reference(),
            ..*correction
        };
        // The factor of the cut, with all its bounds; the conditions of the test are divided out below.
        let mut factor = correction.factor()?;
        let mut factors = Vec::new();
        let mut spread = self.spread;
        match (correction.process, self.measured_in.process) {
            (Some(value), _) => factors.push(given("K_PRO", value, "process, as given")),
            (None, Process::Turning) => {
                factor *= PROCESS;
                spread = spread.hypot(PROCESS_SPREAD / PROCESS);
                let reason = "milling with coefficients of turning tests, the middle of 1.2 to 1.4; the helix draws the tool to the part (axial part below zero)";
                factors.push(given("K_PRO", PROCESS, reason));
            }
            (None, Process::Milling) => {}
        }
        if let Some(speed) = correction.cutting_speed_m_per_min {
            let of_test = self.measured_in.speed_m_per_min;
            let at_test = of_test.map_or(1.0, Correction::of_speed);
            factor /= at_test;
            factors.push(AppliedFactor {
                symbol: "K_V",
                value: Correction::of_speed(speed) / at_test,
                reason: match of_test {
                    Some(test) => format!("cutting speed of {} m/min, {test} m/min in the test", plain(speed)),
                    None => format!("cutting speed of {} m/min; that of the test is not known and taken as 100 m/min", plain(speed)),
                },
            });
        }
        if let Some(rake) = correction.rake_deg {
            let reference = correction.rake_reference;
            let of_test = self.measured_in.rake_deg;
            let at_test = of_test.map_or(1.0, |test| Correction::of_rake(test, reference));
            factor /= at_test;
            factors.push(AppliedFactor {
                symbol: "K_gamma",
                value: Correction::of_rake(rake, reference) / at_test,
                reason: match of_test {
                    Some(test) => format!("rake angle of {rake} degrees, {test} degrees in the test"),
                    None => format!("rake angle of {rake} degrees; that of the test is not known and taken as the table's"),
                },
            });
        }
        factors.extend(others(&correction)?);
        let mut law = self.clone();
        if self.measured_in.process == Process::Turning {
            law.law = law.law.with_axial_turned();
        }
        Ok(Applied {
            law: Corrected { law, factor },
            spread,
            factors,
        })
    }
}

fn given(symbol: &'static str, value: f64, reason: &str) -> AppliedFactor {
    AppliedFactor {
        symbol,
        value,
        reason: reason.to_owned(),
    }
}

/// The factors that do not depend on the material; each alone has the value that it has in the product.
fn others(correction: &Correction) -> Result<Vec<AppliedFactor>> {
    let alone = Correction::default();
    let edge = Correction {
        cutting_material: correction.cutting_material,
        ..alone
    };
    let coolant = Correction {
        coolant: correction.coolant,
        ..alone
    };
    let mut factors = Vec::new();
    let mut push = |symbol, value: f64, reason: &str| factors.push(given(symbol, value, reason));
    match correction.cutting_material {
        CuttingMaterial::Carbide => {}
        CuttingMaterial::HighSpeedSteel => push("K_CM", edge.factor()?, "edge of high-speed steel"),
        CuttingMaterial::Ceramic => push("K_CM", edge.factor()?, "edge of ceramic"),
    }
    if let Some(value) = correction.wear {
        push("K_TW", value, "wear of the edge, as given");
    }
    match correction.coolant {
        Coolant::Dry => {}
        Coolant::Emulsion => push("K_CL", coolant.factor()?, "cooled with emulsion"),
        Coolant::Oil => push("K_CL", coolant.factor()?, "cooled with oil"),
    }
    if let Some(value) = correction.workpiece_shape {
        push("K_WS", value, "shape of the workpiece, as given");
    }
    Ok(factors)
}

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
