//! The inputs of a run, as its result repeats them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::flat_program::FlatProgram;
use crate::load::law::CornerLoad;
use crate::weight_correction::WeightCorrection;

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
