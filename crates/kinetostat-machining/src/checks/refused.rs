//! Reasons for refusing a program: figures of the question, of the written program and of the solved points that are
//! beyond their limits.

use kinetostat::MotionKind;
use kinetostat::number::short;
use kinetostat_program::{Accounting, Knowledge, Move, MoveKind, Path};

use crate::checks::Exceeded;
use crate::checks::correction::corrections;
use crate::checks::load::{loads, numbered, of_law};
use crate::checks::placement::{below_base, note_length};
use crate::joints::most_loaded;
use crate::limits::{Beyond, Limits};
use crate::result::joints::RatingPlace;
use crate::result::point::{PointResult, most, place};
use crate::task::{NoMotion, Task, kinds};
use crate::warning::{Warning, WarningCode};

/// Figures of the question that are beyond their limits.
pub(crate) fn of_task(task: &Task<'_>) -> Vec<Beyond> {
    let limits = &task.bounds.limits;
    let mut exceeded = Exceeded {
        limits,
        found: Vec::new(),
    };
    for (whose, load) in loads(task) {
        let wrench = of_law(load.cutting, &task.placement);
        exceeded.above("force_n", wrench.force().norm(), None, whose.clone());
        exceeded.above("moment_n_m", wrench.moment().norm(), None, whose);
    }
    for tool in &task.bounds.tools {
        note_length(&mut exceeded, tool.length_mm(), &numbered(tool.number));
    }
    exceeded.found.extend(below_base(task));
    exceeded.found.extend(fastest_feed(limits, task.path()));
    if let Some((line, radius_mm)) = task.bounds.widest_zone {
        exceeded.above("zone_mm", radius_mm, Some(line), String::new());
    }
    exceeded.found
}

/// The fastest feed of a path, where it is beyond its limit.
#[must_use]
pub fn fastest_feed(limits: &Limits, path: &Path) -> Option<Beyond> {
    let feeds = path.moves.iter().filter(|m| m.is_known_feed());
    let speeds = feeds.filter_map(|m| Some((m.line, m.feed_mm_per_minute(f64::NAN)? / 60.0)));
    // Feeds per revolution are not known here.
    let known = speeds.filter(|(_, speed)| speed.is_finite());
    let (line, speed) = known.max_by(|a, b| a.1.total_cmp(&b.1))?;
    limits.beyond("speed_mm_per_s", speed, Some(line), "")
}

/// The correction of a written program, and its rate of blocks, where they are beyond their limits.
/// Shared by programs corrected with a model and with a table.
#[must_use]
pub fn of_accounting(limits: &Limits, accounting: &Accounting) -> Vec<Beyond> {
    let mut exceeded = Exceeded {
        limits,
        found: Vec::new(),
    };
    exceeded.above(
        "correction_mm",
        accounting.largest_correction_mm,
        accounting.largest_correction_line,
        String::new(),
    );
    // A program of a few blocks has no row over which a peak is taken: its mean is what is stated of it.
    let before = accounting
        .peak_blocks_per_second_in
        .or(accounting.mean_blocks_per_second_in)
        .unwrap_or(0.0);
    let rate = accounting
        .peak_blocks_per_second
        .or(accounting.mean_blocks_per_second);
    // A program that was that dense before is not made so.
    if let Some(rate) = rate.filter(|r| *r > 1.05 * before) {
        exceeded.above(
            "blocks_per_second",
            rate,
            None,
            "widen the tolerances path_um and chord_um, or cut more slowly".to_owned(),
        );
    }
    exceeded.found
}

/// Place with the largest share of a drive's rating; `None` if no rating is known.
pub(crate) fn share_of_rating(task: &Task<'_>, points: &[PointResult]) -> Option<RatingPlace> {
    let mut worst: Option<RatingPlace> = None;
    for point in points {
        let Some(drive) = most_loaded(&task.bounds.ratings, &point.actuator_force) else {
            continue;
        };
        let share = drive.share_of_rating;
        let larger = |w: RatingPlace| share > w.drive.share_of_rating || share.is_nan();
        if worst.is_none_or(larger) {
            worst = Some(RatingPlace {
                line: point.line,
                position_mm: point.position_mm,
                drive,
            });
        }
    }
    worst
}

/// The largest share of a rating; `None` if no rating is known.
pub(crate) fn largest_share_of_rating(task: &Task<'_>, points: &[PointResult]) -> Option<f64> {
    share_of_rating(task, points).map(|worst| worst.drive.share_of_rating)
}

/// Figures of the answer that are beyond their limits.
pub(crate) fn of_points(task: &Task<'_>, points: &[PointResult]) -> Vec<Beyond> {
    let mut exceeded = Exceeded {
        limits: &task.bounds.limits,
        found: Vec::new(),
    };
    let mut largest = |name: &str, figure: &dyn Fn(&PointResult) -> f64| {
        if let Some((value, at)) = most(points, figure) {
            exceeded.above(name, value, Some(at.line), place(at));
        }
    };
    largest("tilt_deg", &|p| p.residual_rotation_deg);
    largest("share_of_buckling", &|p| p.share_to_buckling.unwrap_or(0.0));
    if let Some(worst) = share_of_rating(task, points) {
        let (share, drive) = (worst.drive.share_of_rating, worst.drive.actuator);
        let name = task.mechanism.actuator_names().get(drive).cloned();
        let rating = task.bounds.ratings.get(drive).copied().flatten();
        let unit = match kinds(task.mechanism).nth(drive) {
            Some(MotionKind::Prismatic) => "N",
            _ => "N m",
        };
        let place = format!(
            "drive {}, {} of {} {unit}",
            name.unwrap_or_default(),
            short(share * rating.unwrap_or(f64::NAN)),
            short(rating.unwrap_or(f64::NAN)),
        );
        exceeded.above("share_of_rating", share, Some(worst.line), place);
    }
    corrections(&mut exceeded, task, points);
    exceeded.found
}

/// Warning for a figure beyond its limit, if nothing is refused.
pub(crate) fn as_warning(beyond: &Beyond) -> Warning {
    // The line is said once, by the warning itself.
    let of_line = Beyond {
        line: None,
        ..beyond.clone()
    };
    Warning {
        line: beyond.line,
        ..Warning::new(WarningCode::OverLimit, of_line.to_string())
    }
}

/// Reason for which the program has no motion that could need a correction; `None` if it has some.
pub(crate) fn no_motion(path: &Path) -> Option<NoMotion> {
    if path.moves.is_empty() {
        return Some(NoMotion::NoMoves);
    }
    if path.moves.iter().any(|m| counts(m, path.stated)) {
        return None;
    }
    Some(if path.stated.contains(&false) {
        NoMotion::UnknownPlace
    } else if path.moves.iter().any(|m| m.kind == MoveKind::Feed) {
        NoMotion::NoLength
    } else {
        NoMotion::NoFeed
    })
}

/// True if the move could be corrected: a rapid from an unknown place only if every axis is stated.
fn counts(motion: &Move, stated: [bool; 3]) -> bool {
    match motion.known {
        Knowledge::Whole => {
            motion.has_length() || motion.kind == MoveKind::Feed && motion.turns_in_place()
        }
        Knowledge::End => motion.kind == MoveKind::Feed || stated == [true; 3],
        Knowledge::Nothing => false,
    }
}
