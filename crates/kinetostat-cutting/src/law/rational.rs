//! The rational law of the report: `f = (a_1 h + a_2 h^2)/(1 + a_3 h)` [R 2.3].

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::error::{CutErrorKind, Result, within};
use crate::law::force_law::{EdgeForce, ForceLaw};

/// `f = (a_1 h + a_2 h^2)/(1 + a_3 h)` per length of edge [R 2.3]: of slope `a_1` for thin chips and `a_2/a_3` for thick ones.
///
/// The report calls it fractal; it is a rational (fractional) expression (errata of notation).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rational {
    /// `a_1`: tangential, radial, axial, N/mm^2.
    pub a_1_n_per_mm2: [f64; 3],
    /// `a_2`: tangential, radial, axial, N/mm^3.
    pub a_2_n_per_mm3: [f64; 3],
    /// `a_3`: tangential, radial, axial, 1/mm, not negative.
    pub a_3_per_mm: [f64; 3],
}

impl Rational {
    /// Coefficients `a_1` (N/mm^2), `a_2` (N/mm^3) and `a_3` (1/mm), each tangential, radial and axial.
    ///
    /// ```
    /// use kinetostat_cutting::{ForceLaw, Rational};
    ///
    /// let law = Rational::new([2000.0; 3], [1.0e5; 3], [100.0; 3])?;
    /// assert!((law.edge_force(0.1).tangential - 1200.0 / 11.0).abs() < 1e-9); // (200 + 1000)/11 N/mm
    /// # Ok::<(), kinetostat_cutting::CutError>(())
    /// ```
    ///
    /// # Errors
    /// A tangential force that could be negative, a pole (`a_3` below zero), coefficients that no material has.
    pub fn new(a_1: [f64; 3], a_2: [f64; 3], a_3: [f64; 3]) -> Result<Self> {
        let law = Self {
            a_1_n_per_mm2: a_1,
            a_2_n_per_mm3: a_2,
            a_3_per_mm: a_3,
        };
        law.checked()
    }

    pub(crate) fn checked(self) -> Result<Self> {
        let material = CutErrorKind::Material;
        for i in 0..3 {
            let least = if i == 0 { 0.0 } else { -1e6 };
            within(material, "a_1", self.a_1_n_per_mm2[i], least..=1e6, "N/mm2")?;
            within(
                material,
                "a_2",
                self.a_2_n_per_mm3[i],
                100.0 * least..=1e8,
                "N/mm3",
            )?;
            within(material, "a_3", self.a_3_per_mm[i], 0.0..=1e5, "1/mm")?;
        }
        Ok(self)
    }
}

impl ForceLaw for Rational {
    #[inline]
    fn edge_force(&self, chip_mm: f64) -> EdgeForce {
        let force = |i: usize| {
            (self.a_1_n_per_mm2[i] + self.a_2_n_per_mm3[i] * chip_mm) * chip_mm
                / (1.0 + self.a_3_per_mm[i] * chip_mm)
        };
        EdgeForce::new(force(0), force(1), force(2))
    }
}
