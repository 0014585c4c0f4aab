//! The linear law with a force of the edge, `f = K_c h + K_e`, and the exponential law, whose force of the edge comes with the
//! chip, `f = K_c h + K_e (1 - exp(-h/h_e))`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::error::{CutErrorKind, Result, within};
use crate::law::force_law::{EdgeForce, ForceLaw};

/// `f = K_c h + K_e`: the chip costs its thickness, and the edge rubs with any chip.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Linear {
    /// `K_c`: tangential, radial, axial, N/mm^2.
    pub cutting_n_per_mm2: [f64; 3],
    /// `K_e`: tangential, radial, axial, N/mm.
    pub edge_n_per_mm: [f64; 3],
}

impl Linear {
    /// Coefficients `K_c` (N/mm^2) and `K_e` (N/mm), each tangential, radial and axial.
    ///
    /// ```
    /// use kinetostat_cutting::{ForceLaw, Linear};
    ///
    /// let aluminium = Linear::new([796.0, 168.0, 222.0], [27.7, 30.8, 1.4])?;
    /// assert!((aluminium.edge_force(0.1).tangential - 107.3).abs() < 1e-9); // N/mm
    /// # Ok::<(), kinetostat_cutting::CutError>(())
    /// ```
    ///
    /// # Errors
    /// A tangential coefficient that is negative; any that no material has.
    pub fn new(cutting: [f64; 3], edge: [f64; 3]) -> Result<Self> {
        let law = Self {
            cutting_n_per_mm2: cutting,
            edge_n_per_mm: edge,
        };
        law.checked()
    }

    pub(crate) fn checked(self) -> Result<Self> {
        let material = CutErrorKind::Material;
        let of = self.cutting_n_per_mm2;
        within(
            material,
            "tangential cutting coefficient",
            of[0],
            1.0..=1e5,
            "N/mm2",
        )?;
        within(
            material,
            "radial cutting coefficient",
            of[1],
            -1e5..=1e5,
            "N/mm2",
        )?;
        within(
            material,
            "axial cutting coefficient",
            of[2],
            -1e5..=1e5,
            "N/mm2",
        )?;
        let of = self.edge_n_per_mm;
        within(
            material,
            "tangential edge coefficient",
            of[0],
            0.0..=1e4,
            "N/mm",
        )?;
        within(
            material,
            "radial edge coefficient",
            of[1],
            -1e4..=1e4,
            "N/mm",
        )?;
        within(
            material,
            "axial edge coefficient",
            of[2],
            -1e4..=1e4,
            "N/mm",
        )?;
        Ok(self)
    }
}

impl ForceLaw for Linear {
    #[inline]
    fn edge_force(&self, chip_mm: f64) -> EdgeForce {
        EdgeForce::from(self.cutting_n_per_mm2) * chip_mm + EdgeForce::from(self.edge_n_per_mm)
    }
}

/// `f = K_c h + K_e (1 - exp(-h/h_e))`: the linear law for thick chips, and no force without a chip (Endres and Loo, "Modeling
/// cutting process nonlinearity for stability analysis", 2002).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Exponential {
    /// `K_c`: tangential, radial, axial, N/mm^2.
    pub cutting_n_per_mm2: [f64; 3],
    /// `K_e`: tangential, radial, axial, N/mm.
    pub edge_n_per_mm: [f64; 3],
    /// `h_e`, thickness at which 63 % of the edge's force is there, mm: about the radius of the edge.
    pub edge_thickness_mm: f64,
}

impl Exponential {
    /// Coefficients of the linear law, and the thickness (mm) over which the force of the edge comes.
    ///
    /// ```
    /// use kinetostat_cutting::{Exponential, ForceLaw};
    ///
    /// let law = Exponential::new([796.0, 168.0, 222.0], [27.7, 30.8, 1.4], 0.01)?;
    /// assert!(law.edge_force(1e-9).tangential < 1e-5);
    /// assert!((law.edge_force(0.2).tangential - 186.9).abs() < 1e-6);
    /// # Ok::<(), kinetostat_cutting::CutError>(())
    /// ```
    ///
    /// # Errors
    /// As [`Linear::new`]; a thickness outside 0.0001 to 1 mm.
    pub fn new(cutting: [f64; 3], edge: [f64; 3], edge_thickness_mm: f64) -> Result<Self> {
        let law = Self {
            cutting_n_per_mm2: cutting,
            edge_n_per_mm: edge,
            edge_thickness_mm,
        };
        law.checked()
    }

    pub(crate) fn checked(self) -> Result<Self> {
        Linear::new(self.cutting_n_per_mm2, self.edge_n_per_mm)?;
        let thickness = self.edge_thickness_mm;
        within(
            CutErrorKind::Material,
            "edge thickness",
            thickness,
            1e-4..=1.0,
            "mm",
        )?;
        Ok(self)
    }
}

impl ForceLaw for Exponential {
    #[inline]
    fn edge_force(&self, chip_mm: f64) -> EdgeForce {
        let share = -(-chip_mm / self.edge_thickness_mm).exp_m1();
        EdgeForce::from(self.cutting_n_per_mm2) * chip_mm
            + EdgeForce::from(self.edge_n_per_mm) * share
    }
}
