//! What a run tells: plain data, units in the names; the same structure that `--json` prints, the
//! report draws and `points.csv` lists.

use kinetostat_program::{Accounting, WriteOptions};
use serde::{Deserialize, Serialize};

use crate::load::CornerLoad;
use crate::near::NearSingular;
use crate::warning::Warning;

/// Version of this structure; it changes when a name or a meaning changes.
pub const RESULT_SCHEMA: u32 = 2;

/// Result of a run over a program.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RunResult {
    /// [`RESULT_SCHEMA`].
    pub schema: u32,
    /// Version of kinetostat that made it.
    pub kinetostat_version: String,
    /// Whether the written program holds the tolerance that it was to hold.
    #[serde(default)]
    pub tolerance: ToleranceVerdict,
    /// Figures of the whole run.
    pub summary: Summary,
    /// What was asked.
    pub question: Question,
    /// Places with the largest errors before compensation, worst first; at most ten.
    pub worst_points: Vec<PointResult>,
    /// Everything a person should know and did not ask for.
    pub warnings: Vec<Warning>,
    /// Where the program comes nearest to a singular posture, of at most
    /// [`Self::MAX_POSTURES`] places along it; none if no singular posture is near.
    #[serde(default)]
    pub near_singularity: Option<NearSingularPlace>,
    /// Points along the path, at most [`Self::MAX_POINTS`] of them: in every stretch those with the
    /// largest and the smallest error before and after, and everywhere those that the summary is
    /// taken from; `points.csv` has all of them.
    pub points: Vec<PointResult>,
}

impl RunResult {
    /// Most points that are kept for plots.
    pub const MAX_POINTS: usize = 4000;
    /// Most places whose posture is compared with singular ones.
    pub const MAX_POSTURES: usize = 64;

    /// Error that the written program may have, mm: the tolerance of the path, that of chords where the program
    /// has arcs, and the rounding to decimals. By this bound it is judged everywhere.
    #[must_use]
    pub fn allowed_mm(&self) -> f64 {
        sum_of_bounds(
            self.question.tolerance_mm,
            (self.question.chord_tolerance_mm, self.summary.feed_arcs),
            self.summary.max_rounding_error_mm,
        )
    }

    /// Whether the written program stays within [`Self::allowed_mm`]; none if none was written. A
    /// figure that is no number holds nothing.
    #[must_use]
    pub fn holds_tolerance(&self) -> Option<bool> {
        let after = self.summary.max_position_error_after_mm;
        self.question
            .compensated
            .then(|| after <= self.allowed_mm())
    }
}

/// [`RunResult::allowed_mm`] of a written program whose result is not made yet.
pub(crate) fn bound_mm(writing: &WriteOptions, arcs: usize, accounting: &Accounting) -> f64 {
    sum_of_bounds(
        writing.tolerance_mm,
        (writing.chord_tolerance_mm, arcs),
        accounting.largest_rounding_mm,
    )
}

/// The tolerance of chords counts where there are arcs.
fn sum_of_bounds(path_mm: f64, (chord_mm, arcs): (f64, usize), rounding_mm: f64) -> f64 {
    let chord_mm = if arcs > 0 { chord_mm } else { 0.0 };
    let counts = |part: &f64| part.is_finite() && *part > 0.0;
    [path_mm, chord_mm, rounding_mm]
        .into_iter()
        .filter(counts)
        .sum()
}

/// How a written program stands to its tolerance.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ToleranceVerdict {
    /// [`RunResult::allowed_mm`].
    pub allowed_mm: f64,
    /// [`RunResult::holds_tolerance`].
    pub held: Option<bool>,
    /// Where it is missed most; none where it is held.
    pub missed: Option<MissedTolerance>,
}

/// The place where a written program is farthest beyond its tolerance.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MissedTolerance {
    /// Line of the input program, from 1.
    pub line: usize,
    /// Line of the written program, from 1.
    pub output_line: usize,
    /// Where the tool should be, program coordinates, mm.
    pub position_mm: [f64; 3],
    /// Distance of the tool from it, mm.
    pub error_mm: f64,
    /// Why, and what can be done.
    pub reason: String,
}

/// The place of a program that is nearest to a singular posture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct NearSingularPlace {
    /// Line of the input program, from 1.
    pub line: usize,
    /// Program coordinates, mm.
    pub position_mm: [f64; 3],
    /// Distance, direction, and what happens there, base axes.
    #[serde(flatten)]
    pub posture: NearSingular,
}

/// What was asked of the run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Question {
    /// Name of the model.
    pub model: String,
    /// Where it came from: preset or file name.
    pub model_source: String,
    /// Deviations of the actual from the nominal geometry, one sentence each.
    pub model_deviations: Vec<String>,
    /// File name of the program.
    pub program: String,
    /// Files that were read, with their hashes.
    #[serde(default)]
    pub files: Vec<FileRead>,
    /// Day on which the run was made, `2026-11-20`; none where it was not to be stated.
    #[serde(default)]
    pub date: Option<String>,
    /// The stiffnesses of the model, one sentence for each spring or link.
    #[serde(default)]
    pub stiffnesses: Vec<String>,
    /// Orientation of the tool in the base, in words.
    #[serde(default)]
    pub tool_orientation: String,
    /// The load in words.
    pub load: String,
    /// Where the program lies, in words.
    pub placement: String,
    /// The tool in words.
    pub tool: String,
    /// Actuators in the order of the per-actuator lists.
    pub actuators: Vec<ActuatorColumn>,
    /// Tolerance of the corrected path, mm.
    pub tolerance_mm: f64,
    /// Where this tolerance comes from, in words; empty where it is not known.
    #[serde(default)]
    pub tolerance_from: String,
    /// Tolerance of arcs divided into chords, mm.
    pub chord_tolerance_mm: f64,
    /// Decimals written.
    pub decimals: u8,
    /// Lower and upper corner of the feed path in program coordinates, mm.
    pub box_min_mm: [f64; 3],
    /// See `box_min_mm`.
    pub box_max_mm: [f64; 3],
    /// True if a compensated program was written.
    pub compensated: bool,
    /// What the load is taken to be while the written program steps at sharp corners.
    #[serde(default)]
    pub load_at_corners: CornerLoad,
    /// The same for each tool that the program takes by number; empty where there is one tool.
    #[serde(default)]
    pub tools_at_corners: Vec<ToolAtCorners>,
}

/// What the load on a tool is taken to be while the written program steps at sharp corners.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ToolAtCorners {
    /// Number in the program's T words.
    pub number: u32,
    /// The reading for its corner steps.
    pub load_at_corners: CornerLoad,
}

/// A file that a run was made from.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct FileRead {
    /// What it is: `program`, `model`, `job`.
    pub what: String,
    /// Its name without directories.
    pub name: String,
    /// SHA-256 of its bytes, hexadecimal.
    pub sha256: String,
}

/// One actuator of the per-actuator lists.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ActuatorColumn {
    /// Name.
    pub name: String,
    /// `mm` or `deg`: unit of corrections.
    pub motion_unit: String,
    /// `N` or `N m`.
    pub force_unit: String,
}

/// Figures of a run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// Points of the path that were solved.
    pub points: usize,
    /// Blocks of the input program.
    pub blocks: usize,
    /// Blocks of the written program (0 if none was written).
    pub blocks_out: usize,
    /// Blocks that were divided.
    pub blocks_split: usize,
    /// Blocks carried over byte for byte.
    pub blocks_unchanged: usize,
    /// Bytes of the input program.
    pub bytes_in: usize,
    /// Bytes of the written program.
    pub bytes_out: usize,
    /// Straight pieces written for feed moves.
    pub pieces: usize,
    /// Moves at a corner that change only the correction.
    pub corner_steps: usize,
    /// Longest of them, mm.
    pub largest_corner_step_mm: f64,
    /// Nothing was to be corrected: the program came back byte for byte.
    #[serde(default)]
    pub unchanged: bool,
    /// It came back so because the tool keeps the tolerance as the program is.
    #[serde(default)]
    pub within_tolerance_before: bool,
    /// How far the machine's own weight and the loads of its model put the tool off by themselves where it
    /// cuts, mm, the largest of [`RunResult::MAX_POSTURES`] places; none where nothing acts without a load on
    /// the tool.
    #[serde(default)]
    pub max_error_by_own_weight_mm: Option<f64>,
    /// Share of the points that lie on corner steps, percent.
    #[serde(default)]
    pub corner_points_percent: f64,
    /// Largest error on corner steps if the load turns evenly while the tool steps, mm; none without
    /// such steps.
    #[serde(default)]
    pub max_corner_error_if_load_turns_mm: Option<f64>,
    /// The same if the load there is that of a cut along the step; none also where the machine has no
    /// equilibrium under it.
    #[serde(default)]
    pub max_corner_error_if_load_follows_feed_mm: Option<f64>,
    /// Largest way of a step or piece against the direction of motion, mm.
    #[serde(default)]
    pub largest_backward_step_mm: f64,
    /// Steps and pieces that go so by more than `backward_step_limit_mm`.
    #[serde(default)]
    pub backward_steps: usize,
    /// From which length on they are warned of, mm.
    #[serde(default)]
    pub backward_step_limit_mm: f64,
    /// How many times the programmed feed was allowed at most along the tool's own path.
    #[serde(default)]
    pub max_feed_factor: f64,
    /// Pieces whose feed was held to that: they are slower along the part than programmed, and not
    /// part of `max_speed_deviation_percent`.
    #[serde(default)]
    pub feed_limited_pieces: usize,
    /// Line of the program with the first of them.
    #[serde(default)]
    pub feed_limited_line: Option<usize>,
    /// Slowest speed along the part on them, percent of the programmed one.
    #[serde(default)]
    pub slowest_limited_speed_percent: Option<f64>,
    /// Length of the program's feed moves from known places, mm.
    #[serde(default)]
    pub feed_length_before_mm: f64,
    /// Length of what is written for them, steps included, mm.
    #[serde(default)]
    pub feed_length_after_mm: f64,
    /// Time of the feed moves at the programmed feeds, without acceleration, s; none without feeds
    /// per minute.
    #[serde(default)]
    pub feed_time_before_s: Option<f64>,
    /// Time of what is written for them at the feeds written, s.
    #[serde(default)]
    pub feed_time_after_s: Option<f64>,
    /// Feed blocks per second on average.
    #[serde(default)]
    pub mean_blocks_per_second_before: Option<f64>,
    /// See `mean_blocks_per_second_before`.
    #[serde(default)]
    pub mean_blocks_per_second_after: Option<f64>,
    /// Feed blocks per second over the densest sixteen in a row.
    #[serde(default)]
    pub peak_blocks_per_second_before: Option<f64>,
    /// See `peak_blocks_per_second_before`.
    #[serde(default)]
    pub peak_blocks_per_second_after: Option<f64>,
    /// Shortest piece written, mm.
    pub smallest_piece_mm: f64,
    /// Most blocks per second at programmed feed: `peak_blocks_per_second_after`; none where that is not known.
    #[serde(default)]
    pub blocks_per_second: Option<f64>,
    /// Length of the feed path, mm.
    pub feed_length_mm: f64,
    /// Largest distance of the tool from its programmed place without compensation, on cutting moves
    /// (everywhere if none cuts), mm.
    pub max_position_error_before_mm: f64,
    /// Root mean square of it along the path that is cut, every place with its length of path, mm.
    pub rms_position_error_before_mm: f64,
    /// The same for the written program, solved again from its file, mm.
    pub max_position_error_after_mm: f64,
    /// See `max_position_error_after_mm`.
    pub rms_position_error_after_mm: f64,
    /// Arcs at feed in the program: without them no chord is written, and none is allowed for.
    #[serde(default)]
    pub feed_arcs: usize,
    /// Share of the after-error that comes from the decimals written, mm.
    pub max_rounding_error_mm: f64,
    /// Largest correction, mm.
    pub max_correction_mm: f64,
    /// Largest rotation of the tool that a program of positions cannot correct, deg.
    pub max_residual_rotation_deg: f64,
    /// Where the orientation follows: how far the unloaded tool turns from the orientation that it
    /// is kept near to, deg.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub max_tool_turn_deg: Option<f64>,
    /// Largest deviation of the tool's speed along the part from the programmed one, percent.
    pub max_speed_deviation_percent: f64,
    /// Smallest stiffness of the tool's tip against a force along the path (softest direction, the
    /// tool free to turn), N/mm.
    pub smallest_stiffness_n_per_mm: f64,
    /// Largest share of the way to buckling of any limb, mu (1 is buckling, below zero a load that
    /// stretches it); none for limbs without inner freedom.
    pub largest_share_to_buckling: Option<f64>,
    /// Largest force or torque of a drive as a share of its rating, 1 is the rating; none where the
    /// model states no rating.
    #[serde(default)]
    pub largest_share_of_rating: Option<f64>,
    /// Largest force or torque of each actuator (N or N m), in the order of `question.actuators`.
    #[serde(rename = "max_actuator_force_n_or_n_m")]
    pub max_actuator_force: Vec<f64>,
    /// Largest change of each actuator (mm or deg).
    #[serde(rename = "max_actuator_correction_mm_or_deg")]
    pub max_actuator_correction: Vec<f64>,
    /// Every point converged.
    pub converged: bool,
    /// Every equilibrium is stable, shapes and platform.
    pub stable: bool,
}

/// What happens at a point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PointKind {
    /// On a cutting move.
    #[default]
    Feed,
    /// At the end of a rapid.
    Rapid,
    /// On a corner step, where the load turns while the tool stands.
    Corner,
}

/// One point of the path.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PointResult {
    /// Line of the input program, from 1.
    pub line: usize,
    /// Line of the written program, from 1 (0 if none).
    pub output_line: usize,
    /// Kind of move.
    pub kind: PointKind,
    /// The end of a piece; otherwise the middle of one.
    #[serde(skip)]
    pub end: bool,
    /// One of the places at which the program is looked at as it is given, compensated or not: figures
    /// without compensation come from these.
    #[serde(skip)]
    pub programmed: bool,
    /// Length of the path before its move, mm.
    #[serde(skip)]
    pub start_mm: f64,
    /// Share of the move of this line, 0 to 1.
    pub share: f64,
    /// Length of the path up to here, mm.
    pub path_mm: f64,
    /// Where the tool should be, program coordinates, mm.
    pub position_mm: [f64; 3],
    /// Where the tool is without compensation minus where it should be, mm.
    pub error_before_mm: [f64; 3],
    /// The same for the written program.
    pub error_after_mm: [f64; 3],
    /// Correction written, mm.
    pub correction_mm: [f64; 3],
    /// Load on the tool in program axes: force N.
    pub force_n: [f64; 3],
    /// Rotation of the tool that stays, deg.
    pub residual_rotation_deg: f64,
    /// Where the orientation follows: rotation vector of the unloaded tool from the orientation that
    /// it is kept near to, base axes, deg.
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
    /// Stiffness of the tool's tip against a force in its softest direction, N/mm.
    pub smallest_stiffness_n_per_mm: f64,
    /// Largest share of the way to buckling of any limb, mu; 1 is buckling.
    pub share_to_buckling: Option<f64>,
    /// The equilibrium is stable.
    pub stable: bool,
}
