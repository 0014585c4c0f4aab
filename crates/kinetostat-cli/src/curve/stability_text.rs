//! Summary of a curve in one paragraph: the end of stability, and the range that was traced.

use kinetostat::continuation::BranchEnd;
use kinetostat_machining::number::counted;

use crate::curve::answer::{CurveAnswer, PointAnswer};
use crate::curve::figures::short;

/// Sentences that answer the question.
pub(crate) fn stability_text(a: &CurveAnswer) -> String {
    let mut text = going_away(a);
    let points = a.branches.first().map_or(&[][..], |b| &b.points);
    let swings = points.iter().filter(|p| p.may_flutter).count();
    if swings > 0 {
        text.push_str(&format!(
            " At {swings} of {} on branch 1 it may swing with growing amplitude (flutter): the load has no potential, and that depends on the masses, which are not asked for here.",
            counted(points.len(), "point")
        ));
    }
    text
}

/// States whether and at which point stability is lost.
fn going_away(a: &CurveAnswer) -> String {
    let subject = a.subject;
    let place = |p: &PointAnswer| {
        let u = &a.units;
        let load = if u.load_unit.is_empty() {
            format!("the load factor {}", short(p.shown[1]))
        } else {
            format!("{} {}", short(p.shown[1]), u.load_unit)
        };
        format!("{} {} and {load}", short(p.shown[0]), u.displacement_unit)
    };
    let Some(start) = a.named_points.first().map(|p| &p.point) else {
        return "The curve has no points.".into();
    };
    // 0: under a dead load, 1: while the motion is prescribed.
    let stable =
        |p: &PointAnswer, k: usize| [p.stable_under_dead_load, p.stable_under_prescribed_motion][k];
    let from = |p: &PointAnswer| {
        let k = usize::from(a.grows == "load");
        (p.shown[k] - start.shown[k]).abs()
    };
    // The first end of stability on the start's own branch is a named point, or lies between two
    // points of the curve.
    let end = |k: usize| {
        let named = a
            .named_points
            .iter()
            .filter(|p| p.limits[k] && p.branches.contains(&1))
            .min_by(|p, q| from(&p.point).total_cmp(&from(&q.point)));
        if let Some(p) = named {
            let what = match p.kind {
                "pitchfork" => "buckles",
                "load_limit" | "displacement_limit" => "snaps",
                _ => "loses its stability",
            };
            return Some((what, format!("at {} ({})", place(&p.point), p.name)));
        }
        let points = a.branches.first().map_or(&[][..], |b| &b.points);
        points
            .iter()
            .filter(|p| !stable(p, k))
            .min_by(|p, q| from(p).total_cmp(&from(q)))
            .map(|p| ("does NOT hold", format!("from {} on, or before", place(p))))
    };
    let along = if covers_the_request(a) {
        "all along"
    } else {
        "as far as it was followed"
    };
    if a.grows == "load" {
        return match (stable(start, 0), end(0)) {
            (false, _) => format!("The {subject} does NOT hold at the start under this load."),
            (true, Some((what, place))) => format!("The {subject} {what} {place}."),
            (true, None) => format!("The {subject} holds {along} under this load."),
        };
    }
    let held = stable(start, 1);
    let mut text = match (held, end(1)) {
        (false, _) => {
            format!(
                "The {subject} does NOT keep its shape at the start, although its motion is prescribed."
            )
        }
        (true, Some((what, place))) => format!("The {subject} {what} {place}."),
        (true, None) => format!("The shape holds {along} while the motion is prescribed."),
    };
    match (held, stable(start, 0), end(0)) {
        (true, false, _) => text.push_str(
            " Under a dead load in place of the prescribed motion it would run away at once.",
        ),
        (true, true, Some((what, place))) if end(1) != Some((what, place.clone())) => {
            text.push_str(&format!(
                " Under a dead load in place of the prescribed motion it {what} {place}."
            ));
        }
        _ => {}
    }
    text
}

/// Rounding margin at the ends of a curve.
fn slack(a: &CurveAnswer) -> f64 {
    1e-6 * (a.requested.1 - a.requested.0)
}

/// True if the start's own branch covers the request.
fn covers_the_request(a: &CurveAnswer) -> bool {
    let (low, high) = a.reached;
    low <= a.requested.0 + slack(a) && high >= a.requested.1 - slack(a)
}

/// Says so if the start's own branch does not cover what was requested.
pub(crate) fn reach(a: &CurveAnswer) -> String {
    if covers_the_request(a) {
        return String::new();
    }
    let slack = slack(a);
    let (low, high) = a.reached;
    let unit = if a.grows == "load" {
        "times the load".to_owned()
    } else {
        a.units.displacement_unit.to_owned()
    };
    // A locked coordinate is constant but for rounding.
    let clean = |x: f64| if x.abs() < slack.min(1e-3) { 0.0 } else { x };
    let (low, high) = (short(clean(low)), short(clean(high)));
    let own = a.branches.first();
    if own.is_some_and(|b| b.ends.contains(&BranchEnd::Points)) {
        return format!(
            " Branch 1, the start's own, was followed only from {low} to {high} {unit}: as many points as --points allows, and it may go on."
        );
    }
    format!(" Branch 1, the start's own, reaches only from {low} to {high} {unit}.")
}
