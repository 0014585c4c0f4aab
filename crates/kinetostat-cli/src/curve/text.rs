//! The answer of `curve` for a person.

use kinetostat::BranchEnd;
use kinetostat_machining::number::{counted, share};

use crate::curve::answer::{CriticalAnswer, CurveAnswer, NamedPoint, PointAnswer, kind_in_words};
use crate::ui::layout::{columns, item, wrapped};
use crate::ui::numbers::number;
use crate::ui::warnings;

/// More ends of branches than this are only counted.
const MOST_ENDS: usize = 6;

pub(crate) fn in_words(heading: &str, a: &CurveAnswer) -> String {
    let mut out = heading.to_owned();
    out.push_str(&wrapped(&a.question, 0));
    out.push('\n');
    out.push_str(&wrapped(&format!("{}{}", verdict(a), reach(a)), 2));
    out.push('\n');
    out.push_str(&table(a));
    out.push('\n');
    for p in a.named_points.iter().filter(|p| p.kind != "end") {
        out.push_str(&item(&point_in_words(p)));
    }
    out.push_str(&ends(a));
    out.push_str(&jumps(a));
    out.push_str(&critical(a));
    out.push_str(&branches(a));
    if !a.conservative {
        out.push('\n');
        out.push_str(&wrapped(
            "Some loads have no potential, so a verdict on stability says that small pushes die away quasi-statically, not that an energy is least.",
            0,
        ));
    }
    out.push_str(&warnings::warnings(&a.warnings));
    out
}

/// Sentences that answer the question.
fn verdict(a: &CurveAnswer) -> String {
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

/// Whether and where it goes away.
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
    // What ends stability first on the start's own branch: a named point, or somewhere between two
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
    let along = if covers_what_was_asked(a) {
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

/// What the ends of a curve may miss by rounding.
fn slack(a: &CurveAnswer) -> f64 {
    1e-6 * (a.asked.1 - a.asked.0)
}

/// Whether the start's own branch covers what was asked.
fn covers_what_was_asked(a: &CurveAnswer) -> bool {
    let (low, high) = a.reached;
    low <= a.asked.0 + slack(a) && high >= a.asked.1 - slack(a)
}

/// Says so if the start's own branch does not cover what was asked.
fn reach(a: &CurveAnswer) -> String {
    if covers_what_was_asked(a) {
        return String::new();
    }
    let slack = slack(a);
    let (low, high) = a.reached;
    let unit = if a.grows == "load" {
        "times the load".to_owned()
    } else {
        a.units.displacement_unit.to_owned()
    };
    // What is locked stays at its place but for rounding.
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

fn table(a: &CurveAnswer) -> String {
    let u = &a.units;
    let unit = |name: &str, unit: &str| {
        if unit.is_empty() {
            name.to_owned()
        } else {
            format!("{name}, {unit}")
        }
    };
    let mut header = vec![
        "point".to_owned(),
        unit(u.displacement, u.displacement_unit),
        unit(u.load, u.load_unit),
        unit("slope", u.slope_unit),
        "dead load".to_owned(),
        "held".to_owned(),
    ];
    let factor = a.grows == "load" && !u.load_unit.is_empty();
    if factor {
        header.insert(1, "factor".to_owned());
    }
    let size = |k: usize| {
        a.named_points
            .iter()
            .map(|p| p.point.shown[k].abs())
            .fold(0.0, f64::max)
    };
    let sizes = [size(0), size(1)];
    let mut rows = vec![header];
    let ends = a.named_points.iter().filter(|p| p.kind == "end").count();
    for p in &a.named_points {
        if p.kind == "end" && ends > MOST_ENDS {
            continue;
        }
        let [displacement, load, slope] = p.point.shown;
        let mut row = vec![
            p.name.clone(),
            value(displacement, sizes[0]),
            value(load, sizes[1]),
            if slope.abs() < 1e-9 * sizes[1] / sizes[0].max(f64::MIN_POSITIVE) {
                "0".to_owned()
            } else if !slope.is_finite() {
                "locked".to_owned()
            } else {
                number(slope, 5)
            },
            match p.point.may_flutter {
                true => "may swing".to_owned(),
                false => verdict_of(p.limits[0], p.point.stable_under_dead_load),
            },
            verdict_of(p.limits[1], p.point.stable_under_prescribed_motion),
        ];
        if factor {
            row.insert(1, value(p.point.factor.unwrap_or(f64::NAN), 1.0));
        }
        rows.push(row);
    }
    let mut out = columns(&rows, 2);
    if ends > MOST_ENDS {
        out.push_str(&format!(
            "  and {ends} ends of branches; JSON and CSV have them\n"
        ));
    }
    out
}

/// A number of a column whose largest is `size`.
fn value(x: f64, size: f64) -> String {
    if x.abs() < 1e-11 * size {
        return "0".into();
    }
    number(x, 7)
}

/// For sentences.
fn short(x: f64) -> String {
    if x.abs() < 1e-12 {
        return "0".into();
    }
    number(x, 6)
}

fn verdict_of(limit: bool, stable: bool) -> String {
    match (limit, stable) {
        (true, _) => "limit",
        (false, true) => "holds",
        (false, false) => "snaps",
    }
    .to_owned()
}

fn point_in_words(p: &NamedPoint) -> String {
    let branches: Vec<String> = p.branches.iter().map(usize::to_string).collect();
    let mut text = format!(
        "{} ({}, branch {}): {}",
        p.name,
        kind_in_words(p.kind),
        branches.join(" and "),
        p.in_words
    );
    if matches!(p.kind, "pitchfork" | "transcritical" | "multiple") {
        text.push_str(&format!("; the mode moves {}", p.mode_in_words));
    }
    text
}

/// The ends of branches, those of one reason together.
fn ends(a: &CurveAnswer) -> String {
    let ends: Vec<&NamedPoint> = a.named_points.iter().filter(|p| p.kind == "end").collect();
    if ends.len() > MOST_ENDS {
        return String::new();
    }
    let why = |p: &NamedPoint| p.in_words.split_once(": ").map(|w| w.1.to_owned());
    let mut out = String::new();
    let mut reported: Vec<Option<String>> = Vec::new();
    for p in &ends {
        let reason = why(p);
        if reported.contains(&reason) {
            continue;
        }
        let names: Vec<&str> = ends
            .iter()
            .filter(|q| why(q) == reason)
            .map(|q| q.name.as_str())
            .collect();
        let text = format!(
            "{}: {} ({})",
            names.join(", "),
            if names.len() == 1 {
                "end of a branch"
            } else {
                "ends of branches"
            },
            reason.as_deref().unwrap_or_default()
        );
        out.push_str(&item(&text));
        reported.push(reason);
    }
    out
}

fn jumps(a: &CurveAnswer) -> String {
    if a.jumps.is_empty() {
        return String::new();
    }
    let mut out = String::from("\nJumps\n");
    for jump in &a.jumps {
        let under = if jump.under == "dead_load" {
            "the load stays"
        } else {
            "the motion stays"
        };
        let text = match jump.to.as_slice() {
            [] => format!(
                "from {} ({under}): no stable shape was found on the branches followed; {}",
                jump.from,
                match a.subject {
                    "machine" => "a longer way may reach one",
                    _ => "--all searches for others",
                }
            ),
            [one] => format!("from {} ({under}) to {one}", jump.from),
            many => format!(
                "from {} ({under}) to {}, nearest first",
                jump.from,
                many.join(" or ")
            ),
        };
        out.push_str(&item(&text));
    }
    out
}

fn critical(a: &CurveAnswer) -> String {
    if a.critical_loads.is_empty() {
        return String::new();
    }
    let mut out = String::from("\nCritical load factor\n");
    for c in &a.critical_loads {
        out.push_str(&item(&critical_in_words(c)));
    }
    out
}

fn critical_in_words(c: &CriticalAnswer) -> String {
    let what = if c.judged == "shape" {
        "the shape, with the tool held where the load brings it"
    } else {
        "shape and tool, as they are held"
    };
    let exact = match c.factor {
        Some(factor) => format!(
            "{}{}; the mode moves {}",
            number(factor, 8),
            c.kind
                .map_or_else(String::new, |k| format!(" ({})", kind_in_words(k))),
            c.mode_in_words
        ),
        None => format!("none up to {}", number(c.followed_to_factor, 5)),
    };
    let linear = match c.linear_factor {
        Some(factor) => format!(
            "; from the first load step alone {} (linear buckling)",
            number(factor, 6)
        ),
        None => "; the first load step destabilises nothing".to_owned(),
    };
    let caution = match c.caution.is_empty() {
        true => String::new(),
        false => format!(". Note: {}", c.caution),
    };
    format!("{what}: {exact}{linear}{caution}")
}

fn branches(a: &CurveAnswer) -> String {
    let points: usize = a.branches.iter().map(|b| b.points.len()).sum();
    let points = counted(points, "point");
    let mut text = match a.branches.len() {
        1 => format!("One branch was followed, {points}."),
        n => format!("{n} branches were followed, {points}."),
    };
    let shares: Vec<f64> = a
        .branches
        .first()
        .into_iter()
        .flat_map(|b| &b.points)
        .filter_map(|p| p.share_to_buckling)
        .collect();
    let most = shares.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let at_start = a
        .named_points
        .first()
        .and_then(|p| p.point.share_to_buckling);
    if let Some(mu) = at_start {
        let words = if mu < 0.0 {
            "its load stretches the shape".to_owned()
        } else {
            format!("the shape is {} of the way to buckling", share(mu))
        };
        text.push_str(&format!(
            " Held at the start, {words}; the largest share of the way to buckling on branch 1 is {}.",
            share(most)
        ));
    }
    format!("\n{}", wrapped(&text, 0))
}
