//! Table of a job about uncertainties.

use serde::Deserialize;
use serde_spanned::Spanned;

/// Table of uncertainties: `[uncertain]`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct UncertainTable {
    /// File of uncertainties (see `kinetostat tolerance --help`).
    pub file: Spanned<String>,
    /// Machines that are drawn.
    pub machines: Option<Spanned<usize>>,
    /// Seed of the draws.
    pub seed: Option<u32>,
}
