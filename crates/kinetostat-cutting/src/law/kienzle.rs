//! Kienzle's law, `f = k_11 h^(1 - m)` [R 2.2], and the report's estimate for the worst case [R 2.4], [R Table 2.3].

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::error::{CutErrorKind, Result, within};
use crate::law::force_law::{EdgeForce, ForceLaw};

/// `f = k_11 h^(1 - m)`: the thinner the chip, the more each mm^2 of it costs [R 2.2].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Kienzle {
    /// `k_11`, specific force of a chip of 1 mm by 1 mm: tangential (`k_c1.1`), radial, axial, N/mm^2.
    pub specific_n_per_mm2: [f64; 3],
    /// `m`: tangential (`m_c`), radial, axial.
    pub exponent: [f64; 3],
}

impl Kienzle {
    /// Coefficients `k_11` (N/mm^2) and exponents `m`, each tangential, radial and axial.
    ///
    /// ```
    /// use kinetostat_cutting::{ForceLaw, Kienzle};
    ///
    /// let law = Kienzle::new([780.0, 300.0, 120.0], [0.23, 0.4, 0.3])?;
    /// assert!((law.edge_force(1.0).tangential - 780.0).abs() < 1e-9); // N/mm
    /// assert!((law.specific_n_per_mm2(0.2) - 1129.4).abs() < 0.1); // k_c [R 2.2]
    /// # Ok::<(), kinetostat_cutting::CutError>(())
    /// ```
    ///
    /// # Errors
    /// A specific force that no material has, exponents outside 0 to 0.95.
    pub fn new(specific: [f64; 3], exponent: [f64; 3]) -> Result<Self> {
        let law = Self {
            specific_n_per_mm2: specific,
            exponent,
        };
        law.checked()
    }

    /// Specific force `k_c = k_c1.1 h^-m_c`, N/mm^2, with a chip of this thickness, mm [R 2.2].
    #[must_use]
    pub fn specific_n_per_mm2(&self, chip_mm: f64) -> f64 {
        self.specific_n_per_mm2[0] * chip_mm.powf(-self.exponent[0])
    }

    pub(crate) fn checked(self) -> Result<Self> {
        let material = CutErrorKind::Material;
        let names = ["tangential", "radial", "axial"];
        for (i, name) in names.iter().enumerate() {
            let (k, m) = (self.specific_n_per_mm2[i], self.exponent[i]);
            let least = if i == 0 { 1.0 } else { -1e5 };
            within(
                material,
                &format!("{name} specific force"),
                k,
                least..=1e5,
                "N/mm2",
            )?;
            within(material, &format!("{name} exponent"), m, 0.0..=0.95, "")?;
        }
        Ok(self)
    }
}

impl ForceLaw for Kienzle {
    #[inline]
    fn edge_force(&self, chip_mm: f64) -> EdgeForce {
        let log = chip_mm.ln();
        let (k, m) = (self.specific_n_per_mm2, self.exponent);
        let force = |i: usize| k[i] * ((1.0 - m[i]) * log).exp();
        let tangential = force(0);
        EdgeForce::new(tangential, force(1), force(2))
    }
}

/// Largest force `F = 2 k_c b h v_c^-0.07`, N; thickness and width of the chip in mm, cutting speed in m/min.
///
/// Differs from [R 2.4], which leaves the speed out (erratum): all cells of Table 2.3 follow from this, with the speed of
/// [R Table 2.1] above 100 m/min and a factor of 2 for everything else.
///
/// ```
/// use kinetostat_cutting::{Kienzle, largest_force};
///
/// let monel = Kienzle::new([2600.0, 0.0, 0.0], [0.19, 0.0, 0.0])?;
/// let force = largest_force(&monel, 0.2, 8.0, 1000.0);
/// assert!((force - 6965.1043).abs() < 1e-4); // N
/// # Ok::<(), kinetostat_cutting::CutError>(())
/// ```
#[must_use]
pub fn largest_force(material: &Kienzle, chip_mm: f64, width_mm: f64, speed_m_per_min: f64) -> f64 {
    force_as_printed(material, chip_mm, width_mm) * speed_m_per_min.powf(-0.07)
}

/// `F = 2 k_c b h` as printed [R 2.4], N: what its table does not follow (erratum).
#[must_use]
pub fn force_as_printed(material: &Kienzle, chip_mm: f64, width_mm: f64) -> f64 {
    2.0 * material.specific_n_per_mm2(chip_mm) * width_mm * chip_mm
}
