//! `[[features]]` of a job file.

use serde::Deserialize;
use serde_spanned::Spanned;

/// A feature: lines of the program with a name and a tolerance.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct FeatureTable {
    /// Feature name.
    pub name: Spanned<String>,
    /// First and last line of the program.
    pub lines: Spanned<[usize; 2]>,
    /// Tolerance of the tool's position there, micrometres; by default that of the whole program.
    pub tolerance_um: Option<Spanned<f64>>,
}
