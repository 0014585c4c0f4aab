//! Complex modes by a law of damping.

use crate::damping::Damping;
use crate::damping::pairs::{damped, ratio_of};
use crate::error::Result;
use crate::linear::LinearDynamics;
use crate::modes::Modes;
use crate::modes::complex::{ComplexModes, growing, modes_of};
use crate::modes::quadratic::Quadratic;

impl LinearDynamics {
    /// Complex modes with a law of damping, the lowest `count` of them, as [`Self::complex_modes`]; ratios are those of the
    /// complex pairs. Structural damping is left out: it is defined for a steady vibration, and of what grows or dies away
    /// it says nothing.
    ///
    /// # Errors
    /// As [`Self::complex_modes`] and [`Self::damping_matrix`].
    pub fn complex_modes_damped(
        &self,
        modes: &Modes,
        damping: &Damping,
        count: usize,
    ) -> Result<ComplexModes> {
        damping.check()?;
        let ratios = match damping {
            Damping::Undamped | Damping::Structural { .. } => {
                return self.complex_modes(None, count);
            }
            Damping::Ratio(ratio) => std::slice::from_ref(ratio),
            Damping::Ratios(list) => list,
            law => return self.complex_modes(Some(&self.damping_matrix(modes, law)?), count),
        };
        // Ratios couple no pairs: shapes stay, and each eigenvalue has its own damping.
        let pencil = Quadratic::of(self, None)?;
        let undamped = pencil.eigenvalues().ok_or_else(|| self.not_found())?;
        let all: Vec<_> = (undamped.iter().enumerate())
            .map(|(k, value)| damped(*value, ratio_of(ratios, k)))
            .collect();
        Ok(ComplexModes {
            count: all.len(),
            growing: growing(&all),
            verdict: self.verdict(&all),
            complexity: 0.0,
            modes: modes_of(&pencil, undamped.into_iter().zip(all), count),
        })
    }
}
