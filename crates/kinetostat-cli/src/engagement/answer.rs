//! The answer of `engagement`, stable names with units.

use kinetostat_machining::{CuttingResult, FileRead, FlatProgram, Warning};
use schemars::JsonSchema;
use serde::Serialize;

/// Engagement along a program.
#[derive(Serialize, JsonSchema)]
pub(crate) struct EngagementAnswer {
    pub(crate) schema: u32,
    pub(crate) kinetostat_version: &'static str,
    pub(crate) program: String,
    /// Origin of the lines, if the program was run once and written flat.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) flat: Option<FlatProgram>,
    pub(crate) material: String,
    pub(crate) files: Vec<FileRead>,
    pub(crate) tools: Vec<ToolAnswer>,
    /// Length of all feed moves from known places.
    pub(crate) feed_length_mm: f64,
    /// Absent if the engagement comes from no stock.
    pub(crate) stock: Option<StockAnswer>,
    pub(crate) cutting: CuttingResult,
    /// Assumptions behind the numbers, in sentences.
    pub(crate) assumed: Vec<String>,
    pub(crate) warnings: Vec<Warning>,
}

/// A tool; the number is none for that of blocks whose tool has no entry.
#[derive(Serialize, JsonSchema)]
pub(crate) struct ToolAnswer {
    pub(crate) number: Option<u32>,
    pub(crate) shape: &'static str,
    pub(crate) diameter_mm: f64,
    pub(crate) teeth: usize,
    pub(crate) helix_deg: f64,
}

/// Stock after the cut.
#[derive(Serialize, JsonSchema)]
pub(crate) struct StockAnswer {
    pub(crate) volume_mm3: f64,
    pub(crate) removed_mm3: f64,
    pub(crate) removed_percent: f64,
    pub(crate) cell_mm: f64,
}
