//! How far numbers of a model may be off.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A number that scatters; one of the spreads is given.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct UncertainTable {
    /// Path of a number of the model.
    pub parameter: Option<String>,
    /// Or a component of the load, as force_n.x, or factor.
    pub load: Option<String>,
    /// True if every limb that shares the number scatters by itself.
    pub each: Option<bool>,
    /// Standard deviation of a normal distribution, in the unit of the number.
    pub normal: Option<f64>,
    /// The same, percent of the number.
    pub normal_percent: Option<f64>,
    /// Half width of a uniform distribution.
    pub uniform: Option<f64>,
    /// The same, percent of the number.
    pub uniform_percent: Option<f64>,
    /// Half width of a triangular distribution.
    pub triangular: Option<f64>,
    /// The same, percent of the number.
    pub triangular_percent: Option<f64>,
    /// Source of the figure.
    pub source: Option<String>,
}

/// Two numbers that scatter together.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CorrelationTable {
    /// Their names.
    pub between: [String; 2],
    /// Coefficient of correlation, -1 to 1.
    pub coefficient: f64,
}
