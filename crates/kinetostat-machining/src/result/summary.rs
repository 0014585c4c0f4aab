//! Figures of a whole run, and of the ways in which its points were solved.

use kinetostat::Mechanism;
use kinetostat::batch::Batch;
use kinetostat::chain::FoundBy;
use kinetostat_program::ShortBlocksOfLine;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::load::ramp_findings::LoadRamp;

/// Figures of a run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema, Deserialize)]
#[non_exhaustive]
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
    /// Moves at a corner that change only the correction; see also `entry_steps`.
    pub corner_steps: usize,
    /// Longest of them, mm.
    pub largest_corner_step_mm: f64,
    /// Steps where a rapid ends: the load is there at once.
    #[serde(default)]
    pub entry_steps: usize,
    /// Longest of them, mm.
    #[serde(default)]
    pub largest_entry_step_mm: f64,
    /// Blocks that are shorter than the controller takes, line by line.
    #[serde(default)]
    pub short_blocks: Vec<ShortBlocksOfLine>,
    /// Fastest change of the correction outside steps; `None` if none was written.
    #[serde(default)]
    pub largest_change_mm_per_mm: Option<LargestChange>,
    /// Length of path over which a stated load comes; `None` if no load is stated.
    #[serde(default)]
    pub load_ramp: Option<LoadRamp>,
    /// True if nothing was to be corrected: the program came back byte for byte.
    #[serde(default)]
    pub unchanged: bool,
    /// True if it came back so because the tool keeps the tolerance as the program is.
    #[serde(default)]
    pub within_tolerance_before: bool,
    /// Displacement of the unloaded tool by the machine's own weight and the loads of its model in cuts, mm, the largest of
    /// [`RunResult::MAX_POSTURES`](crate::RunResult::MAX_POSTURES) places; `None` if nothing acts without a load on the tool.
    #[serde(default)]
    pub max_displacement_by_weight_mm: Option<f64>,
    /// The part of it that counts as an error of the program ([`crate::WeightCorrection`]), mm.
    #[serde(default)]
    pub max_error_by_own_weight_mm: Option<f64>,
    /// Share of the points that lie on corner steps, percent.
    #[serde(default)]
    pub corner_points_percent: f64,
    /// Largest error on corner steps if the load turns evenly while the tool steps, mm; none without
    /// such steps.
    #[serde(default)]
    pub max_corner_error_if_load_turns_mm: Option<f64>,
    /// Largest error there if the load is that of a cut along the step; `None` also if the machine has no equilibrium
    /// under it.
    #[serde(default)]
    pub max_corner_error_if_load_follows_feed_mm: Option<f64>,
    /// Largest way of a step or piece against the direction of motion, mm.
    #[serde(default)]
    pub largest_backward_step_mm: f64,
    /// Steps and pieces that go so by more than `backward_step_limit_mm`.
    #[serde(default)]
    pub backward_steps: usize,
    /// Length from which on they are warned of, mm.
    #[serde(default)]
    pub backward_step_limit_mm: f64,
    /// Maximum allowed feed along the tool's own path, over the programmed one.
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
    /// Maximum block rate per second at programmed feed: `peak_blocks_per_second_after`; `None` if it is not known.
    #[serde(default)]
    pub blocks_per_second: Option<f64>,
    /// Length of the feed path, mm.
    pub feed_length_mm: f64,
    /// Largest distance of the tool from its programmed place without compensation, on cutting moves
    /// (everywhere if none cuts), mm.
    pub max_position_error_before_mm: f64,
    /// Root mean square of it along the path that is cut, every place with its length of path, mm.
    pub rms_position_error_before_mm: f64,
    /// Largest distance for the written program, solved again from its file, mm.
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
    /// Rotation of the unloaded tool from the orientation that it is kept near to, deg, if the orientation follows.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub max_tool_turn_deg: Option<f64>,
    /// Largest deviation of the tool's speed along the part from the programmed one, percent.
    pub max_speed_deviation_percent: f64,
    /// Smallest stiffness of the tool's tip against a force along the path (softest direction, the
    /// tool free to turn), N/mm; infinite where nothing was solved, which JSON has as null.
    #[serde(deserialize_with = "infinite_where_null")]
    #[schemars(with = "Option<f64>")]
    pub smallest_stiffness_n_per_mm: f64,
    /// Largest share of the way to buckling of any limb, mu (1 is buckling, below zero a load that
    /// stretches it); `None` for limbs without inner freedom.
    pub largest_share_to_buckling: Option<f64>,
    /// Largest force or torque of a drive as a share of its rating, 1 is the rating; `None` if the
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
    /// Methods by which the equilibria were found, if not by the usual one.
    #[serde(flatten)]
    pub solving: Solving,
}

/// JSON knows no infinite numbers.
fn infinite_where_null<'de, D: serde::Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
    Ok(Option::deserialize(from)?.unwrap_or(f64::INFINITY))
}

/// The fastest change of the written correction along feed moves, mm per mm of path: of the written positions less their places
/// on the path, over every stretch of a hundred last digits (0.01 mm with four decimals), which rounding makes at most 0.018
/// larger. Steps, where the tool stands at one place of the path, are no part of it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, JsonSchema, Deserialize)]
#[non_exhaustive]
pub struct LargestChange {
    /// Largest change, mm per mm.
    pub value: f64,
    /// Line of the program on which it is.
    pub line: usize,
    /// Largest change that is stated for the load there ([`ProgramLoad::largest_step`](crate::ProgramLoad::largest_step)), mm per mm;
    /// none where any is allowed.
    pub stated: Option<f64>,
    /// Lines on which the change is larger than what is stated for them, by more than rounding makes of it.
    pub lines_beyond: usize,
}

/// Number of places found by one method.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema, Deserialize)]
#[non_exhaustive]
pub struct FoundCount {
    /// Method, not [`FoundBy::Directly`].
    pub found_by: FoundBy,
    /// Places found so.
    pub places: usize,
}

/// Methods by which the equilibria of many places were found, if not by the usual one: directly, and by kernels that
/// take many places at once.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, JsonSchema, Deserialize)]
#[non_exhaustive]
pub struct Solving {
    /// Places that were not found directly.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub found_otherwise: Vec<FoundCount>,
    /// Reason for which every place was solved by itself; `None` if kernels take many at once.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub one_by_one_because: Option<String>,
}

/// Reason for which the places of a machine are solved one by one, if they are: the orientation of its tool `follows`,
/// or no kernel knows the machine.
pub(crate) fn one_by_one_because(
    mechanism: &Mechanism,
    follows: bool,
    loaded: bool,
) -> Option<String> {
    if follows {
        return Some("the orientation of the tool follows from place to place".to_owned());
    }
    let batch = Batch::new(mechanism);
    let engine = match loaded {
        true => batch.engine(),
        false => batch.engine_unloaded(),
    };
    engine.reason().map(ToString::to_string)
}

impl Solving {
    /// Counts places that were found in one way; of those found directly nothing is kept.
    pub fn note(&mut self, found_by: FoundBy, places: usize) {
        if found_by == FoundBy::Directly || places == 0 {
            return;
        }
        let known = self
            .found_otherwise
            .iter_mut()
            .find(|own| own.found_by == found_by);
        match known {
            Some(own) => own.places += places,
            None => self.found_otherwise.push(FoundCount { found_by, places }),
        }
    }

    /// Counts the places of other ones besides.
    pub fn add(&mut self, other: &Self) {
        for own in &other.found_otherwise {
            self.note(own.found_by, own.places);
        }
    }

    /// One sentence for each way, and one for the engine; none where all was as usual. `place`: what is counted, as in
    /// `place` or `point`.
    #[must_use]
    pub fn sentences(&self, place: &str) -> Vec<String> {
        let ways = self.found_otherwise.iter();
        let ways = ways.map(|own| {
            let places = crate::number::counted(own.places, place);
            format!("At {places} {}.", own.found_by.sentence())
        });
        let engine = self.one_by_one_because.iter();
        let engine = engine.map(|why| format!("Every {place} was solved by itself: {why}."));
        ways.chain(engine).collect()
    }
}
