//! Corrections that change faster than stated for the load: amount, number of lines, and reason.

use kinetostat::number::{largest_length, smaller};

use crate::load::along_path::LoadAlongPath;
use crate::result::figures::per_mm;
use crate::result::largest_change::LargestChange;
use crate::result::point::PointResult;
use crate::run::checked::Checked;
use crate::run::largest_change::{Change, Changes};
use crate::task::Task;
use crate::warning::{Warning, WarningCode};

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
