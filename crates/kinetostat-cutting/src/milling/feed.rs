//! Feed from tooth to tooth.

use crate::error::{CutErrorKind, Result, within};

/// Feed from tooth to tooth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Feed {
    /// Feed across the tool axis, mm per tooth.
    pub level_mm: f64,
    /// Feed down along the tool axis, mm per tooth; negative where the tool rises.
    pub down_mm: f64,
}

impl Feed {
    /// Feed across the tool axis, mm per tooth.
    ///
    /// # Errors
    /// Negative, or more than 10 mm.
    pub fn level(per_tooth_mm: f64) -> Result<Self> {
        Self::ramp(per_tooth_mm, 0.0)
    }

    /// Feed across the tool axis and down along it, mm per tooth.
    ///
    /// # Errors
    /// Negative across, or more than 10 mm either way.
    pub fn ramp(level_mm: f64, down_mm: f64) -> Result<Self> {
        let cut = CutErrorKind::Cut;
        within(cut, "feed per tooth", level_mm, 0.0..=10.0, "mm")?;
        within(
            cut,
            "feed per tooth down the axis",
            down_mm,
            -10.0..=10.0,
            "mm",
        )?;
        Ok(Self { level_mm, down_mm })
    }
}
