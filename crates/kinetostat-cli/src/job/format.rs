//! Job files: one TOML file that says model, program, placement, load, tolerances and outputs of a
//! run, units in the keys. Options on the command line go over it.

use std::collections::BTreeMap;

use kinetostat_cutting::WrittenTool;
use kinetostat_model::schema::{Deviation, Placement as PoseTable};
use serde::Deserialize;
use serde_spanned::Spanned;

use crate::job::cut_tables::{
    CuttersTable, EngagementTable, MaterialTable, MeasuredTable, SpindleTable, StockTable,
};
use crate::job::expand_table::ExpandTable;
use crate::job::place_table::PlaceTable;
use crate::job::robot_table::{CallWord, RobotTable, ValueWord};
use crate::job::source::Source;
use crate::job::units_word::UnitsWord;
use crate::ui::failure::Failure;
use crate::ui::language::LanguageWord;

/// The version that is read here.
const SCHEMA: u32 = 1;

/// A job file.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Job {
    /// Version of the format: 1.
    pub schema: Spanned<u32>,
    /// Name of a preset, or path of a model file.
    pub model: Option<Spanned<String>>,
    /// Path of the program.
    pub program: Option<Spanned<String>>,
    /// Errors of manufacture and assembly, added to those of the model.
    #[serde(default)]
    pub deviation: Vec<Spanned<Deviation>>,
    #[serde(default)]
    pub placement: PlacementTable,
    #[serde(default)]
    pub tool: ToolTable,
    /// Several tools, by number; without any, `tool` is the only one.
    #[serde(default)]
    pub tools: Vec<Spanned<NumberedTool>>,
    #[serde(default)]
    pub load: LoadTable,
    /// Material of the workpiece: the load is computed from the cut.
    pub material: Option<Spanned<MaterialTable>>,
    /// Tables of the cutters.
    pub cutters: Option<Spanned<CuttersTable>>,
    /// The stock before the program.
    pub stock: Option<Spanned<StockTable>>,
    /// Engagement of the tool, without a stock.
    pub engagement: Option<Spanned<EngagementTable>>,
    pub spindle: Option<Spanned<SpindleTable>>,
    /// Forces that were measured along the program.
    pub measured: Option<Spanned<MeasuredTable>>,
    #[serde(default)]
    pub reading: ReadingTable,
    /// Data that a program of a robot does not state itself.
    pub robot: Option<Spanned<RobotTable>>,
    /// Effect of called routines that are in none of the files.
    #[serde(default)]
    pub calls: BTreeMap<Spanned<String>, CallWord>,
    /// Values of names that only the controller knows.
    #[serde(default)]
    pub values: BTreeMap<Spanned<String>, ValueWord>,
    /// The program is run once and written flat.
    pub expand: Option<Spanned<ExpandTable>>,
    /// Uncertain numbers of machine and load.
    pub uncertain: Option<Spanned<UncertainTable>>,
    /// Chatter is judged along the program.
    pub chatter: Option<Spanned<ChatterTable>>,
    /// Lines of the program with names and tolerances of their own.
    #[serde(default)]
    pub features: Vec<Spanned<FeatureTable>>,
    /// Range of the part's placement, for `kinetostat place`.
    pub place: Option<Spanned<PlaceTable>>,
    #[serde(default)]
    pub tolerances: TolerancesTable,
    #[serde(default)]
    pub output: OutputTable,
    /// Limits moved by their names.
    #[serde(default)]
    pub limits: BTreeMap<Spanned<String>, Spanned<f64>>,
}

/// Placement of the program in the machine.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct PlacementTable {
    /// Position of the program's zero point, base axes, mm.
    pub part_origin_mm: Option<Spanned<[f64; 3]>>,
    /// Orientation of the program's axes in the base.
    pub part_orientation: Option<Spanned<PoseTable>>,
    /// Orientation of the tool in the base; without it, the one that the tool has at home.
    pub tool_orientation: Option<Spanned<PoseTable>>,
    /// Mode of that orientation: held, or only approximated; without it, held by machines that can.
    pub orientation: Option<OrientationWord>,
    /// Length in the machine per length in the program.
    pub scale: Option<Spanned<f64>>,
}

/// Treatment of the tool orientation by the machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum OrientationWord {
    /// The requested orientation, everywhere
    Held,
    /// The nearest to it that the machine can have
    Follows,
}

/// The tool on the flange.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ToolTable {
    /// Distance of the tip along z of the flange, mm.
    pub length_mm: Option<Spanned<f64>>,
    /// Alternative: the whole pose of the tip in the flange.
    pub pose: Option<Spanned<PoseTable>>,
    /// Cutting edges, for loads that are computed from the cut.
    pub cutter: Option<Spanned<WrittenTool>>,
    /// Mass that the flange carries, kg: spindle and tool.
    pub mass_kg: Option<Spanned<f64>>,
    /// Centre of mass in the frame of the flange, mm; halfway to the tip if not given.
    pub centre_of_mass_mm: Option<Spanned<[f64; 3]>>,
    /// Inertia about the centre of mass in axes of the flange, kg m^2, three rows; a point if not given.
    pub inertia_kg_m2: Option<Spanned<[[f64; 3]; 3]>>,
}

/// A tool that the program takes by its number.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct NumberedTool {
    /// Number in the T words of the program.
    pub number: u32,
    /// Distance of the tip along z of the flange, mm.
    pub length_mm: Option<Spanned<f64>>,
    /// Alternative: the whole pose of the tip in the flange.
    pub pose: Option<Spanned<PoseTable>>,
    /// Cutting edges, for loads that are computed from the cut.
    pub cutter: Option<Spanned<WrittenTool>>,
    /// Mass that the flange carries with it, kg: spindle and tool; without this, that of `[tool]`.
    pub mass_kg: Option<Spanned<f64>>,
    /// Centre of mass in the frame of the flange, mm; halfway to the tip if not given.
    pub centre_of_mass_mm: Option<Spanned<[f64; 3]>>,
    /// Inertia about the centre of mass in axes of the flange, kg m^2, three rows; a point if not given.
    pub inertia_kg_m2: Option<Spanned<[[f64; 3]; 3]>>,
    /// Load on this tool; without it, the job's `[load]`.
    pub load: Option<LoadTable>,
}

/// Load on the tool.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct LoadTable {
    /// Constant force, N.
    pub force_n: Option<[f64; 3]>,
    /// Constant moment about the tip, N m.
    pub moment_n_m: Option<[f64; 3]>,
    /// Axes of both.
    pub axes: Option<Axes>,
    /// Alternative: a force that turns with the feed.
    pub milling: Option<Spanned<MillingTable>>,
    /// Height of the program below which it acts, mm.
    pub below_z_mm: Option<f64>,
    /// Corners up to this angle turn the load gently.
    pub gentle_corner_deg: Option<Spanned<f64>>,
    /// Length over which the load turns there, mm.
    pub turning_length_mm: Option<Spanned<f64>>,
    /// Largest change of the correction outside sharp corners, mm per mm of path.
    pub largest_step_mm_per_mm: Option<Spanned<f64>>,
    /// Load on the steps written at sharp corners, of this tool.
    pub at_corners: Option<CornerWord>,
    /// Share of the displacement by the machine's own weight that counts as an error; of the machine, not of a tool.
    pub weight: Option<Spanned<WeightWord>>,
    /// Places where the machine touched the part off, program coordinates, mm.
    pub touch_off_mm: Option<Spanned<Vec<[f64; 3]>>>,
}

/// Share of the displacement by the machine's own weight that counts as an error.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, clap::ValueEnum)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum WeightWord {
    /// This machine touched the part off, hanging as it hangs: only the change of the sag from there
    TouchOff,
    /// The part was measured without this machine: all of it
    All,
    /// None of it: the controller corrects the weight
    None,
}

/// The load on the steps that are written at sharp corners.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, clap::ValueEnum)]
#[serde(rename_all = "snake_case")]
pub(crate) enum CornerWord {
    /// It turns evenly while the tool steps
    Turns,
    /// It is that of a cut along the step
    FollowsFeed,
}

/// Axes of a constant load.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, clap::ValueEnum)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Axes {
    /// Axes of the machine's base
    Base,
    /// Axes of the tool, with which the load turns
    Tool,
    /// x along the feed, z along the part's z
    Feed,
}

/// Milling force.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct MillingTable {
    /// Component to the right of the feed, N.
    pub radial_n: f64,
    /// Along the feed, N.
    pub tangential_n: f64,
    /// Along z of the part, N.
    pub axial_n: f64,
}

/// Settings for reading the program.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ReadingTable {
    pub units: Option<UnitsWord>,
    pub arc_tolerance_mm: Option<Spanned<f64>>,
    pub block_delete: Option<BlockDeleteWord>,
    /// A B C U V W stand still while the tool cuts.
    pub axes_stand_still: Option<bool>,
    /// X, Y and Z are places of the tool's tip in the part all along, however rotary axes stand.
    pub tool_centre_point: Option<bool>,
    pub start_position_mm: Option<[f64; 3]>,
    /// Tool point in the part at the machine's zero.
    pub machine_zero_mm: Option<[f64; 3]>,
    /// Reference points, machine coordinates.
    pub g28_mm: Option<[f64; 3]>,
    pub g30_mm: Option<[f64; 3]>,
    pub work_offset_mm: Option<Spanned<BTreeMap<String, [f64; 3]>>>,
}

/// The machine's switch for blocks marked with `/`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, clap::ValueEnum)]
#[serde(rename_all = "snake_case")]
pub(crate) enum BlockDeleteWord {
    /// The marked blocks are run
    Run,
    /// The marked blocks are carried along and not run
    Skip,
}

/// Treatment of arcs that are corrected.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, clap::ValueEnum)]
#[serde(rename_all = "snake_case")]
pub(crate) enum ArcsWord {
    /// Arcs, as few as follow the corrected curve, where the language has them
    Fit,
    /// Straight pieces
    Lines,
}

/// Tolerances of the written program.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct TolerancesTable {
    pub path_um: Option<Spanned<f64>>,
    pub chord_um: Option<Spanned<f64>>,
    pub arcs: Option<ArcsWord>,
    pub decimals: Option<Spanned<u8>>,
    pub min_block_mm: Option<Spanned<f64>>,
    pub max_blocks_per_second: Option<Spanned<f64>>,
    pub max_feed_factor: Option<Spanned<f64>>,
    pub backward_step_um: Option<Spanned<f64>>,
}

/// Outputs.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct OutputTable {
    pub program: Option<Spanned<String>>,
    pub report: Option<Spanned<String>>,
    /// The report as PDF, to be signed and filed.
    pub pdf: Option<Spanned<String>>,
    /// Language of the reports.
    pub language: Option<LanguageWord>,
    /// Number of the part, in the reports and the result.
    pub part_number: Option<Spanned<String>>,
    /// Its revision.
    pub revision: Option<Spanned<String>>,
    pub json: Option<Spanned<String>>,
    pub points: Option<Spanned<String>>,
    /// Path with errors, for ParaView.
    pub vtk: Option<Spanned<String>>,
    /// The flat program, where the program is expanded.
    pub flat_program: Option<Spanned<String>>,
    /// Picture of the turn of the tool, where it is chosen.
    pub turn_plot: Option<Spanned<String>>,
    pub header: Option<bool>,
}

impl Job {
    /// Reads a job file's text.
    pub(crate) fn read(source: Source<'_>) -> Result<Self, Failure> {
        let job: Self = source.read()?;
        Self::version(source, &job)?;
        Ok(job)
    }

    /// The version is one that is read here.
    pub(crate) fn version(source: Source<'_>, job: &Self) -> Result<(), Failure> {
        if *job.schema.get_ref() == SCHEMA {
            return Ok(());
        }
        Err(source.error(
            job.schema.span(),
            &format!(
                "this is version {} of the format; version {SCHEMA} is read here",
                job.schema.get_ref()
            ),
            "use the program that wrote the file, or convert the file",
        ))
    }
}

/// Chatter is judged along the program: `[chatter]`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ChatterTable {
    /// Ratio to critical damping of all modes; without it the model says how it is damped.
    pub damping_ratio: Option<Spanned<f64>>,
    /// Modes above this count by their flexibility at rest, Hz; without it those that do not count.
    pub modes_up_to_hz: Option<Spanned<f64>>,
    /// Places farther apart are judged by themselves, mm.
    pub every_mm: Option<Spanned<f64>>,
    /// Upper limit of the places that are judged.
    pub most_places: Option<Spanned<usize>>,
}

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

/// Table of uncertainties: `[uncertain]`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct UncertainTable {
    /// File of uncertainties (see `kinetostat tolerance --help-all`).
    pub file: Spanned<String>,
    /// Machines that are drawn.
    pub machines: Option<Spanned<usize>>,
    /// Seed of the draws.
    pub seed: Option<u32>,
}
