//! Correction factors of [R 2.1], [R Table 2.1]: what makes the force another than that of the reference test.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::error::{CutErrorKind, Result, within};
use crate::law::force_law::{EdgeForce, ForceLaw};

/// Material of the edge [R Table 2.1].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, JsonSchema, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CuttingMaterial {
    /// High-speed steel: 1.05.
    HighSpeedSteel,
    /// Cemented carbide: 1.
    #[default]
    Carbide,
    /// Ceramic: 0.925, the middle of 0.9 to 0.95.
    Ceramic,
}

/// Coolant of the cut [R Table 2.1].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, JsonSchema, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Coolant {
    /// Dry: 1.
    #[default]
    Dry,
    /// Emulsion: 0.9.
    Emulsion,
    /// Oil, not soluble in water: 0.85.
    Oil,
}

/// Row of the rake factor [R Table 2.1].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, JsonSchema, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RakeReference {
    /// `1.09 - 0.012 rake` (degrees): steel and other long chips.
    #[default]
    Steel,
    /// `1.03 - 0.012 rake` (degrees): cast iron and other short chips.
    CastIron,
}

/// Factors by which a cut differs from the test in which the coefficients were measured [R 2.1], [R Table 2.1].
///
/// The default changes nothing: coefficients that were measured in milling hold as they are. Each field that is given
/// multiplies. The thickness of the chip is in the law itself.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, JsonSchema, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Correction {
    /// `K_PRO`: 1.2 to 1.4 for milling with coefficients of turning tests.
    pub process: Option<f64>,
    /// Cutting speed, m/min, for `K_V`.
    pub cutting_speed_m_per_min: Option<f64>,
    /// Rake angle, degrees, and to which line it belongs.
    pub rake_deg: Option<f64>,
    /// Row of the rake factor.
    pub rake_reference: RakeReference,
    /// `K_CM`.
    pub cutting_material: CuttingMaterial,
    /// `K_TW`: 1 for a sharp edge, 1.3 to 1.5 for a worn one.
    pub wear: Option<f64>,
    /// `K_CL`.
    pub coolant: Coolant,
    /// `K_WS`: 1 for turning outside, 1.2 for turning inside.
    pub workpiece_shape: Option<f64>,
}

impl Correction {
    /// `K_V` of a cutting speed in m/min: `2.023/v^0.153` up to 100, `1.380/v^0.07` above [R Table 2.1].
    ///
    /// The print leaves 100 m/min itself undefined; the branches differ there by 3e-4 (errata).
    ///
    /// ```
    /// use kinetostat_cutting::Correction;
    ///
    /// assert!((Correction::of_speed(100.0) - 1.0).abs() < 3e-5);
    /// assert!((Correction::of_speed(1000.0) - 0.8509).abs() < 1e-4);
    /// ```
    #[must_use]
    pub fn of_speed(m_per_min: f64) -> f64 {
        match m_per_min <= 100.0 {
            true => 2.023 / m_per_min.powf(0.153),
            false => 1.380 / m_per_min.powf(0.07),
        }
    }

    /// `K_gamma` of a rake angle in degrees [R Table 2.1].
    ///
    /// The slope of 0.012 per degree is as printed; 0.015 would fit the usual reference angles better (errata, not provable).
    #[must_use]
    pub fn of_rake(rake_deg: f64, reference: RakeReference) -> f64 {
        let at_zero = match reference {
            RakeReference::Steel => 1.09,
            RakeReference::CastIron => 1.03,
        };
        at_zero - 0.012 * rake_deg
    }

    /// The product of all factors.
    ///
    /// ```
    /// use kinetostat_cutting::{Coolant, Correction};
    ///
    /// assert_eq!(Correction::default().factor()?, 1.0);
    /// let worn = Correction { wear: Some(1.4), coolant: Coolant::Emulsion, ..Correction::default() };
    /// assert!((worn.factor()? - 1.26).abs() < 1e-12);
    /// # Ok::<(), kinetostat_cutting::CutError>(())
    /// ```
    ///
    /// # Errors
    /// A speed, rake or factor beyond what the table is made for.
    pub fn factor(&self) -> Result<f64> {
        let material = CutErrorKind::Material;
        let given = |name: &str, value: Option<f64>, least: f64, most: f64| {
            let of = |value| within(material, name, value, least..=most, "");
            value.map_or(Ok(1.0), of)
        };
        let mut factor = given("process factor", self.process, 0.5, 3.0)?
            * given("wear factor", self.wear, 0.5, 3.0)?
            * given("workpiece shape factor", self.workpiece_shape, 0.5, 3.0)?;
        if let Some(speed) = self.cutting_speed_m_per_min {
            within(material, "cutting speed", speed, 1.0..=1e4, "m/min")?;
            factor *= Self::of_speed(speed);
        }
        if let Some(rake) = self.rake_deg {
            within(material, "rake angle", rake, -30.0..=40.0, "deg")?;
            factor *= Self::of_rake(rake, self.rake_reference);
        }
        factor *= match self.cutting_material {
            CuttingMaterial::HighSpeedSteel => 1.05,
            CuttingMaterial::Carbide => 1.0,
            CuttingMaterial::Ceramic => 0.925,
        };
        factor *= match self.coolant {
            Coolant::Dry => 1.0,
            Coolant::Emulsion => 0.9,
            Coolant::Oil => 0.85,
        };
        Ok(factor)
    }
}

/// A law times a factor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corrected<L> {
    /// The law of the reference test.
    pub law: L,
    /// Factor of the law.
    pub factor: f64,
}

impl<L: ForceLaw> ForceLaw for Corrected<L> {
    #[inline]
    fn edge_force(&self, chip_mm: f64) -> EdgeForce {
        self.law.edge_force(chip_mm) * self.factor
    }

    fn known_between_mm(&self) -> Option<(f64, f64)> {
        self.law.known_between_mm()
    }
}
