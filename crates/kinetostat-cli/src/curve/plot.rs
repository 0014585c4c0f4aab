//! The drawing of a curve: stable parts solid, unstable ones dashed, special points named.

use kinetostat::number::{larger, smaller};
use kinetostat_report::{Plot, PlotLine, PlotMark};

use crate::curve::answer::{CurveAnswer, NamedPoint, PointAnswer, kind_description};
use crate::ui::numbers::number;

/// Stability of a part of a branch.
#[derive(Clone, Copy, PartialEq)]
enum Holds {
    Both,
    /// Stable only while the motion is prescribed.
    Motion,
    /// Stable only under the load as it grows (the motion along it would be no restraint).
    Neither,
}

fn holds(p: &PointAnswer) -> Holds {
    match (p.stable_under_dead_load, p.stable_under_prescribed_motion) {
        (true, _) => Holds::Both,
        (false, true) => Holds::Motion,
        (false, false) => Holds::Neither,
    }
}

pub(crate) fn plot(a: &CurveAnswer) -> Plot {
    let u = &a.units;
    let label = |name: &str, unit: &str| {
        if unit.is_empty() {
            name.to_owned()
        } else {
            format!("{name}, {unit}")
        }
    };
    let mut lines: Vec<PlotLine> = Vec::new();
    for branch in &a.branches {
        let specials: Vec<&NamedPoint> = a
            .named_points
            .iter()
            .filter(|p| p.branches.contains(&branch.number))
            .filter(|p| !matches!(p.kind, "start" | "landing" | "end"))
            .collect();
        lines.extend(parts(&branch.points, &specials, a.grows == "load"));
    }
    Plot {
        title: format!("{}: {}", a.head.model, title(a)),
        x_label: label(u.displacement, u.displacement_unit),
        y_label: label(u.load, u.load_unit),
        lines,
        marks: marks(a),
    }
}

fn title(a: &CurveAnswer) -> String {
    let first = a.question.split([';', '?']).next().unwrap_or_default();
    let first = first.split(". ").next().unwrap_or_default();
    let text = first.trim_end_matches('.');
    let mut chars = text.chars();
    chars
        .next()
        .map(|c| c.to_lowercase().chain(chars).collect())
        .unwrap_or_default()
}

/// A branch in parts that are stable in one way.
fn parts(points: &[PointAnswer], specials: &[&NamedPoint], by_load: bool) -> Vec<PlotLine> {
    let place = |p: &PointAnswer| [p.shown[0], p.shown[1]];
    let mut lines: Vec<PlotLine> = Vec::new();
    let mut start = |how: Holds, first: [f64; 2]| {
        let (name, colour, dashed) = match how {
            Holds::Both => ("stable", 0, false),
            Holds::Motion if by_load => ("stable only if the motion is prescribed", 1, true),
            Holds::Motion => ("stable only while the motion is prescribed", 1, false),
            Holds::Neither => ("unstable", 5, true),
        };
        lines.push(PlotLine {
            name: name.into(),
            colour,
            dashed,
            dots: false,
            points: vec![first.into()],
        });
        lines.len() - 1
    };
    let Some(first) = points.first() else {
        return Vec::new();
    };
    // The first point may be a bifurcation itself: what follows decides.
    let mut how = holds(points.get(1).unwrap_or(first));
    let mut open = start(how, place(first));
    let mut list: Vec<(usize, [f64; 2])> = Vec::new();
    for i in 1..points.len() {
        let (before, here) = (place(&points[i - 1]), place(&points[i]));
        let next = holds(&points[i]);
        // A change of stability at a single point is that of a bifurcation point.
        let lone = points.get(i + 1).is_some_and(|p| holds(p) == how);
        if next == how || lone {
            list.push((open, here));
            continue;
        }
        let at = specials
            .iter()
            .map(|s| place(&s.point))
            .find(|s| inside(*s, before, here))
            .unwrap_or([0, 1].map(|k| 0.5 * (before[k] + here[k])));
        list.push((open, at));
        how = next;
        open = start(how, at);
        list.push((open, here));
    }
    for (line, point) in list {
        lines[line].points.push(point.into());
    }
    lines
}

/// True if a point lies in the box of two others, with some room: a limit point lies a little
/// outside.
fn inside(p: [f64; 2], a: [f64; 2], b: [f64; 2]) -> bool {
    let room = |a: f64, b: f64| 0.3 * (a - b).abs() + 1e-9 * (a.abs() + b.abs());
    let within = |x: f64, a: f64, b: f64| x >= a.min(b) - room(a, b) && x <= a.max(b) + room(a, b);
    (0..2).all(|k| within(p[k], a[k], b[k]))
}

fn marks(a: &CurveAnswer) -> Vec<PlotMark> {
    let mut marks: Vec<PlotMark> = Vec::new();
    let all = || a.branches.iter().flat_map(|b| &b.points);
    let size = |k: usize| {
        let (low, high) = all().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), p| {
            (smaller(l, p.shown[k]), larger(h, p.shown[k]))
        });
        (high - low).max(f64::MIN_POSITIVE)
    };
    let (width, height) = (size(0), size(1));
    for p in a.named_points.iter().filter(|p| p.kind != "end") {
        let at = (p.point.shown[0], p.point.shown[1]);
        let words = kind_description(p.kind);
        let detail = format!(
            "{}: {} {}, {} {}: {}",
            p.name,
            number(at.0, 6),
            a.units.displacement_unit,
            number(at.1, 6),
            a.units.load_unit,
            p.in_words
        );
        // Mirrored shapes lie at one place of the drawing.
        let same = marks.iter_mut().find(|m| {
            (m.at.0 - at.0).abs() < 2e-3 * width && (m.at.1 - at.1).abs() < 2e-3 * height
        });
        match same {
            Some(m) => {
                let (letters, rest) = m.name.split_once(' ').unwrap_or((m.name.as_str(), ""));
                let rest = if rest.is_empty() { words } else { rest };
                m.name = format!("{letters},{} {rest}", p.name).trim_end().to_owned();
                m.detail = format!("{}\n{detail}", m.detail);
            }
            None => marks.push(PlotMark {
                at,
                name: format!("{} {words}", p.name).trim_end().to_owned(),
                detail,
            }),
        }
    }
    marks
}
