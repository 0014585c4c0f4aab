//! What a job says is uncertain.

use serde::Deserialize;
use serde_spanned::Spanned;

/// What is uncertain: `[uncertain]`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct UncertainTable {
    /// File of uncertainties (see `kinetostat tolerance --help`).
    pub file: Spanned<String>,
    /// Machines that are drawn.
    pub machines: Option<Spanned<usize>>,
    /// Of the draws.
    pub seed: Option<u32>,
}
