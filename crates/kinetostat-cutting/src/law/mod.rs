//! Laws of force: what a mm of edge bears with a chip of some thickness.
//!
//! Takes the thickness of the chip, gives force per length of edge along the tooth's way, along the outward normal of the
//! envelope and along the edge. `shared/theory/cutting.md`; [R 2.2-2.4] with their errata.

mod correction;
mod force_law;
mod kienzle;
mod linear;
mod rational;

use std::sync::Arc;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::error::Result;

pub use correction::{Coolant, Corrected, Correction, CuttingMaterial, RakeReference};
pub use force_law::{EdgeForce, ForceLaw};
pub use kienzle::{Kienzle, force_as_printed, largest_force};
pub use linear::{Exponential, Linear};
pub use rational::Rational;

/// A law with its coefficients.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Law {
    /// `f = K_c h + K_e`.
    Linear(Linear),
    /// `f = k_11 h^(1 - m)` [R 2.2].
    Kienzle(Kienzle),
    /// `f = K_c h + K_e (1 - exp(-h/h_e))`.
    Exponential(Exponential),
    /// `f = (a_1 h + a_2 h^2)/(1 + a_3 h)` [R 2.3].
    Rational(Rational),
}

impl Law {
    /// Returns the law if a material can have its coefficients.
    ///
    /// # Errors
    /// Names the implausible coefficient.
    pub fn checked(self) -> Result<Self> {
        match self {
            Self::Linear(law) => law.checked().map(Self::Linear),
            Self::Kienzle(law) => law.checked().map(Self::Kienzle),
            Self::Exponential(law) => law.checked().map(Self::Exponential),
            Self::Rational(law) => law.checked().map(Self::Rational),
        }
    }

    /// Reverses the axial part of the law.
    pub(crate) fn with_axial_turned(mut self) -> Self {
        let (force, edge) = match &mut self {
            Self::Linear(law) => (&mut law.cutting_n_per_mm2, Some(&mut law.edge_n_per_mm)),
            Self::Kienzle(law) => (&mut law.specific_n_per_mm2, None),
            Self::Exponential(law) => (&mut law.cutting_n_per_mm2, Some(&mut law.edge_n_per_mm)),
            Self::Rational(law) => (&mut law.a_1_n_per_mm2, Some(&mut law.a_2_n_per_mm3)),
        };
        force[2] = -force[2];
        if let Some(edge) = edge {
            edge[2] = -edge[2];
        }
        self
    }

    /// Name and formula of the law.
    #[must_use]
    pub fn description(&self) -> &'static str {
        match self {
            Self::Linear(_) => "linear law with edge force, f = K_c h + K_e",
            Self::Kienzle(_) => "Kienzle's law, f = k_11 h^(1 - m)",
            Self::Exponential(_) => "exponential law, f = K_c h + K_e (1 - exp(-h/h_e))",
            Self::Rational(_) => "rational law, f = (a_1 h + a_2 h^2)/(1 + a_3 h)",
        }
    }
}

impl ForceLaw for Law {
    #[inline]
    fn edge_force(&self, chip_mm: f64) -> EdgeForce {
        match self {
            Self::Linear(law) => law.edge_force(chip_mm),
            Self::Kienzle(law) => law.edge_force(chip_mm),
            Self::Exponential(law) => law.edge_force(chip_mm),
            Self::Rational(law) => law.edge_force(chip_mm),
        }
    }
}

/// A law with its tangential, radial and axial parts multiplied by factors.
///
/// ```
/// use std::sync::Arc;
/// use kinetostat_cutting::{EdgeForce, ForceLaw, Linear, Scaled};
///
/// let law = Linear::new([800.0, 300.0, 100.0], [10.0, 5.0, 0.0])?;
/// let stronger = Scaled::new(Arc::new(law), EdgeForce::new(1.1, 1.0, 1.0));
/// assert!((stronger.edge_force(0.1).tangential - 1.1 * 90.0).abs() < 1e-9);
/// # Ok::<(), kinetostat_cutting::CutError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Scaled {
    law: Arc<dyn ForceLaw>,
    factors: EdgeForce,
}

impl Scaled {
    /// A law and a factor for each part of its force.
    #[must_use]
    pub fn new(law: Arc<dyn ForceLaw>, factors: EdgeForce) -> Self {
        Self { law, factors }
    }
}

impl ForceLaw for Scaled {
    fn edge_force(&self, chip_mm: f64) -> EdgeForce {
        let own = self.law.edge_force(chip_mm);
        EdgeForce {
            tangential: own.tangential * self.factors.tangential,
            radial: own.radial * self.factors.radial,
            axial: own.axial * self.factors.axial,
        }
    }

    fn known_between_mm(&self) -> Option<(f64, f64)> {
        self.law.known_between_mm()
    }
}
