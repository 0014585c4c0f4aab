//! Curves of equilibria as lines of a plot, and their special points as marks and numbers.

use kinetostat::continuation::{CurvePoint, Curves, Special, SpecialKind};
use kinetostat_report::{PlotLine, PlotMark};

/// Style of a drawn curve.
pub(crate) struct Drawn<'d> {
    /// Name in the legend, of its stable parts.
    pub(crate) name: &'d str,
    pub(crate) colour: usize,
    /// Stable is: with the motion prescribed (true), or under a dead force (false).
    pub(crate) held: bool,
    /// Abscissa and ordinate of a point.
    pub(crate) at: &'d dyn Fn(&CurvePoint) -> (f64, f64),
}

fn stable(drawn: &Drawn<'_>, p: &CurvePoint) -> bool {
    if drawn.held {
        p.displacement_control.stable
    } else {
        p.dead_load.stable
    }
}

/// All branches, cut where stability changes: at the special point there, if there is one. A branch
/// and its mirror image that look the same are drawn once (two dashed lines on top of each other
/// would look solid).
pub(crate) fn lines(curves: &Curves<'_>, drawn: &Drawn<'_>) -> Vec<PlotLine> {
    let mut lines: Vec<PlotLine> = Vec::new();
    for branch in &curves.branches {
        let origin = branch.origin.and_then(|k| curves.specials.get(k));
        let fork = origin.and_then(|s| {
            let away = |p: &CurvePoint| distance(p, &s.point);
            let of = |k: usize| away(&branch.points[k]);
            (0..branch.points.len()).min_by(|a, b| of(*a).total_cmp(&of(*b)))
        });
        let Some(fork) = fork else {
            lines.extend(pieces(curves, drawn, branch.points.iter()));
            continue;
        };
        let one = pieces(curves, drawn, branch.points[..=fork].iter().rev());
        let other = pieces(curves, drawn, branch.points[fork..].iter());
        if !alike(&one, &other) {
            lines.extend(other);
        }
        lines.extend(one);
    }
    lines
}

fn alike(one: &[PlotLine], other: &[PlotLine]) -> bool {
    let near = |a: &(f64, f64), b: &(f64, f64)| {
        (a.0 - b.0).abs() + (a.1 - b.1).abs() <= 1e-6 * (1.0 + a.0.abs() + a.1.abs())
    };
    one.len() == other.len()
        && one.iter().zip(other).all(|(a, b)| {
            a.points.len() == b.points.len()
                && a.points.iter().zip(&b.points).all(|(a, b)| near(a, b))
        })
}

/// A path, cut where stability changes.
fn pieces<'p>(
    curves: &Curves<'_>,
    drawn: &Drawn<'_>,
    points: impl Iterator<Item = &'p CurvePoint>,
) -> Vec<PlotLine> {
    let mut lines: Vec<PlotLine> = Vec::new();
    let mut current: Option<PlotLine> = None;
    let mut before: Option<&CurvePoint> = None;
    for p in points {
        let here = (drawn.at)(p);
        let dashed = !stable(drawn, p);
        match (&mut current, before) {
            (Some(line), _) if line.dashed == dashed => line.points.push(here),
            (Some(line), Some(last)) => {
                let turn = between(curves, drawn, last, p);
                line.points.push(turn);
                lines.extend(current.replace(begun(drawn, dashed, vec![turn, here])));
            }
            _ => current = Some(begun(drawn, dashed, vec![here])),
        }
        before = Some(p);
    }
    lines.extend(current);
    lines
}

/// A distance of two states, for comparisons only.
fn distance(a: &CurvePoint, b: &CurvePoint) -> f64 {
    let square: f64 = a
        .equilibrium
        .coordinates
        .iter()
        .zip(&b.equilibrium.coordinates)
        .map(|(x, y)| (x - y).powi(2))
        .sum();
    square.sqrt() + (a.parameter - b.parameter).abs()
}

fn begun(drawn: &Drawn<'_>, dashed: bool, points: Vec<(f64, f64)>) -> PlotLine {
    PlotLine {
        name: if dashed { "" } else { drawn.name }.to_owned(),
        colour: drawn.colour,
        dashed,
        dots: false,
        points,
    }
}

/// The legend's entry for all dashed lines.
pub(crate) fn unstable_entry(words: &str) -> PlotLine {
    PlotLine::dashed(words, 0, Vec::new())
}

/// The special point between two neighbours of a branch, or the middle.
fn between(
    curves: &Curves<'_>,
    drawn: &Drawn<'_>,
    one: &CurvePoint,
    other: &CurvePoint,
) -> (f64, f64) {
    let direct = distance(one, other);
    let nearest = curves
        .specials
        .iter()
        .map(|s| (distance(one, &s.point) + distance(&s.point, other), s))
        .filter(|(around, _)| *around < 1.5 * direct)
        .min_by(|a, b| a.0.total_cmp(&b.0));
    match nearest {
        Some((_, s)) => (drawn.at)(&s.point),
        None => {
            let (a, b) = ((drawn.at)(one), (drawn.at)(other));
            (0.5 * (a.0 + b.0), 0.5 * (a.1 + b.1))
        }
    }
}

/// Marks for the special points of some kinds.
pub(crate) fn marks(
    curves: &Curves<'_>,
    drawn: &Drawn<'_>,
    wanted: impl Fn(SpecialKind) -> bool,
) -> Vec<PlotMark> {
    curves
        .specials
        .iter()
        .filter(|s| wanted(s.kind))
        .map(|s| PlotMark {
            at: (drawn.at)(&s.point),
            name: match s.kind {
                SpecialKind::LoadLimit | SpecialKind::DisplacementLimit => "limit",
                kind => word(kind),
            }
            .to_owned(),
            detail: format!(
                "{}: {}, parameter {:.9}, force {:.9}",
                drawn.name,
                word(s.kind),
                s.point.parameter,
                s.point.conjugate
            ),
        })
        .collect()
}

pub(crate) fn word(kind: SpecialKind) -> &'static str {
    match kind {
        SpecialKind::LoadLimit => "force limit",
        SpecialKind::DisplacementLimit => "displacement limit",
        SpecialKind::Pitchfork => "pitchfork",
        SpecialKind::Transcritical => "transcritical",
        SpecialKind::StabilityChange => "change of stability",
        SpecialKind::Multiple { .. } => "multiple bifurcation",
        _ => "special point",
    }
}

/// The special points of one kind, in the order of their parameter.
pub(crate) fn of_kind<'c>(curves: &'c Curves<'_>, kind: SpecialKind) -> Vec<&'c Special> {
    let mut found: Vec<&Special> = curves.specials.iter().filter(|s| s.kind == kind).collect();
    found.sort_by(|a, b| a.point.parameter.total_cmp(&b.point.parameter));
    found
}
