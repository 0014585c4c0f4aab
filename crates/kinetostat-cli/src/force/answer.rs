//! The answer of `force`, stable names with units.

use kinetostat_cutting::{Group, Law, Material, MeasuredIn};
use kinetostat_machining::Warning;
use schemars::JsonSchema;
use serde::Serialize;

/// Force, torque and moment of one cut; forces are those on the tool, in the axes of the cut.
#[derive(Serialize, JsonSchema)]
pub(crate) struct ForceAnswer {
    pub(crate) schema: u32,
    pub(crate) kinetostat_version: &'static str,
    pub(crate) question: String,
    pub(crate) material: MaterialAnswer,
    pub(crate) tool: ToolAnswer,
    pub(crate) cut: CutAnswer,
    /// Definition of the axes in words.
    pub(crate) axes: String,
    pub(crate) mean: MeanAnswer,
    pub(crate) peak: PeakAnswer,
    /// Walls that the cut leaves, with the force at the moment at which they are made.
    pub(crate) walls: Vec<WallAnswer>,
    pub(crate) harmonics: Vec<HarmonicAnswer>,
    /// Power and torque of the spindle at this speed; none without spindle data or above its top speed.
    pub(crate) spindle: Option<SpindleAnswer>,
    /// Assumptions behind the numbers, in sentences.
    pub(crate) assumed: Vec<String>,
    pub(crate) warnings: Vec<Warning>,
    /// Mean force of the flat end along the tool, N.
    #[serde(skip)]
    pub(crate) end_axial_n: f64,
    /// The force over one revolution, for the table and the drawing.
    #[serde(skip)]
    pub(crate) revolution: Vec<AtAngle>,
}

#[derive(Serialize, JsonSchema)]
pub(crate) struct MaterialAnswer {
    pub(crate) name: String,
    pub(crate) law: &'static str,
    pub(crate) source: String,
    /// Half width of the band in which the force lies, of the force.
    pub(crate) spread_percent: f64,
    /// Product of the factors below.
    pub(crate) factor: f64,
    pub(crate) factors: Vec<FactorAnswer>,
}

#[derive(Serialize, JsonSchema)]
pub(crate) struct FactorAnswer {
    pub(crate) symbol: &'static str,
    pub(crate) value: f64,
    pub(crate) reason: String,
}

#[derive(Serialize, JsonSchema)]
pub(crate) struct ToolAnswer {
    pub(crate) number: Option<u32>,
    pub(crate) name: String,
    pub(crate) shape: &'static str,
    pub(crate) diameter_mm: f64,
    pub(crate) teeth: usize,
    pub(crate) helix_deg: f64,
    pub(crate) corner_radius_mm: Option<f64>,
    pub(crate) lead_angle_deg: Option<f64>,
    pub(crate) run_out_um: f64,
    pub(crate) run_out_angle_deg: f64,
}

#[derive(Serialize, JsonSchema)]
pub(crate) struct CutAnswer {
    pub(crate) width_mm: f64,
    pub(crate) depth_mm: f64,
    /// `left`, `right` or `both` (a slot).
    pub(crate) part: &'static str,
    /// `climb`, `conventional` or `slot`.
    pub(crate) milling: &'static str,
    pub(crate) counter_clockwise: bool,
    /// The arc in which the teeth cut, from +y (left of the feed) clockwise as seen from the spindle.
    pub(crate) arc_from_deg: f64,
    pub(crate) arc_to_deg: f64,
    pub(crate) feed_per_tooth_mm: f64,
    pub(crate) down_feed_per_tooth_mm: f64,
    pub(crate) feed_mm_per_min: Option<f64>,
    pub(crate) rpm: Option<f64>,
    /// Speed at the widest place in the cut.
    pub(crate) cutting_speed_m_per_min: Option<f64>,
    pub(crate) removed_mm3_per_min: Option<f64>,
    pub(crate) largest_chip_mm: f64,
    pub(crate) mean_chip_mm: f64,
}

#[derive(Serialize, JsonSchema)]
pub(crate) struct MeanAnswer {
    pub(crate) force_n: [f64; 3],
    /// Force minus and plus the spread of the material.
    pub(crate) force_low_n: [f64; 3],
    pub(crate) force_high_n: [f64; 3],
    pub(crate) across_tool_n: f64,
    /// Moment on the tool about its tip.
    pub(crate) moment_n_mm: [f64; 3],
    pub(crate) torque_n_mm: f64,
    pub(crate) power_w: Option<f64>,
    /// Force in the form of a job file: radial to the right of the feed, tangential along it.
    pub(crate) job_load: JobLoad,
}

#[derive(Serialize, JsonSchema)]
pub(crate) struct JobLoad {
    pub(crate) radial_n: f64,
    pub(crate) tangential_n: f64,
    pub(crate) axial_n: f64,
    /// Moment on the tool about its tip in axes of the feed (x along it, z along the tool), which a job takes beside a force in
    /// the same axes: `force_n`, `moment_n_m`, `axes = "feed"`.
    pub(crate) moment_n_m: [f64; 3],
}

#[derive(Serialize, JsonSchema)]
pub(crate) struct PeakAnswer {
    /// The force when its part across the tool is largest.
    pub(crate) force_n: [f64; 3],
    pub(crate) across_tool_n: f64,
    pub(crate) across_tool_high_n: f64,
    /// Angle of the spindle, from 0 below one turn.
    pub(crate) at_deg: f64,
    /// Largest torque, which may come at another angle.
    pub(crate) torque_n_mm: f64,
    pub(crate) torque_at_deg: f64,
    pub(crate) power_w: Option<f64>,
}

#[derive(Serialize, JsonSchema)]
pub(crate) struct WallAnswer {
    /// `left` or `right` of the feed.
    pub(crate) wall: &'static str,
    /// Mean over the depth of the force at the moment at which the wall is made there.
    pub(crate) force_n: [f64; 3],
    /// Component away from the wall: positive leaves material, negative takes too much.
    pub(crate) away_from_wall_n: f64,
    pub(crate) heights: Vec<AtHeight>,
}

#[derive(Serialize, JsonSchema)]
pub(crate) struct AtHeight {
    pub(crate) above_tip_mm: f64,
    pub(crate) force_n: [f64; 3],
}

#[derive(Serialize, JsonSchema)]
pub(crate) struct HarmonicAnswer {
    pub(crate) per_revolution: usize,
    pub(crate) frequency_hz: Option<f64>,
    pub(crate) amplitude_n: [f64; 3],
}

#[derive(Serialize, JsonSchema)]
pub(crate) struct SpindleAnswer {
    pub(crate) torque_n_mm: f64,
    pub(crate) power_w: f64,
    /// Share of the available torque: the mean of the cut, and its largest.
    pub(crate) share_of_torque: f64,
    pub(crate) share_of_torque_at_peak: f64,
}

/// The force at one angle of the spindle.
#[derive(Clone, Copy)]
pub(crate) struct AtAngle {
    pub(crate) angle_deg: f64,
    pub(crate) force_n: [f64; 3],
    pub(crate) moment_n_mm: [f64; 3],
    pub(crate) torque_n_mm: f64,
}

/// The known materials.
#[derive(Serialize, JsonSchema)]
pub(crate) struct MaterialList {
    pub(crate) schema: u32,
    pub(crate) kinetostat_version: &'static str,
    pub(crate) materials: Vec<ListedMaterial>,
}

#[derive(Serialize, JsonSchema)]
pub(crate) struct ListedMaterial {
    pub(crate) name: String,
    pub(crate) aliases: Vec<String>,
    pub(crate) group: Group,
    pub(crate) law: Law,
    pub(crate) spread_percent: f64,
    pub(crate) source: String,
    pub(crate) assumptions: Vec<String>,
    pub(crate) measured_in: MeasuredIn,
    pub(crate) chip_mm: Option<(f64, f64)>,
    pub(crate) speed_m_per_min: Option<(f64, f64)>,
}

impl From<&Material> for ListedMaterial {
    fn from(of: &Material) -> Self {
        Self {
            name: of.name.clone(),
            aliases: of.aliases.clone(),
            group: of.group,
            law: of.law,
            spread_percent: 100.0 * of.spread,
            source: of.source.clone(),
            assumptions: of.assumptions.clone(),
            measured_in: of.measured_in,
            chip_mm: of.chip_mm,
            speed_m_per_min: of.speed_m_per_min,
        }
    }
}
