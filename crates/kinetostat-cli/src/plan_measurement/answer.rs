//! The answer of `plan-measurement`, stable names with units.

use schemars::JsonSchema;
use serde::Serialize;

use crate::place::joints::JointValue;

/// The answer, stable names with units.
#[derive(Serialize, JsonSchema)]
pub(crate) struct PlanAnswer {
    pub(crate) schema: u32,
    pub(crate) kinetostat_version: &'static str,
    pub(crate) model: String,
    pub(crate) model_source: String,
    /// Postures that were chosen from.
    pub(crate) candidates: usize,
    /// Postures that were passed over: they cannot be taken, leave the room or hide a marker.
    pub(crate) passed_over: usize,
    /// Node on which the loads act; null: the tool.
    pub(crate) load_on: Option<String>,
    /// Value of the plan beside the best that any plan with as many measurements could have: 1 is the best; null for the worst direction.
    pub(crate) efficiency: Option<f64>,
    /// Variance of the median of random plans, in that of this one.
    pub(crate) variance_of_random_plans: Option<f64>,
    /// Error that noise of the readings leaves after compensation at the postures of work, mm, root mean square.
    pub(crate) left_error_mm: Option<f64>,
    pub(crate) numbers: Vec<PlannedNumber>,
    pub(crate) measurements: Vec<PlanRow>,
}

/// How well a number will be known.
#[derive(Serialize, JsonSchema)]
pub(crate) struct PlannedNumber {
    pub(crate) number: String,
    /// Standard deviation, percent of what the model says; null where no reading sees it.
    pub(crate) deviation_percent: Option<f64>,
}

/// A measurement of the plan.
#[derive(Serialize, JsonSchema)]
pub(crate) struct PlanRow {
    pub(crate) posture: String,
    pub(crate) axes: Vec<JointValue>,
    pub(crate) position_mm: [f64; 3],
    pub(crate) force_n: [f64; 3],
    /// Largest displacement of a marker that the model expects.
    pub(crate) expected_displacement_mm: f64,
}
