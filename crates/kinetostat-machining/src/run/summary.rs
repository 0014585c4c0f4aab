//! Figures of a run from its points, from the written program and from the check of that program.

use kinetostat::number::{largest_length, smaller};
use kinetostat_program::{Corrected, Curve, MoveKind, Path};

use crate::checks::own_weight::largest_by_own_weight;
use crate::checks::refused::largest_share_of_rating;
use crate::load::along_path::LoadAlongPath;
use crate::load::law::CornerLoad;
use crate::load::ramp_findings::RampFindings;
use crate::result::figures::per_mm;
use crate::result::point::{PointKind, PointResult, ProgramPlace, size};
use crate::result::summary::{LargestChange, Solving, Summary, one_by_one_because};
use crate::result::uncertainty_band::ForceBand;
use crate::run::largest_change::{Change, Changes};
use crate::task::Task;
use crate::warning::{Warning, WarningCode};

pub(crate) fn summarise(
    task: &Task<'_>,
    points: &[PointResult],
    written: Option<&Corrected>,
    checked: &Checked,
) -> Summary {
    // Errors of rapids are reported only if nothing is cut.
    let cutting: Vec<&PointResult> = match points.iter().any(|p| p.kind != PointKind::Rapid) {
        true => points
            .iter()
            .filter(|p| p.kind != PointKind::Rapid)
            .collect(),
        false => points.iter().collect(),
    };
    // NaN stays visible.
    let larger = |a: f64, b: f64| if b > a || b.is_nan() { b } else { a };
    let most = |f: &dyn Fn(&PointResult) -> f64| cutting.iter().map(|p| f(p)).fold(0.0, larger);
    // The mean without compensation is that of the program's own places, whether another is written or not.
    let programmed: Vec<&PointResult> = cutting.iter().filter(|p| p.programmed).copied().collect();
    let rms = |points: &[&PointResult], f: &dyn Fn(&PointResult) -> f64| {
        along_path(points, |p| f(p).powi(2)).sqrt()
    };
    let before = |p: &PointResult| size(&p.error_before_mm);
    let after = |p: &PointResult| size(&p.error_after_mm);
    let per_actuator = |f: &dyn Fn(&PointResult) -> &Vec<f64>| {
        let count = points.first().map_or(0, |p| f(p).len());
        (0..count)
            .map(|i| most(&|p: &PointResult| f(p)[i].abs()))
            .collect()
    };
    let by_weight = largest_by_own_weight(task, &programmed);
    let mut summary = Summary {
        points: points.len(),
        blocks: task.program.statement_count(),
        bytes_in: task.program.bytes().len(),
        feed_length_mm: task.path().moves[task.path().own_moves()]
            .iter()
            .filter(|m| m.is_known_feed())
            .map(kinetostat_program::Move::length_mm)
            .sum(),
        max_position_error_before_mm: most(&|p| match p.kind {
            // Only a written program has steps.
            PointKind::Corner | PointKind::Entry => 0.0,
            _ => before(p),
        }),
        rms_position_error_before_mm: rms(&programmed, &before),
        max_position_error_after_mm: most(&after),
        rms_position_error_after_mm: rms(&cutting, &after),
        max_correction_mm: most(&|p| size(&p.correction_mm)),
        max_residual_rotation_deg: most(&|p| p.residual_rotation_deg),
        max_speed_deviation_percent: checked.speed_percent,
        max_tool_turn_deg: points
            .iter()
            .filter_map(|p| p.tool_turn_deg.as_ref().map(size))
            .max_by(f64::total_cmp),
        smallest_stiffness_n_per_mm: cutting
            .iter()
            .map(|p| p.smallest_stiffness_n_per_mm)
            .fold(f64::INFINITY, smaller),
        largest_share_to_buckling: cutting
            .iter()
            .filter_map(|p| p.share_to_buckling)
            .max_by(f64::total_cmp),
        largest_share_of_rating: largest_share_of_rating(task, points),
        max_displacement_by_weight_mm: by_weight.map(|[whole, _]| whole),
        max_error_by_own_weight_mm: by_weight.map(|[_, error]| error),
        max_actuator_force: per_actuator(&|p| &p.actuator_force),
        max_actuator_correction: per_actuator(&|p| &p.actuator_correction),
        converged: true,
        stable: points.iter().all(|p| p.stable),
        solving: solving(task, points),
        load_ramp: checked.ramps.ramp,
        ..Summary::default()
    };
    if let Some(written) = written {
        of_what_was_written(&mut summary, task, points, written, checked);
    }
    summary
}

fn solving(task: &Task<'_>, points: &[PointResult]) -> Solving {
    let follows = task.placement.orientation_follows;
    let mut solving = Solving {
        one_by_one_because: one_by_one_because(task.mechanism, follows, true),
        ..Solving::default()
    };
    for point in points {
        solving.note(point.found_by, 1);
    }
    solving
}

/// Blocks, corner steps, feeds, length and time of a written program.
fn of_what_was_written(
    summary: &mut Summary,
    task: &Task<'_>,
    points: &[PointResult],
    written: &Corrected,
    checked: &Checked,
) {
    let a = &written.accounting;
    let corners = || points.iter().filter(|p| p.kind.is_step());
    // Largest error under one reading for all steps: as it was solved where that reading was chosen, and once more
    // elsewhere.
    let by = |reading: CornerLoad, elsewhere: Option<f64>| {
        corners()
            .filter(|p| task.load_on(p.line).at_corners == reading)
            .map(|p| size(&p.error_after_mm))
            .chain(elsewhere)
            .max_by(f64::total_cmp)
            .filter(|mm| mm.is_finite())
    };
    let turns = by(CornerLoad::Turns, checked.if_turns_mm);
    let follows = by(CornerLoad::FollowsFeed, checked.if_follows_mm);
    summary.blocks_out = a.blocks_out;
    summary.blocks_split = a.blocks_split;
    summary.blocks_unchanged = a.blocks_carried;
    summary.bytes_out = a.bytes_out;
    summary.pieces = a.pieces;
    summary.corner_steps = a.corner_steps;
    summary.largest_corner_step_mm = a.largest_corner_step_mm;
    summary.entry_steps = a.entry_steps;
    summary.largest_entry_step_mm = a.largest_entry_step_mm;
    summary.short_blocks.clone_from(&a.short_blocks);
    summary.largest_change_mm_per_mm = of_correction(&checked.changes);
    summary.smallest_piece_mm = a.smallest_piece_mm.unwrap_or(0.0);
    summary.blocks_per_second = a.peak_blocks_per_second;
    summary.max_rounding_error_mm = a.largest_rounding_mm;
    summary.feed_arcs = feed_arcs(task.path());
    summary.unchanged = written.bytes == task.program.bytes();
    summary.within_tolerance_before = checked.within_before;
    summary.corner_points_percent = 100.0 * corners().count() as f64 / points.len().max(1) as f64;
    summary.max_corner_error_if_load_turns_mm = turns;
    summary.max_corner_error_if_load_follows_feed_mm = follows;
    summary.largest_backward_step_mm = a.largest_backward_mm;
    summary.backward_steps = a.backward_steps;
    summary.backward_step_limit_mm = task.writing.backward_step_mm;
    summary.max_feed_factor = task.writing.max_feed_factor;
    summary.feed_limited_pieces = a.feed_limited_pieces;
    summary.feed_limited_line = a.feed_limited_line;
    summary.slowest_limited_speed_percent = a.slowest_limited_speed.map(|share| 100.0 * share);
    summary.feed_length_before_mm = a.feed_length_in_mm;
    summary.feed_length_after_mm = a.feed_length_out_mm;
    summary.feed_time_before_s = a.feed_time_in_s;
    summary.feed_time_after_s = a.feed_time_out_s;
    summary.mean_blocks_per_second_before = a.mean_blocks_per_second_in;
    summary.mean_blocks_per_second_after = a.mean_blocks_per_second;
    summary.peak_blocks_per_second_before = a.peak_blocks_per_second_in;
    summary.peak_blocks_per_second_after = a.peak_blocks_per_second;
}

/// Mean of a value along the path that is cut, by the trapezoidal rule: a piece counts with its length, so that it
/// does not matter into how many pieces a program is divided, nor where they are looked at. The path before the first
/// place of a block counts with that place.
fn along_path(points: &[&PointResult], value: impl Fn(&PointResult) -> f64) -> f64 {
    let (sum, length) = summed_along_path(points, &value);
    if length > 0.0 {
        return sum / length;
    }
    points.iter().map(|p| value(p)).sum::<f64>() / points.len().max(1) as f64
}

/// The sum of which that mean is made, and the length.
pub(crate) fn summed_along_path(
    points: &[&PointResult],
    value: impl Fn(&PointResult) -> f64,
) -> (f64, f64) {
    let (mut sum, mut length) = (0.0, 0.0);
    let first = points.first().filter(|p| p.kind == PointKind::Feed);
    if let Some(first) = first {
        length = first.path_mm - first.start_mm;
        sum = length * value(first);
    }
    for pair in points.windows(2) {
        let [from, to] = [pair[0], pair[1]];
        // A rapid between them is no part of the path.
        let stretch = to.path_mm - from.path_mm.max(to.start_mm);
        if to.kind != PointKind::Feed || stretch <= 0.0 {
            continue;
        }
        // A block's own first place is not looked at: the load turns at a corner.
        let mean = if from.line == to.line && from.kind == PointKind::Feed {
            0.5 * (value(from) + value(to))
        } else {
            value(to)
        };
        sum += stretch * mean;
        length += stretch;
    }
    (sum, length)
}

/// Arcs at feed along a path; of a part those of the whole program.
#[must_use]
pub fn feed_arcs(path: &Path) -> usize {
    if let Some(part) = &path.part {
        return part.whole_feed_arcs;
    }
    let moves = path.moves.iter();
    moves
        .filter(|m| m.kind == MoveKind::Feed && matches!(m.curve, Curve::Arc(_)))
        .count()
}

/// The fastest change of the correction; `None` if it never changes.
pub(crate) fn of_correction(changes: &Changes) -> Option<LargestChange> {
    let worst = changes.worst.filter(|worst| worst.mm_per_mm > 0.0)?;
    Some(LargestChange {
        value: worst.mm_per_mm,
        line: worst.line,
        stated: worst.stated.is_finite().then_some(worst.stated),
        lines_beyond: changes.lines_beyond,
    })
}

/// Warning of a correction that changes faster than stated, at the worst place.
pub(crate) fn changes_faster_than_stated(
    task: &Task<'_>,
    load: &LoadAlongPath<'_>,
    points: &[PointResult],
    checked: &Checked,
) -> Option<Warning> {
    let worst = checked.changes.beyond?;
    let lines = match checked.changes.lines_beyond {
        1 => String::new(),
        n => format!(" (the worst of {n} lines)"),
    };
    let text = format!(
        "the correction changes here by up to {} of path, more than the {} that are stated (largest_step_mm_per_mm){lines}: {}",
        per_mm(worst.mm_per_mm),
        worst.stated,
        reason(task, load, points, checked, &worst)
    );
    let code = WarningCode::CorrectionChangesFast;
    Some(Warning::at_line(code, worst.line, text))
}

fn reason(
    task: &Task<'_>,
    load: &LoadAlongPath<'_>,
    points: &[PointResult],
    checked: &Checked,
    change: &Change,
) -> String {
    let on = |lines: [usize; 2]| lines[0] <= change.line && change.line <= lines[1];
    if let Some(short) = checked.ramps.short.iter().find(|short| on(short.lines)) {
        return format!(
            "between two rapids there are only {} at feed, and the load would come over {}; a longer approach at feed, or a larger step, keeps it",
            largest_length(short.length_mm),
            largest_length(short.needs_mm)
        );
    }
    let wrench = |(i, share)| load.wrench(&task.placement, i, share);
    let [from, to] = change.ends.map(|end| wrench(end).force());
    let turned = (to - from).norm();
    let softest = points.iter().map(|p| p.smallest_stiffness_n_per_mm);
    let most = turned / softest.fold(f64::INFINITY, smaller);
    let way = change.mm_per_mm * change.way_mm;
    if most < 0.5 * way {
        return "the machine gives way differently there from place to place".to_owned();
    }
    match (to.norm() - from.norm()).abs() < 0.5 * turned {
        true => "the direction of the force turns with the feed there, and the correction follows it".to_owned(),
        false => "the size of the force changes there, and the machine gives way more than where it was looked at first".to_owned(),
    }
}

/// Results of the check of a written program besides its points.
#[derive(Clone, Debug, Default)]
pub(crate) struct Checked {
    /// Largest error of the speed along the part where the feed was not limited, percent.
    pub(crate) speed_percent: f64,
    /// Largest error on the corner steps that were not read so, if the load turns evenly there, mm.
    pub(crate) if_turns_mm: Option<f64>,
    /// Largest error on these steps, if the load follows the feed there.
    pub(crate) if_follows_mm: Option<f64>,
    /// The errors with the force larger and smaller by its spread.
    pub(crate) force_band: Option<ForceBand>,
    /// Places that the task asks for.
    pub(crate) places: Vec<ProgramPlace>,
    /// Warning about blocks that were divided again because the tool was found off.
    pub(crate) divided_again: Option<Warning>,
    /// The program as it is keeps the tolerance, and was left so.
    pub(crate) within_before: bool,
    /// Fastest changes of the correction.
    pub(crate) changes: Changes,
    /// Ramps of the load.
    pub(crate) ramps: RampFindings,
}
