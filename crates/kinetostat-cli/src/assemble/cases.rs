//! One figure in all cases: as built, as designed, linearised, without and under load.

use serde::Serialize;

/// A value without load and under load: of the machine as built, the share of its deviations in it,
/// and the first-order answer [R 6.15-6.20], which knows no weights and preloads.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct Cases<T> {
    pub(crate) without_load: T,
    /// As built less as drawn.
    pub(crate) without_load_by_deviations: T,
    pub(crate) without_load_linear: T,
    /// None without a force or moment.
    pub(crate) under_load: Option<T>,
    pub(crate) under_load_by_deviations: Option<T>,
    pub(crate) under_load_linear: Option<T>,
}

impl Cases<[f64; 3]> {
    pub(crate) fn component(&self, i: usize) -> Cases<f64> {
        Cases {
            without_load: self.without_load[i],
            without_load_by_deviations: self.without_load_by_deviations[i],
            without_load_linear: self.without_load_linear[i],
            under_load: self.under_load.map(|v| v[i]),
            under_load_by_deviations: self.under_load_by_deviations.map(|v| v[i]),
            under_load_linear: self.under_load_linear.map(|v| v[i]),
        }
    }
}

impl Cases<f64> {
    /// What sorts a list: the share of the deviations, then the whole.
    pub(crate) fn weight(&self) -> f64 {
        let under = self.under_load_by_deviations.unwrap_or(0.0).abs();
        let whole = self.all().into_iter().flatten();
        self.without_load_by_deviations.abs().max(under)
            + 1e-6 * whole.fold(0.0_f64, |m, x| m.max(x.abs()))
    }

    pub(crate) fn all(&self) -> [Option<f64>; 6] {
        [
            Some(self.without_load),
            Some(self.without_load_by_deviations),
            Some(self.without_load_linear),
            self.under_load,
            self.under_load_by_deviations,
            self.under_load_linear,
        ]
    }
}
