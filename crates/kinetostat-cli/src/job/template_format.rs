//! The template file of a cell, as it is written.

use kinetostat_model::schema::Placement as PoseTable;
use serde::Deserialize;
use serde_spanned::Spanned;

/// A whole template.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct TemplateTable {
    pub schema: Spanned<u32>,
    pub program_name: Option<String>,
    pub tool_orientation: Option<Spanned<PoseTable>>,
    pub rapids: Option<RapidsWord>,
    pub rapid_speed_mm_per_s: Option<f64>,
    pub joint_speed_percent: Option<f64>,
    pub unstated_feed_mm_per_s: Option<f64>,
    pub acceleration_m_per_s2: Option<f64>,
    pub configuration: Option<String>,
    pub start_joints_deg: Option<Vec<f64>>,
    pub places_unknown: Option<PlacesWord>,
    pub tolerance_mm: Option<f64>,
    pub most_points: Option<usize>,
    pub position_decimals: Option<usize>,
    pub angle_decimals: Option<usize>,
    pub quaternion_decimals: Option<usize>,
    pub speed_decimals: Option<usize>,
    #[serde(default)]
    pub base: FrameTable,
    #[serde(default)]
    pub tool: ToolTable,
    #[serde(default)]
    pub tools: Vec<Spanned<NumberedToolTable>>,
    #[serde(default)]
    pub spindle: SpindleTable,
    #[serde(default)]
    pub zones: ZonesTable,
}

/// A base.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct FrameTable {
    pub number: Option<u32>,
    pub name: Option<String>,
    pub pose: Option<Spanned<PoseTable>>,
}

/// The tool of a program with one.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ToolTable {
    pub number: Option<u32>,
    pub name: Option<String>,
    pub pose: Option<Spanned<PoseTable>>,
    pub mass_kg: Option<f64>,
    pub centre_of_mass_mm: Option<[f64; 3]>,
}

/// Tool among several.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct NumberedToolTable {
    pub in_program: u32,
    pub number: Option<u32>,
    pub name: Option<String>,
    pub pose: Option<Spanned<PoseTable>>,
    pub mass_kg: Option<f64>,
    pub centre_of_mass_mm: Option<[f64; 3]>,
}

/// Statements that start and stop the spindle.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct SpindleTable {
    #[serde(default)]
    pub clockwise: Vec<Spanned<String>>,
    #[serde(default)]
    pub counter_clockwise: Vec<Spanned<String>>,
    #[serde(default)]
    pub stop: Vec<Spanned<String>>,
}

/// Rounding of corners.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ZonesTable {
    pub rapids_mm: Option<f64>,
    pub feeds_mm: Option<f64>,
    pub rapids_percent: Option<f64>,
    pub feeds_percent: Option<f64>,
}

/// Conversion of rapids.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum RapidsWord {
    /// Straight motions.
    Linear,
    /// Joint motions.
    Joint,
}

/// Policy for moves to places of the machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum PlacesWord {
    /// Refused between moves.
    Refused,
    /// Left out.
    LeftOut,
}
