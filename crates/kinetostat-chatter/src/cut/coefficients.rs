//! Force per area of chip.

use kinetostat_cutting::ForceLaw;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::error::{ChatterError, ChatterErrorKind, Result, above};

/// Slope of the force over the thickness of the chip, per depth, N/m^2.
///
/// The force **on the tool** is `-(Kt t + Kr n - Ka z) a h` with `t` along the tooth's way, `n` outward, `z` towards the
/// spindle. `Kr` and `Ka` are forces by area like `Kt`, not ratios to it. A positive `Ka` pushes the tool towards the spindle,
/// as in the material library ([`kinetostat_cutting::EdgeForce`], `cutting.md`), so that a helix that lifts the chip has a negative
/// one; (D 8) is written with the opposite sign.
///
/// ```
/// use kinetostat_chatter::Coefficients;
///
/// let by_area = Coefficients::new(8e8, 2.4e8, 0.0)?; // N/m^2
/// assert_eq!(by_area, Coefficients::with_ratios(8e8, 0.3, 0.0)?);
/// # Ok::<(), kinetostat_chatter::ChatterError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema, Deserialize)]
pub struct Coefficients {
    tangential: f64,
    radial: f64,
    axial: f64,
}

/// A law of force as a straight line near one thickness of chip.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Linearised {
    /// Slope of the law.
    pub coefficients: Coefficients,
    /// Thickness at which the slope was taken, m.
    pub chip: f64,
    /// True if the law was measured at this thickness; `None` if its range is unknown.
    pub within_measured: Option<bool>,
}

impl Coefficients {
    /// Tangential, radial and axial, all in N/m^2: `Kr` is already multiplied by `Kt`.
    ///
    /// # Errors
    /// A tangential one that is not positive, others that are not finite. A radial one between 0 and 5 in size, but not 0,
    /// beside a tangential one above 1e6 is taken for a ratio and refused: [`Self::with_ratios`] takes those.
    pub fn new(tangential: f64, radial: f64, axial: f64) -> Result<Self> {
        let kind = ChatterErrorKind::Cut;
        above(
            kind,
            "tangential coefficient",
            tangential,
            0.0,
            true,
            "N/m^2",
        )?;
        for (quantity, value) in [("radial coefficient", radial), ("axial coefficient", axial)] {
            if !value.is_finite() {
                let expected = "a finite number, N/m^2";
                return Err(ChatterError::new(kind, quantity, value, expected));
            }
            if value != 0.0 && value.abs() <= 5.0 && tangential > 1e6 {
                return Err(ChatterError::new(
                    kind,
                    quantity,
                    format!("{value} N/m^2 beside a tangential one of {tangential} N/m^2"),
                    "N/m^2, the ratio multiplied by the tangential coefficient (or ratios under that name)",
                ));
            }
        }
        Ok(Self {
            tangential,
            radial,
            axial,
        })
    }

    /// Tangential, N/m^2, and the ratios of radial and axial to it.
    ///
    /// # Errors
    /// As [`Self::new`]; ratios above 5 in size, which no material has.
    pub fn with_ratios(tangential: f64, radial: f64, axial: f64) -> Result<Self> {
        for (quantity, ratio) in [("radial ratio Kr/Kt", radial), ("axial ratio Ka/Kt", axial)] {
            if ratio.is_nan() || ratio.abs() > 5.0 {
                let expected = "a ratio, at most 5 in size (or N/m^2 under that name)";
                return Err(ChatterError::new(
                    ChatterErrorKind::Cut,
                    quantity,
                    ratio,
                    expected,
                ));
            }
        }
        above(
            ChatterErrorKind::Cut,
            "tangential coefficient",
            tangential,
            0.0,
            true,
            "N/m^2",
        )?;
        Ok(Self {
            tangential,
            radial: radial * tangential,
            axial: axial * tangential,
        })
    }

    /// Slope of a law of force at a thickness of chip, m: the mean one of the cut, feed per tooth times
    /// [`crate::Arc::mean_sine`]. Edge forces have no slope and drop out.
    ///
    /// ```
    /// use kinetostat_chatter::Coefficients;
    /// use kinetostat_cutting::Linear;
    ///
    /// let law = Linear::new([796.0, 168.0, 222.0], [27.7, 30.8, 1.4])?; // N/mm^2, N/mm
    /// let line = Coefficients::linearised(&law, 5e-5)?;
    /// assert!((line.coefficients.tangential() / 796e6 - 1.0).abs() < 1e-9);
    /// assert!((line.coefficients.axial() / 222e6 - 1.0).abs() < 1e-9);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// A thickness that is not positive, and a law whose force falls as the chip grows there.
    pub fn linearised<L: ForceLaw + ?Sized>(law: &L, chip: f64) -> Result<Linearised> {
        above(
            ChatterErrorKind::Cut,
            "thickness of chip",
            chip,
            0.0,
            true,
            "m",
        )?;
        let chip_mm = 1e3 * chip;
        let step = 1e-4 * chip_mm;
        let (low, high) = (
            law.edge_force(chip_mm - step),
            law.edge_force(chip_mm + step),
        );
        // N/mm over mm is N/mm^2, a million N/m^2.
        let slope = |low: f64, high: f64| 1e6 * (high - low) / (2.0 * step);
        let coefficients = Self::new(
            slope(low.tangential, high.tangential),
            slope(low.radial, high.radial),
            slope(low.axial, high.axial),
        )?;
        Ok(Linearised {
            coefficients,
            chip,
            within_measured: law
                .known_between_mm()
                .map(|(from, to)| from <= chip_mm && chip_mm <= to),
        })
    }

    /// Coefficient along the tooth's motion, N/m^2.
    #[must_use]
    pub fn tangential(&self) -> f64 {
        self.tangential
    }

    /// Coefficient along the outward normal, N/m^2.
    #[must_use]
    pub fn radial(&self) -> f64 {
        self.radial
    }

    /// Coefficient along the tool axis, N/m^2; positive pushes the tool towards the spindle.
    #[must_use]
    pub fn axial(&self) -> f64 {
        self.axial
    }
}
