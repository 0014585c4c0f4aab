//! The result of a long program, put together from those of its parts: nothing grows with the length of the program.

use kinetostat::MotionKind;
use kinetostat::number::{larger, smaller};
use serde::{Deserialize, Serialize};

use crate::near::natural_length;
use crate::result::assessment::AssumptionKind;
use crate::result::joints::{JointsResult, LimitPlace};
use crate::result::point::{PointKind, PointResult, size};
use crate::result::run_result::RunResult;
use crate::result::selection::{farthest_off, thinned, worst};
use crate::result::summary::Summary;
use crate::result::tolerance::{MissedTolerance, keeps_as_it_is};
use crate::run::conclude::Run;
use crate::run::merged_warnings::MergedWarnings;
use crate::run::summary::summed_along_path;
use crate::task::{Task, kinds};
use crate::warning::Warning;

/// Lines with blocks that are too short, that are kept.
const MOST_SHORT: usize = 1000;

/// A mean along the path that is being made: of squares.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Mean {
    sum: f64,
    length_mm: f64,
}

impl Mean {
    fn add(&mut self, points: &[&PointResult], value: impl Fn(&PointResult) -> f64) {
        let (sum, length) = summed_along_path(points, |p| value(p).powi(2));
        self.sum += sum;
        self.length_mm += length;
    }

    fn root(self) -> f64 {
        match self.length_mm > 0.0 {
            true => (self.sum / self.length_mm).sqrt(),
            false => 0.0,
        }
    }
}

/// The result of a long program as far as its parts are done. It is written down between two of them, so that a run that was
/// interrupted goes on.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MergedRun {
    result: Option<RunResult>,
    parts: usize,
    before: Mean,
    after: Mean,
    blocks_corrected: usize,
    corner_points: f64,
    feed_blocks_in: f64,
    feed_blocks_out: f64,
    box_mm: Option<[[f64; 3]; 2]>,
    worst: Vec<PointResult>,
    worst_after: Vec<PointResult>,
    points: Vec<PointResult>,
    warnings: MergedWarnings,
}

impl MergedRun {
    /// Parts that are done.
    #[must_use]
    pub fn parts(&self) -> usize {
        self.parts
    }

    /// Takes turning joints of the next part on from where the last one left them; says whether that changed its points.
    pub fn join(&self, task: &Task<'_>, run: &mut Run) -> bool {
        // The last point of a part is always kept.
        let last = self.points.last();
        last.is_some_and(|last| run.go_on_from(task, &last.actuator_command))
    }

    /// Takes the next part.
    pub fn add(&mut self, task: &Task<'_>, run: &Run) {
        self.parts += 1;
        let cutting = |p: &&PointResult| p.kind != PointKind::Rapid;
        let cut: Vec<&PointResult> = run.points.iter().filter(cutting).collect();
        let programmed: Vec<&PointResult> = cut.iter().filter(|p| p.programmed).copied().collect();
        self.before.add(&programmed, |p| size(&p.error_before_mm));
        self.after.add(&cut, |p| size(&p.error_after_mm));
        for point in &cut {
            let at = point.position_mm;
            let [low, high] = self.box_mm.get_or_insert([at, at]);
            for axis in 0..3 {
                low[axis] = smaller(low[axis], at[axis]);
                high[axis] = larger(high[axis], at[axis]);
            }
        }
        if let Some(written) = &run.written {
            self.blocks_corrected += written.accounting.blocks_corrected;
        }
        let s = &run.result.summary;
        self.corner_points += s.corner_points_percent * s.points as f64;
        let blocks = |seconds: Option<f64>, rate: Option<f64>| {
            seconds
                .zip(rate)
                .map_or(0.0, |(seconds, rate)| seconds * rate)
        };
        self.feed_blocks_in += blocks(s.feed_time_before_s, s.mean_blocks_per_second_before);
        self.feed_blocks_out += blocks(s.feed_time_after_s, s.mean_blocks_per_second_after);
        self.worst.extend(run.result.worst_points.iter().cloned());
        let chosen = worst(&self.worst);
        // Places of this part may be near those of the next one: more are kept than are listed.
        if self.worst.len() > 60 {
            self.worst = chosen.iter().map(|i| self.worst[*i].clone()).collect();
        }
        self.worst_after
            .extend(run.result.worst_points_after.iter().cloned());
        let farthest = farthest_off(&self.worst_after);
        self.worst_after = farthest
            .iter()
            .map(|i| self.worst_after[*i].clone())
            .collect();
        let kept = thinned(&run.points, &[], RunResult::MAX_POINTS / 16);
        self.points
            .extend(kept.iter().map(|i| run.points[*i].clone()));
        if self.points.len() > 2 * RunResult::MAX_POINTS {
            let kept = thinned(&self.points, &[], RunResult::MAX_POINTS);
            self.points = kept.iter().map(|i| self.points[*i].clone()).collect();
        }
        let next = RunResult {
            points: Vec::new(),
            worst_points: Vec::new(),
            worst_points_after: Vec::new(),
            warnings: Vec::new(),
            ..run.result.clone()
        };
        let result = match self.result.take() {
            None => next,
            Some(mut result) => {
                merge(task, &mut result, next);
                result
            }
        };
        let whole = &result.summary;
        self.warnings.add(task, self.parts, run, whole);
        self.result = Some(result);
    }

    /// True if the program is to be left as it is: it keeps its tolerance so, or no correction reaches the last digit.
    #[must_use]
    pub fn leaves_as_it_is(&self) -> bool {
        let Some(result) = self.result.as_ref().filter(|r| r.run_inputs.compensated) else {
            return false;
        };
        let s = &result.summary;
        let (before, after) = (
            s.max_position_error_before_mm,
            s.max_position_error_after_mm,
        );
        let tolerance = result.run_inputs.tolerance_mm;
        self.blocks_corrected == 0 || keeps_as_it_is(before, after, tolerance, result.allowed_mm())
    }

    /// The result of the whole; `None` if no part was taken. `reading` is what the reader of the whole warns of.
    #[must_use]
    pub fn finish(mut self, reading: Vec<Warning>) -> Option<RunResult> {
        let mut result = self.result.take()?;
        let s = &mut result.summary;
        s.rms_position_error_before_mm = self.before.root();
        s.rms_position_error_after_mm = self.after.root();
        s.corner_points_percent = self.corner_points / s.points.max(1) as f64;
        let mean = |blocks: f64, seconds: Option<f64>| {
            seconds
                .filter(|s| *s > 0.0 && blocks > 0.0)
                .map(|seconds| blocks / seconds)
        };
        s.mean_blocks_per_second_before = mean(self.feed_blocks_in, s.feed_time_before_s);
        s.mean_blocks_per_second_after = mean(self.feed_blocks_out, s.feed_time_after_s);
        s.unchanged = result.run_inputs.compensated && self.blocks_corrected == 0;
        if let Some([low, high]) = self.box_mm {
            (result.run_inputs.box_min_mm, result.run_inputs.box_max_mm) = (low, high);
        }
        result.tolerance.allowed_mm = result.allowed_mm();
        result.tolerance.held = result.holds_tolerance();
        if result.tolerance.held != Some(false) {
            result.tolerance.missed = None;
        }
        let chosen = worst(&self.worst);
        result.worst_points_after = self.worst_after;
        result.worst_points = chosen.iter().map(|i| self.worst[*i].clone()).collect();
        let kept = thinned(&self.points, &[], RunResult::MAX_POINTS);
        result.points = kept.iter().map(|i| self.points[*i].clone()).collect();
        result.warnings = reading;
        result.warnings.extend(self.warnings.finish());
        result.assess();
        Some(result)
    }
}

fn most(own: &mut f64, next: f64) {
    *own = larger(*own, next);
}

fn most_of(own: &mut Option<f64>, next: Option<f64>) {
    *own = [*own, next].into_iter().flatten().max_by(f64::total_cmp);
}

fn sum_of(own: &mut Option<f64>, next: Option<f64>) {
    if let Some(next) = next {
        *own = Some(own.unwrap_or(0.0) + next);
    }
}

/// Takes the result of the next part into that of those before it.
fn merge(task: &Task<'_>, own: &mut RunResult, next: RunResult) {
    for kind in [AssumptionKind::UnjudgedFeeds, AssumptionKind::OutsideCalls] {
        let of_kind = |of: &RunResult| {
            let mut all = of.assessment.assumptions.iter();
            all.find(|one| one.kind == kind).cloned()
        };
        if let (None, Some(added)) = (of_kind(own), of_kind(&next)) {
            own.assessment.assumptions.push(added);
        }
    }
    if next.summary.points == 0 && next.summary.blocks_out == 0 {
        // Comments have a length, and figures of nothing are none.
        own.summary.blocks += next.summary.blocks;
        own.summary.bytes_in += next.summary.bytes_in;
        own.summary.bytes_out += next.summary.bytes_out;
        return;
    }
    summary(&mut own.summary, &next.summary);
    joints(task, &mut own.joints, next.joints);
    own.run_inputs.states_orientation |= next.run_inputs.states_orientation;
    own.run_inputs.has_configuration |= next.run_inputs.has_configuration;
    own.near_singularity = match (own.near_singularity.take(), next.near_singularity) {
        (Some(a), Some(b)) if b.posture.distance_mm < a.posture.distance_mm => Some(b),
        (a, b) => a.or(b),
    };
    let error =
        |missed: &Option<MissedTolerance>| missed.as_ref().map_or(0.0, |missed| missed.error_mm);
    if error(&next.tolerance.missed) > error(&own.tolerance.missed) {
        own.tolerance.missed = next.tolerance.missed;
    }
}

fn summary(own: &mut Summary, next: &Summary) {
    own.points += next.points;
    own.blocks += next.blocks;
    own.blocks_out += next.blocks_out;
    own.blocks_split += next.blocks_split;
    own.blocks_unchanged += next.blocks_unchanged;
    own.bytes_in += next.bytes_in;
    own.bytes_out += next.bytes_out;
    own.pieces += next.pieces;
    own.corner_steps += next.corner_steps;
    own.entry_steps += next.entry_steps;
    own.backward_steps += next.backward_steps;
    own.feed_limited_pieces += next.feed_limited_pieces;
    own.feed_limited_line = own.feed_limited_line.or(next.feed_limited_line);
    own.feed_length_before_mm += next.feed_length_before_mm;
    own.feed_length_after_mm += next.feed_length_after_mm;
    own.feed_length_mm += next.feed_length_mm;
    let room = MOST_SHORT.saturating_sub(own.short_blocks.len());
    own.short_blocks.extend(next.short_blocks.iter().take(room));
    if let Some(change) = next.largest_change_mm_per_mm {
        let lines =
            own.largest_change_mm_per_mm.map_or(0, |c| c.lines_beyond) + change.lines_beyond;
        let largest = own
            .largest_change_mm_per_mm
            .filter(|c| c.value >= change.value);
        let mut largest = largest.unwrap_or(change);
        largest.lines_beyond = lines;
        own.largest_change_mm_per_mm = Some(largest);
    }
    own.load_ramp = match (own.load_ramp, next.load_ramp) {
        (Some(a), Some(b)) if b.length_mm > a.length_mm => Some(b),
        (a, b) => a.or(b),
    };
    sum_of(&mut own.feed_time_before_s, next.feed_time_before_s);
    sum_of(&mut own.feed_time_after_s, next.feed_time_after_s);
    largest_figures(own, next);
    // The length is 0 for parts that divide nothing.
    own.smallest_piece_mm = match (own.smallest_piece_mm > 0.0, next.smallest_piece_mm > 0.0) {
        (true, true) => smaller(own.smallest_piece_mm, next.smallest_piece_mm),
        _ => larger(own.smallest_piece_mm, next.smallest_piece_mm),
    };
    own.slowest_limited_speed_percent = own
        .slowest_limited_speed_percent
        .into_iter()
        .chain(next.slowest_limited_speed_percent)
        .min_by(f64::total_cmp);
    own.smallest_stiffness_n_per_mm = smaller(
        own.smallest_stiffness_n_per_mm,
        next.smallest_stiffness_n_per_mm,
    );
    own.stable &= next.stable;
    own.converged &= next.converged;
    own.solving.add(&next.solving);
}

/// Takes a field of `$next` into the same field of `$own` by a function, for each field listed.
macro_rules! fields {
    ($take:ident($own:ident, $next:ident): $($field:ident,)+) => {
        $($take(&mut $own.$field, $next.$field);)+
    };
}

fn largest_figures(own: &mut Summary, next: &Summary) {
    fields!(most(own, next):
        largest_corner_step_mm,
        largest_entry_step_mm,
        largest_backward_step_mm,
        max_position_error_before_mm,
        max_position_error_after_mm,
        max_rounding_error_mm,
        max_correction_mm,
        max_residual_rotation_deg,
        max_speed_deviation_percent,
    );
    fields!(most_of(own, next):
        max_displacement_by_weight_mm,
        max_error_by_own_weight_mm,
        max_corner_error_if_load_turns_mm,
        max_corner_error_if_load_follows_feed_mm,
        peak_blocks_per_second_before,
        peak_blocks_per_second_after,
        blocks_per_second,
        max_tool_turn_deg,
        largest_share_to_buckling,
        largest_share_of_rating,
    );
    for (own, next) in [
        (&mut own.max_actuator_force, &next.max_actuator_force),
        (
            &mut own.max_actuator_correction,
            &next.max_actuator_correction,
        ),
    ] {
        if own.is_empty() {
            own.clone_from(next);
        }
        own.iter_mut()
            .zip(next)
            .for_each(|(own, next)| most(own, *next));
    }
}

fn joints(task: &Task<'_>, own: &mut JointsResult, next: JointsResult) {
    if own.ranges.is_empty() {
        own.ranges.clone_from(&next.ranges);
    }
    for ([low, high], [from, to]) in own.ranges.iter_mut().zip(&next.ranges) {
        (*low, *high) = (smaller(*low, *from), larger(*high, *to));
    }
    let mm_per_deg = 1e3 * natural_length(task.mechanism) * 1_f64.to_radians();
    let kinds: Vec<MotionKind> = kinds(task.mechanism).collect();
    own.nearest_limit = match (own.nearest_limit.take(), next.nearest_limit) {
        (Some(a), Some(b)) => {
            let far = |place: &LimitPlace| match kinds.get(place.limit.actuator) {
                Some(MotionKind::Revolute) => mm_per_deg * place.limit.distance,
                _ => place.limit.distance,
            };
            Some(if far(&b) < far(&a) { b } else { a })
        }
        (a, b) => a.or(b),
    };
    own.most_loaded = match (own.most_loaded.take(), next.most_loaded) {
        (Some(a), Some(b)) if b.drive.share_of_rating > a.drive.share_of_rating => Some(b),
        (a, b) => a.or(b),
    };
    own.configuration = own.configuration.take().or(next.configuration);
    let room = JointsResult::MAX_CHANGES.saturating_sub(own.changes.len());
    own.changes.extend(next.changes.into_iter().take(room));
    own.change_count += next.change_count;
    own.way_out = own.way_out.or(next.way_out);
}
