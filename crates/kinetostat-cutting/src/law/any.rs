//! Any of the laws of this crate, as a material's file names it.

use serde::{Deserialize, Serialize};

use crate::error::Result;
use crate::law::exponential::Exponential;
use crate::law::force_law::{EdgeForce, ForceLaw};
use crate::law::kienzle::Kienzle;
use crate::law::linear::Linear;
use crate::law::rational::Rational;

/// A law with its coefficients.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
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
