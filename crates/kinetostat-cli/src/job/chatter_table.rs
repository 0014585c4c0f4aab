//! Table of a job about chatter.

use serde::Deserialize;
use serde_spanned::Spanned;

/// Chatter is judged along the program: `[chatter]`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ChatterTable {
    /// Ratio to critical damping of all modes; without it the model says how it is damped.
    pub damping_ratio: Option<Spanned<f64>>,
    /// Modes above this count by their flexibility at rest, Hz; without it those that do not count.
    pub modes_up_to_hz: Option<Spanned<f64>>,
    /// Places farther apart are judged by themselves, mm.
    pub every_mm: Option<Spanned<f64>>,
    /// Upper limit of the places that are judged.
    pub most_places: Option<Spanned<usize>>,
}
