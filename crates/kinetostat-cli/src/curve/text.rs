//! The answer of `curve` for a person.

use kinetostat_machining::number::{counted, share};

use crate::curve::answer::{CriticalAnswer, CurveAnswer, NamedPoint, kind_description};
use crate::curve::figures::value;
use crate::curve::stability_text::{reach, stability_text};
use crate::ui::layout::{columns, item, wrapped};
use crate::ui::numbers::number;
use crate::ui::warnings;
use kinetostat::number::{larger, largest_size};

/// Upper limit of the ends of branches that are listed; others are counted.
const MOST_ENDS: usize = 6;

pub(crate) fn answer_text(heading: &str, a: &CurveAnswer) -> String {
    let mut out = heading.to_owned();
    out.push_str(&wrapped(&a.question, 0));
    out.push('\n');
    out.push_str(&wrapped(&format!("{}{}", stability_text(a), reach(a)), 2));
    out.push('\n');
    out.push_str(&table(a));
    out.push('\n');
    for p in a.named_points.iter().filter(|p| p.kind != "end") {
        out.push_str(&item(&point_text(p)));
    }
    out.push_str(&ends(a));
    out.push_str(&jumps(a));
    out.push_str(&critical(a));
    out.push_str(&branches(a));
    if !a.conservative {
        out.push('\n');
        out.push_str(&wrapped(
            "Some loads have no potential, so stability says that small pushes die away quasi-statically, not that an energy is least.",
            0,
        ));
    }
    out.push_str(&warnings::warnings(&a.warnings));
    out
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
        "displ. control".to_owned(),
    ];
    let factor = a.grows == "load" && !u.load_unit.is_empty();
    let factors = a.named_points.iter().filter_map(|p| p.point.factor);
    let largest_factor = largest_size(factors);
    if factor {
        header.insert(1, "factor".to_owned());
    }
    let size = |k: usize| largest_size(a.named_points.iter().map(|p| p.point.shown[k]));
    let mut sizes = [size(0), size(1)];
    if a.grows != "load" {
        // A curve that ends where it starts is no reason to take rounding for a displacement.
        sizes[0] = larger(sizes[0], larger(a.requested.0.abs(), a.requested.1.abs()));
    }
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
                false => stability_word(p.limits[0], p.point.stable_under_dead_load),
            },
            stability_word(p.limits[1], p.point.stable_under_prescribed_motion),
        ];
        if factor {
            row.insert(1, value(p.point.factor.unwrap_or(f64::NAN), largest_factor));
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

fn stability_word(limit: bool, stable: bool) -> String {
    match (limit, stable) {
        (true, _) => "limit",
        (false, true) => "holds",
        (false, false) => "snaps",
    }
    .to_owned()
}

fn point_text(p: &NamedPoint) -> String {
    let branches: Vec<String> = p.branches.iter().map(usize::to_string).collect();
    let mut text = format!(
        "{} ({}, branch {}): {}",
        p.name,
        kind_description(p.kind),
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
                "from {} ({under}): no stable shape was found on the branches followed; --all searches for others",
                jump.from
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
        out.push_str(&item(&critical_load_text(c)));
    }
    out
}

fn critical_load_text(c: &CriticalAnswer) -> String {
    let what = if c.stability_of == "shape" {
        "the shape, with the tool held where the load brings it"
    } else {
        "shape and tool, as they are held"
    };
    let exact = match c.factor {
        Some(factor) => format!(
            "{}{}; the mode moves {}",
            number(factor, 8),
            c.kind
                .map_or_else(String::new, |k| format!(" ({})", kind_description(k))),
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
    let most = shares.iter().copied().fold(f64::NEG_INFINITY, larger);
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
