//! The answer of `force --fit`, stable names with units.

use kinetostat_machining::Warning;
use schemars::JsonSchema;
use serde::Serialize;

use crate::force::answer::ToolAnswer;

/// Coefficients that fit mean forces best; all forces are those on the tool.
#[derive(Serialize, JsonSchema)]
pub(crate) struct FitAnswer {
    pub(crate) schema: u32,
    pub(crate) kinetostat_version: &'static str,
    pub(crate) question: String,
    pub(crate) name: String,
    /// File of the means.
    pub(crate) file: String,
    /// Body that the forces act on: `tool` or `part`.
    pub(crate) acts_on: &'static str,
    /// Definition of the axes in words.
    pub(crate) axes: String,
    pub(crate) tool: ToolAnswer,
    pub(crate) cut: FitCut,
    pub(crate) coefficients: Vec<CoefficientAnswer>,
    pub(crate) components: Vec<Component>,
    pub(crate) rows: Vec<FitRow>,
    /// Half width of the band that the material carries; none where nothing states it.
    pub(crate) spread_percent: Option<f64>,
    /// `fit` or `given`.
    pub(crate) spread_from: Option<&'static str>,
    /// The material as a file; none where no material has such coefficients, or nothing states the spread.
    pub(crate) material_toml: Option<String>,
    /// Reason for a missing material.
    pub(crate) no_material: Option<String>,
    pub(crate) assumed: Vec<String>,
    pub(crate) warnings: Vec<Warning>,
    /// Lines of the drawing.
    #[serde(skip)]
    pub(crate) lines: Vec<AtFeed>,
}

#[derive(Serialize, JsonSchema)]
pub(crate) struct FitCut {
    pub(crate) width_mm: f64,
    pub(crate) depth_mm: f64,
    /// `left`, `right` or `both` (a slot).
    pub(crate) part: &'static str,
    /// `climb`, `conventional` or `slot`.
    pub(crate) milling: &'static str,
    pub(crate) counter_clockwise: bool,
    pub(crate) arc_from_deg: f64,
    pub(crate) arc_to_deg: f64,
    pub(crate) rpm: Option<f64>,
    pub(crate) cutting_speed_m_per_min: Option<f64>,
    /// Range from the mean chip at the smallest feed to the thickest at the largest.
    pub(crate) chip_from_mm: f64,
    pub(crate) chip_to_mm: f64,
}

#[derive(Serialize, JsonSchema)]
pub(crate) struct CoefficientAnswer {
    pub(crate) symbol: &'static str,
    /// Unit of the numbers beside it.
    pub(crate) unit: &'static str,
    pub(crate) value: f64,
    pub(crate) standard_error: Option<f64>,
    /// Ends of the 95 % interval.
    pub(crate) low_95: Option<f64>,
    pub(crate) high_95: Option<f64>,
}

/// Goodness of fit of the force along an axis.
#[derive(Serialize, JsonSchema)]
pub(crate) struct Component {
    pub(crate) axis: &'static str,
    pub(crate) r_squared: Option<f64>,
    /// Root of the mean square of the residuals.
    pub(crate) residual_rms_n: f64,
    pub(crate) largest_residual_n: f64,
    pub(crate) largest_residual_at_feed_mm_per_tooth: f64,
}

/// A row of the file, its forces as those on the tool.
#[derive(Serialize, JsonSchema)]
pub(crate) struct FitRow {
    pub(crate) feed_mm_per_tooth: f64,
    pub(crate) force_n: [f64; 3],
    pub(crate) fitted_n: [f64; 3],
    pub(crate) residual_n: [f64; 3],
    /// Half width of the 95 % interval of the fitted force.
    pub(crate) half_width_95_n: [Option<f64>; 3],
}

/// The fitted force at a feed.
#[derive(Clone, Copy)]
pub(crate) struct AtFeed {
    pub(crate) feed_mm_per_tooth: f64,
    pub(crate) fitted_n: [f64; 3],
    pub(crate) half_width_95_n: [Option<f64>; 3],
}
