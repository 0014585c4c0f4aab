//! The answer of `tolerance`, stable names with units.

use kinetostat_analysis::tolerance::{Failures, OutputAnswer, SobolIndex};
use kinetostat_machining::{UncertainNumber, Warning};
use schemars::JsonSchema;
use serde::Serialize;

#[derive(Serialize, JsonSchema)]
pub(crate) struct ToleranceAnswer {
    pub(crate) schema: u32,
    pub(crate) kinetostat_version: &'static str,
    pub(crate) model: String,
    pub(crate) model_source: String,
    pub(crate) force_n: [f64; 3],
    pub(crate) moment_n_m: [f64; 3],
    pub(crate) machines: usize,
    pub(crate) seed: u64,
    /// Confidence of all bounds.
    pub(crate) confidence: f64,
    pub(crate) uncertain: Vec<UncertainNumber>,
    pub(crate) correlated: bool,
    /// Draws without a whole answer.
    pub(crate) failures: Failures,
    /// Failures of the draws for Sobol indices.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) sobol_failures: Option<Failures>,
    pub(crate) places: Vec<PlaceResults>,
    pub(crate) warnings: Vec<Warning>,
}

#[derive(Serialize, JsonSchema)]
pub(crate) struct PlaceResults {
    pub(crate) position_mm: [f64; 3],
    pub(crate) results: Vec<ColumnResult>,
}

#[derive(Serialize, JsonSchema)]
pub(crate) struct ColumnResult {
    /// Name with its unit.
    pub(crate) name: &'static str,
    #[serde(flatten)]
    pub(crate) answer: OutputAnswer,
    /// Sobol indices of every uncertain number, in their order.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) sobol: Option<Vec<SobolIndex>>,
}
