//! Answer of `place`.

use kinetostat_analysis::placing::{Objective, Placed};
use kinetostat_machining::{FileRead, RunResult, Warning};
use schemars::JsonSchema;
use serde::Serialize;

/// The answer of `place`: names with units.
#[derive(Serialize, JsonSchema)]
pub(crate) struct PlaceAnswer {
    pub(crate) schema: u32,
    pub(crate) kinetostat_version: &'static str,
    pub(crate) model: String,
    pub(crate) program: String,
    pub(crate) load: String,
    pub(crate) files: Vec<FileRead>,
    pub(crate) objective: Objective,
    /// Unit of all figures; empty for shares.
    pub(crate) unit: &'static str,
    #[serde(flatten)]
    pub(crate) placed: Placed,
    /// The whole program at the best placement, as `deflect` solves it.
    pub(crate) at_best: Option<AtBest>,
    pub(crate) warnings: Vec<Warning>,
}

/// Figures of the whole program at a placement.
#[derive(Serialize, JsonSchema)]
pub(crate) struct AtBest {
    pub(crate) max_position_error_mm: f64,
    pub(crate) rms_position_error_mm: f64,
    pub(crate) largest_share_of_rating: Option<f64>,
    pub(crate) largest_share_to_buckling: Option<f64>,
    pub(crate) stable: bool,
    /// Smallest distance of a joint to one of its limits.
    pub(crate) nearest_limit_mm_or_deg: Option<f64>,
    pub(crate) configuration: Option<String>,
}

impl AtBest {
    pub(crate) fn of(result: &RunResult) -> Self {
        let (summary, joints) = (&result.summary, &result.joints);
        Self {
            max_position_error_mm: summary.max_position_error_before_mm,
            rms_position_error_mm: summary.rms_position_error_before_mm,
            largest_share_of_rating: joints.most_loaded.as_ref().map(|m| m.drive.share_of_rating),
            largest_share_to_buckling: summary.largest_share_to_buckling,
            stable: summary.stable,
            nearest_limit_mm_or_deg: joints.nearest_limit.as_ref().map(|l| l.limit.distance),
            configuration: joints.configuration_text(),
        }
    }
}
