//! Options of a registration.

use crate::registration::closest::Counting;

/// Options of a registration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RegistrationOptions {
    /// Seek a scale too: where the part has another temperature than its drawing.
    pub with_scale: bool,
    /// Seek a shift only: no turn, and no scale.
    pub only_shift: bool,
    /// Maximum distance of the tool from its path, mm: points within that are not outliers.
    pub window_mm: f64,
}

impl Default for RegistrationOptions {
    fn default() -> Self {
        Self {
            with_scale: false,
            only_shift: false,
            window_mm: 1.0,
        }
    }
}

impl RegistrationOptions {
    pub(crate) fn counting(self, without_outliers: bool) -> Counting {
        Counting {
            window_mm: self.window_mm,
            without_outliers,
        }
    }
}
