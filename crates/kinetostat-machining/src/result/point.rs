//! One place of the path: what happens there, where the tool is and what the machine carries.

use kinetostat::chain::FoundBy;
use kinetostat::{Pose, Wrench};
use nalgebra::{Isometry3, Vector3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::result::joints::{ArmConfiguration, MostLoaded, NearestLimit};

/// Kind of a point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, JsonSchema, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PointKind {
    /// Point on a cutting move.
    #[default]
    Feed,
    /// Point at the end of a rapid.
    Rapid,
    /// Point on a step at a corner (or inside a cut), where the load turns while the tool stands.
    Corner,
    /// Point on a step where a rapid ends and the load is there at once.
    Entry,
}

impl PointKind {
    /// True if it lies on a step, which only a written program has.
    ///
    /// ```
    /// use kinetostat_machining::PointKind;
    ///
    /// assert!(PointKind::Corner.is_step() && PointKind::Entry.is_step());
    /// assert!(!PointKind::Feed.is_step() && !PointKind::Rapid.is_step());
    /// ```
    #[must_use]
    pub fn is_step(self) -> bool {
        matches!(self, Self::Corner | Self::Entry)
    }
}

/// One point of the path.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema, Deserialize)]
#[non_exhaustive]
pub struct PointResult {
    /// Line of the input program, from 1.
    pub line: usize,
    /// Index of its move in the path.
    #[serde(skip)]
    pub move_index: usize,
    /// Line of the written program, from 1 (0 if none).
    pub output_line: usize,
    /// Kind of move.
    pub kind: PointKind,
    /// The end of a piece; otherwise the middle of one.
    #[serde(skip)]
    pub end: bool,
    /// True for a place at which the program is evaluated as it is given, compensated or not: means without
    /// compensation come from these.
    #[serde(skip)]
    pub programmed: bool,
    /// Length of the path before its move, mm.
    #[serde(skip)]
    pub start_mm: f64,
    /// Share of the move of this line, 0 to 1.
    pub share: f64,
    /// Length of the path up to here, mm.
    pub path_mm: f64,
    /// Desired position of the tool, program coordinates, mm.
    pub position_mm: [f64; 3],
    /// Motion of the part by a table, in the axes of the part where it lies at zero, mm.
    #[serde(skip)]
    pub part_turn: Option<Isometry3<f64>>,
    /// Orientation of the tool in a program that states it, program axes from tool axes: quaternion, scalar first.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tool_orientation: Option<[f64; 4]>,
    /// Position of the tool without compensation minus the desired one, mm.
    pub error_before_mm: [f64; 3],
    /// Error of the written program.
    pub error_after_mm: [f64; 3],
    /// Distance of the tool from where it should be, with the written program, if the force of the cut is larger by the
    /// spread of its coefficients, mm; only where the load is computed from a cut and this was solved.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub error_if_force_larger_mm: Option<f64>,
    /// Error if the force is smaller by the spread.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub error_if_force_smaller_mm: Option<f64>,
    /// Correction written, mm.
    pub correction_mm: [f64; 3],
    /// Load on the tool in program axes: force N.
    pub force_n: [f64; 3],
    /// Load on the tool in program axes: moment about its tip, N m.
    #[serde(default)]
    pub moment_n_m: [f64; 3],
    /// Rotation of the tool that stays, deg.
    pub residual_rotation_deg: f64,
    /// Rotation vector of the unloaded tool from the orientation that it is kept near to, base axes, deg, if the
    /// orientation follows.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tool_turn_deg: Option<[f64; 3]>,
    /// Joint value of every actuator as commanded, mm or deg.
    #[serde(rename = "actuator_command_mm_or_deg", default)]
    pub actuator_command: Vec<f64>,
    /// Force (N) or torque (N m) of every actuator.
    #[serde(rename = "actuator_force_n_or_n_m")]
    pub actuator_force: Vec<f64>,
    /// Change of every actuator by the compensation, mm or deg.
    #[serde(rename = "actuator_correction_mm_or_deg")]
    pub actuator_correction: Vec<f64>,
    /// The joint that is nearest to one of its limits; `None` if no joint has limits.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub nearest_limit: Option<NearestLimit>,
    /// The drive that carries the largest share of its rating; `None` if the model states no rating.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub most_loaded: Option<MostLoaded>,
    /// Configuration of an arm of six axes with a wrist in one point; `None` for other machines.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub configuration: Option<ArmConfiguration>,
    /// Stiffness of the tool's tip against a force in its softest direction, N/mm.
    #[schemars(with = "Option<f64>")]
    pub smallest_stiffness_n_per_mm: f64,
    /// Largest share of the way to buckling of any limb, mu; 1 is buckling.
    pub share_to_buckling: Option<f64>,
    /// The equilibrium is stable.
    pub stable: bool,
    /// Method by which it was found, if not directly.
    #[serde(default, skip_serializing_if = "is_direct")]
    pub found_by: FoundBy,
}

fn is_direct(found_by: &FoundBy) -> bool {
    found_by.unless_directly().is_none()
}

impl PointResult {
    /// Distance of the tool from where it should be, as the program is now, mm.
    #[must_use]
    pub fn off_mm(&self) -> f64 {
        size(&self.error_after_mm)
    }
}

pub(crate) fn size(v: &[f64; 3]) -> f64 {
    Vector3::from(*v).norm()
}

/// The place where a figure is largest; NaN counts as the largest.
pub(crate) fn most(
    points: &[PointResult],
    figure: impl Fn(&PointResult) -> f64,
) -> Option<(f64, &PointResult)> {
    let key = |x: f64| if x.is_nan() { f64::INFINITY } else { x };
    points
        .iter()
        .map(|p| (figure(p), p))
        .max_by(|a, b| key(a.0).total_cmp(&key(b.0)))
}

pub(crate) fn place(point: &PointResult) -> String {
    let [x, y, z] = point.position_mm;
    format!("at X{x:.2} Y{y:.2} Z{z:.2}")
}

/// A place at which a run was solved, as poses of the machine.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct ProgramPlace {
    /// Line of the input program, from 1.
    pub line: usize,
    /// Length of the path up to here, mm.
    pub path_mm: f64,
    /// Index of its move in the path.
    pub move_index: usize,
    /// Share of that move, 0 to 1.
    pub share: f64,
    /// Index of its point among those of the run.
    pub point: usize,
    /// Time at feed from the beginning of the program up to here, s; `None` behind a feed whose speed is not known.
    pub time_s: Option<f64>,
    /// Number of its tool; `None` if the run has one tool for all blocks.
    pub tool: Option<u32>,
    /// Commanded pose of the program as it is: base from tool, m.
    pub programmed: Pose,
    /// Desired pose of the tool: the programmed one, or that in the part as it was measured
    /// ([`crate::WeightCorrection`]).
    pub wanted: Pose,
    /// Commanded pose of the written program; `programmed` without one.
    pub commanded: Pose,
    /// Desired pose of the tool when the written program has turned the part; `wanted` unless a table turns it otherwise.
    pub wanted_as_commanded: Pose,
    /// Wrench on the tool: base axes, about its tip, N and N m.
    pub wrench: Wrench,
    /// Distance of the tool from where it should be, with the program as it is, mm of the program.
    pub error_before_mm: f64,
    /// Distance with the written program.
    pub error_after_mm: f64,
    /// Metres in the machine per millimetre of the program.
    pub metres_per_mm: f64,
    /// Compliance of the tool's tip about the equilibrium there while the tool may turn as it likes, program axes, um/N of the
    /// machine: row by row, the symmetric part. `None` if it was not asked for, nothing holds the tool, or the machine has no
    /// equilibrium.
    pub compliance_um_per_n: Option<[[f64; 3]; 3]>,
}
