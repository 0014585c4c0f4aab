//! The tables of a job that say what is cut.

use kinetostat_cutting::{Coolant, CuttingMaterial, DriftModel, OutlierTreatment, Rotation, Side};
use kinetostat_machining::{ActsOn, DwellUnit, ForceChoice, MeasuredAxes};
use serde::Deserialize;
use serde_spanned::Spanned;

use crate::job::units_word::UnitsWord;

/// Workpiece material: `[material]`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct MaterialTable {
    /// Name in the library, or in the file.
    pub name: Spanned<String>,
    /// A file of materials beside the library.
    pub file: Option<Spanned<String>>,
    /// Factor for milling with coefficients of turning tests.
    pub process_factor: Option<f64>,
    /// Cutting speed for the factor of the speed, m/min.
    pub cutting_speed_m_per_min: Option<f64>,
    /// Rake angle of the edge.
    pub rake_deg: Option<f64>,
    /// Material of the edge.
    #[serde(default)]
    pub cutting_material: CuttingMaterial,
    /// 1 for a sharp edge, 1.3 to 1.5 for a worn one.
    pub wear_factor: Option<f64>,
    /// Cooling of the cut.
    #[serde(default)]
    pub coolant: Coolant,
}

/// Cutters of the tools that the program calls, from tables: `[cutters]`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct CuttersTable {
    /// A table of tools in TOML, with `[[tool]]`.
    pub file: Spanned<String>,
    /// A `tool.tbl` of LinuxCNC, which gives diameters that the table leaves out.
    pub tool_tbl: Option<Spanned<String>>,
    /// Length unit of the table; mm without it.
    pub tool_tbl_unit: Option<UnitsWord>,
}

/// The stock before the program: `[stock]`. One of block, cylinder, stl, height_map.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct StockTable {
    /// Two opposite corners, program coordinates, mm.
    pub block_mm: Option<Spanned<[[f64; 3]; 2]>>,
    /// A cylinder that stands along z.
    pub cylinder: Option<Spanned<CylinderTable>>,
    /// A mesh; its greatest heights count.
    pub stl: Option<Spanned<String>>,
    /// Heights in rows of a CSV file.
    pub height_map: Option<Spanned<HeightMapTable>>,
    /// Size of a cell; a twentieth of the smallest tool's diameter without it.
    pub cell_mm: Option<Spanned<f64>>,
    /// Memory that the stock may take, MB; 500 without it.
    pub memory_mb: Option<Spanned<f64>>,
}

/// A cylinder that stands along z.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct CylinderTable {
    /// Middle of its foot, mm.
    pub foot_mm: [f64; 3],
    /// Radius, mm.
    pub radius_mm: f64,
    /// Height, mm.
    pub height_mm: f64,
}

/// Heights over a grid.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct HeightMapTable {
    /// CSV of heights, mm: a row along x, rows along y.
    pub file: Spanned<String>,
    /// Corner of the first number, at the bottom, mm.
    pub corner_mm: [f64; 3],
    /// Distance of the numbers, mm.
    pub spacing_mm: f64,
}

/// Engagement, constant or by lines: `[engagement]`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct EngagementTable {
    /// Width of cut across the feed; the diameter is a slot.
    pub width_mm: Option<Spanned<f64>>,
    /// Depth of cut along the axis.
    pub depth_mm: Option<Spanned<f64>>,
    /// Side of the feed on which the part is.
    pub part: Option<Side>,
    /// Cuts of lines of the program; air on all others.
    #[serde(default)]
    pub lines: Vec<Spanned<LinesTable>>,
}

/// The cut on some lines of the program.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct LinesTable {
    /// First line, from 1.
    pub from: usize,
    /// Last line.
    pub to: usize,
    /// Width of cut across the feed.
    pub width_mm: f64,
    /// Depth of cut along the axis.
    pub depth_mm: f64,
    /// Side of the feed on which the part is.
    pub part: Option<Side>,
}

/// The spindle: `[spindle]`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct SpindleTable {
    /// Speed instead of the program's S.
    pub rpm: Option<Spanned<f64>>,
    /// Sense instead of the program's M3 and M4.
    pub rotation: Option<Rotation>,
    /// Rated power, W.
    pub power_w: Option<Spanned<f64>>,
    /// Speed from which on the power is there.
    pub base_rpm: Option<Spanned<f64>>,
    /// Largest speed.
    pub most_rpm: Option<Spanned<f64>>,
    /// Force of the revolution that bends the machine.
    pub force: Option<ForceChoice>,
}

/// Forces that were measured: `[measured]`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct MeasuredTable {
    /// CSV with a column `time_s` or `along_mm`.
    pub file: Spanned<String>,
    /// Body that the logged force acts on.
    pub acts_on: ActsOn,
    /// Axes of the log.
    #[serde(default)]
    pub axes: MeasuredAxes,
    /// Time of the log at which the first cut begins; by correlation without it.
    pub shift_s: Option<Spanned<f64>>,
    /// Window of the mean, of a log over time; a revolution of the spindle without it.
    pub smooth_s: Option<Spanned<f64>>,
    /// Smoothing length of a log along the path.
    pub smooth_mm: Option<Spanned<f64>>,
    /// Speed of rapids.
    pub rapid_mm_per_min: Option<Spanned<f64>>,
    /// Unit of the P of dwells (G4).
    pub dwell_unit: Option<Spanned<DwellUnit>>,
    /// Stretches in which the tool is in air, of a log over time.
    pub air_s: Option<Spanned<Vec<[f64; 2]>>>,
    /// Air cuts of a log along the path.
    pub air_mm: Option<Spanned<Vec<[f64; 2]>>>,
    /// Interpolation of the drift between them.
    #[serde(default)]
    pub drift: DriftModel,
    /// Treatment of outliers.
    #[serde(default)]
    pub outliers: OutlierTreatment,
}
