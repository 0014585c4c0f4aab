//! Result of a run: plain data, units in the names; the same structure that `--json` prints, the report draws and
//! `points.csv` lists.

use kinetostat_program::{Accounting, WriteOptions};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::flat_program::FlatProgram;
use crate::load::law::CornerLoad;
use crate::near::NearSingular;
use crate::result::assessment::Assessment;
use crate::result::chatter::ChatterResult;
use crate::result::cutting::CuttingResult;
use crate::result::feature::FeatureResult;
use crate::result::joints::JointsResult;
use crate::result::point::PointResult;
use crate::result::summary::Summary;
use crate::result::tolerance::ToleranceResult;
use crate::result::uncertainty_band::{ForceBand, UncertaintyBand};
use crate::warning::Warning;
use crate::weight_correction::WeightCorrection;

/// Version of this structure; it changes when a name or a meaning changes.
pub const RESULT_SCHEMA: u32 = 2;

/// Result of a run over a program.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema, Deserialize)]
#[non_exhaustive]
pub struct RunResult {
    /// [`RESULT_SCHEMA`] of the program that made it.
    pub schema: u32,
    /// Version of kinetostat that made it.
    pub kinetostat_version: String,
    /// Tolerance to be kept, and the verdict for the written program.
    #[serde(default)]
    pub tolerance: ToleranceResult,
    /// Level of the assessment, and the assumptions behind it, the costliest first.
    #[serde(default)]
    pub assessment: Assessment,
    /// Figures of the whole run.
    pub summary: Summary,
    /// Model, program, load and tolerances of the run.
    #[serde(rename = "question")]
    pub run_inputs: RunInputs,
    /// Figures of the cut along the path, if the load is computed from it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cutting: Option<CuttingResult>,
    /// Chatter of the program; `None` if it is not requested.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub chatter: Option<ChatterResult>,
    /// Errors for a force as far off as its coefficients may be; `None` if the load is not computed from a cut.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub force_band: Option<ForceBand>,
    /// Scatter of the errors for an uncertain machine and force; `None` if nothing is stated to be uncertain.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub uncertainty: Option<UncertaintyBand>,
    /// Results for features of the part, in the order of the job.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub features: Vec<FeatureResult>,
    /// Places with the largest errors before compensation, worst first; at most ten.
    pub worst_points: Vec<PointResult>,
    /// Places that are farthest off with the written program, worst first, one of a line of it; at most ten, none where none was written.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub worst_points_after: Vec<PointResult>,
    /// Everything a person should know and did not ask for.
    pub warnings: Vec<Warning>,
    /// Place nearest to a singular posture, of at most [`Self::MAX_POSTURES`] places along the program (of every part of a long
    /// program two at least); `None` if no singular posture is near.
    #[serde(default)]
    pub near_singularity: Option<NearSingularPlace>,
    /// Limits, ratings and configuration along the program.
    #[serde(default)]
    pub joints: JointsResult,
    /// Points along the path, at most [`Self::MAX_POINTS`] of them: in every stretch those with the
    /// largest and the smallest error before and after, and everywhere those that the summary is
    /// taken from; `points.csv` has all of them.
    pub points: Vec<PointResult>,
}

impl RunResult {
    /// Maximum number of points that are kept for plots.
    pub const MAX_POINTS: usize = 4000;
    /// Maximum number of places whose posture is compared with singular ones.
    pub const MAX_POSTURES: usize = 64;

    /// Error that the written program may have, mm: what was asked for in all, else the tolerance of the path, that of chords where
    /// the program has arcs, and the rounding to decimals. Every statement about the tolerance uses this bound.
    #[must_use]
    pub fn allowed_mm(&self) -> f64 {
        if let Some(asked_mm) = self.run_inputs.asked_mm {
            return asked_mm;
        }
        sum_of_bounds(
            self.run_inputs.tolerance_mm,
            self.run_inputs.chord_tolerance_mm,
            self.summary.feed_arcs,
            self.summary.max_rounding_error_mm,
        )
    }

    /// True if the written program stays within [`Self::allowed_mm`]; `None` if none was written. NaN is beyond any
    /// tolerance.
    #[must_use]
    pub fn holds_tolerance(&self) -> Option<bool> {
        let after = self.summary.max_position_error_after_mm;
        self.run_inputs
            .compensated
            .then(|| after <= self.allowed_mm())
    }
}

/// [`RunResult::allowed_mm`] of a written program whose result is not made yet.
pub(crate) fn bound_mm(writing: &WriteOptions, arcs: usize, accounting: &Accounting) -> f64 {
    sum_of_bounds(
        writing.tolerance_mm,
        writing.chord_tolerance_mm,
        arcs,
        accounting.largest_rounding_mm,
    )
}

/// The tolerance of chords counts where there are arcs.
fn sum_of_bounds(path_mm: f64, chord_mm: f64, arcs: usize, rounding_mm: f64) -> f64 {
    let chord_mm = if arcs > 0 { chord_mm } else { 0.0 };
    let counts = |part: &f64| part.is_finite() && *part > 0.0;
    [path_mm, chord_mm, rounding_mm]
        .into_iter()
        .filter(counts)
        .sum()
}

/// The place of a program that is nearest to a singular posture.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema, Deserialize)]
pub struct NearSingularPlace {
    /// Line of the input program, from 1.
    pub line: usize,
    /// Program coordinates, mm.
    pub position_mm: [f64; 3],
    /// Distance, direction, and what happens there, base axes.
    #[serde(flatten)]
    pub posture: NearSingular,
}

/// Model, program, load and tolerances of a run, in words and numbers.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema, Deserialize)]
#[non_exhaustive]
pub struct RunInputs {
    /// Name of the model.
    pub model: String,
    /// Source of the model: preset or file name.
    pub model_source: String,
    /// Deviations of the actual from the nominal geometry, one sentence each.
    pub model_deviations: Vec<String>,
    /// File name of the program.
    pub program: String,
    /// Number of the part that is made, as the user states it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub part_number: Option<String>,
    /// Revision of the part.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub revision: Option<String>,
    /// The flat program that the run goes along, where the program was run once and written flat.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub flat: Option<FlatProgram>,
    /// Files that were read, with their hashes.
    #[serde(default)]
    pub files: Vec<FileRead>,
    /// Day on which the run was made, `2026-11-20`; `None` if it was not to be stated.
    #[serde(default)]
    pub date: Option<String>,
    /// The stiffnesses of the model, one sentence for each spring or link.
    #[serde(default)]
    pub stiffnesses: Vec<String>,
    /// The program states the orientation of its tool.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub states_orientation: bool,
    /// True if the orientation was corrected, too.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub orientation_corrected: bool,
    /// Orientation of the tool in the base, in words.
    #[serde(default)]
    pub tool_orientation: String,
    /// The load in words.
    pub load: String,
    /// Share of the displacement by own weight that counts as an error; none where nothing was stated.
    #[serde(default, skip_serializing_if = "WeightCorrection::is_not_stated")]
    pub weight: WeightCorrection,
    /// Assumptions about a load that is computed from the cut, one sentence each.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub cut: Vec<String>,
    /// Placement of the program, in words.
    pub placement: String,
    /// The tool in words.
    pub tool: String,
    /// Actuators in the order of the per-actuator lists.
    pub actuators: Vec<ActuatorColumn>,
    /// The machine is an arm of six axes with a wrist in one point, whose configuration is stated at every point.
    #[serde(default)]
    pub has_configuration: bool,
    /// Tolerance of the corrected path, mm.
    pub tolerance_mm: f64,
    /// Requested total tolerance, mm: pieces, chords of arcs and rounding; `None` if each has its own bound.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub asked_mm: Option<f64>,
    /// Origin of this tolerance, in words; empty if it is not known.
    #[serde(default)]
    pub tolerance_from: String,
    /// Tolerance of arcs divided into chords, mm.
    pub chord_tolerance_mm: f64,
    /// Minimum decimals written; numbers of the program that had more keep them.
    pub decimals: u8,
    /// Lower and upper corner of the feed path in program coordinates, mm.
    pub box_min_mm: [f64; 3],
    /// See `box_min_mm`.
    pub box_max_mm: [f64; 3],
    /// True if a compensated program was written.
    pub compensated: bool,
    /// Assumed load while the written program steps at sharp corners.
    #[serde(default)]
    pub load_at_corners: CornerLoad,
    /// True if that was stated, for all tools, and is no assumption.
    #[serde(default)]
    pub corners_stated: bool,
    /// Assumed load for each tool that the program takes by number; empty if there is one tool.
    #[serde(default)]
    pub tools_at_corners: Vec<ToolAtCorners>,
}

/// Assumed load on a tool while the written program steps at sharp corners.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema, Deserialize)]
pub struct ToolAtCorners {
    /// Number in the program's T words.
    pub number: u32,
    /// The reading for its corner steps.
    pub load_at_corners: CornerLoad,
}

/// A file that a run was made from.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, JsonSchema, Deserialize)]
pub struct FileRead {
    /// Kind of the file: `program`, `model`, `job`.
    pub what: String,
    /// Name without directories.
    pub name: String,
    /// SHA-256 of its bytes, hexadecimal.
    pub sha256: String,
}

/// One actuator of the per-actuator lists.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema, Deserialize)]
pub struct ActuatorColumn {
    /// Name of the actuator, as in [`kinetostat::Mechanism::actuator_names`].
    pub name: String,
    /// `mm` or `deg`: unit of corrections.
    pub motion_unit: String,
    /// `N` or `N m`.
    pub force_unit: String,
    /// Smallest and largest command that is allowed, mm or deg; `None` if the model states none.
    #[serde(
        rename = "limits_mm_or_deg",
        default,
        skip_serializing_if = "Option::is_none"
    )]
    pub limits: Option<[f64; 2]>,
    /// Largest force or torque that the model states, N or N m.
    #[serde(
        rename = "rating_n_or_n_m",
        default,
        skip_serializing_if = "Option::is_none"
    )]
    pub rating: Option<f64>,
}
