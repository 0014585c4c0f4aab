//! Pictures of vibration: stability lobes, and receptances of a tool.
//!
//! Takes what `kinetostat-chatter` computes; draws with `chart::plot`.

use kinetostat::number::larger;
use kinetostat_chatter::{Crossing, Instability, LobeDiagram, LobePoint};
use nalgebra::Complex;

use crate::chart::plot::{Look, Plot, PlotLine, PlotMark, stacked};
use crate::number;

/// A range of limits of more than this ratio is drawn over logarithms.
const WIDE: f64 = 12.0;

/// Style of what is unstable.
const STYLE: &str = include_str!("template/unstable.css");

/// Stability lobes as a document: depth of cut over the spindle speed, what is unstable shaded.
pub(crate) fn lobes(diagram: &LobeDiagram, title: &str) -> String {
    let top = top(diagram);
    let decades = top > WIDE * smallest(diagram);
    // Below the smallest limit nothing happens; a logarithm has to begin somewhere.
    let floor = match decades {
        true => 0.5 * smallest(diagram),
        false => 0.0,
    };
    let depth = |value: f64| {
        let mm = 1e3 * value.max(floor).min(top);
        if decades { mm.log10() } else { mm }
    };
    let plot = Plot {
        title: title.to_owned(),
        x_label: "spindle speed, rpm".into(),
        y_label: "depth of cut, mm".into(),
        lines: lines(diagram, depth),
        marks: best(diagram, depth),
    };
    let areas = areas(diagram, depth);
    let within = ends(diagram, depth(floor));
    let look = Look {
        decades: [false, decades],
        tight: true,
        areas: &areas,
        within: &within,
        ..Look::default()
    };
    stacked(&[(&plot, look)], STYLE)
}

fn limits(diagram: &LobeDiagram) -> impl Iterator<Item = f64> + '_ {
    let limits = diagram.points.iter().filter_map(|p| p.exact.limit());
    limits.map(|crossing| crossing.depth)
}

fn smallest(diagram: &LobeDiagram) -> f64 {
    limits(diagram)
        .reduce(f64::min)
        .unwrap_or(1e-3 * diagram.up_to)
}

/// The depth at which the picture ends: that of the diagram where a speed is stable up to it, else a little above the
/// highest change of stability, beyond which there is nothing to see.
fn top(diagram: &LobeDiagram) -> f64 {
    let highest = |point: &LobePoint| {
        let zeroth = point.zeroth_order.map_or(0.0, |limit| limit.depth);
        let all = point.exact.crossings.iter().map(|c| c.depth);
        all.fold(zeroth, larger)
    };
    let ends = diagram.points.iter().any(|p| p.exact.limit().is_none());
    match diagram.points.iter().map(highest).reduce(larger) {
        Some(most) if !ends && 1.2 * most < diagram.up_to => 1.2 * most,
        _ => diagram.up_to,
    }
}

fn lines(diagram: &LobeDiagram, depth: impl Fn(f64) -> f64 + Copy) -> Vec<PlotLine> {
    let mut all = Vec::new();
    for (kind, name, colour) in [
        (Instability::Hopf, "limit: Hopf (a frequency of its own)", 0),
        (
            Instability::Flip,
            "limit: flip (half the tooth frequency)",
            1,
        ),
    ] {
        let mut points = Vec::new();
        for pair in diagram.points.windows(2) {
            for (a, b) in neighbours(&pair[0], &pair[1]) {
                // The line between two kinds is that of the second half's: both are drawn to the middle.
                let (from, to) = (
                    (pair[0].exact.speed_rpm, depth(a.depth)),
                    (pair[1].exact.speed_rpm, depth(b.depth)),
                );
                let middle = (0.5 * (from.0 + to.0), 0.5 * (from.1 + to.1));
                match (a.kind == kind, b.kind == kind) {
                    (true, true) => points.extend([from, to]),
                    (true, false) => points.extend([from, middle]),
                    (false, true) => points.extend([middle, to]),
                    (false, false) => continue,
                }
                points.push((f64::NAN, f64::NAN));
            }
        }
        all.push(PlotLine::solid(name, colour, points));
    }
    let zeroth = diagram.points.iter().map(|point| {
        let limit = point.zeroth_order.map(|limit| limit.depth);
        let shown = limit.filter(|value| *value <= diagram.up_to);
        (point.exact.speed_rpm, shown.map_or(f64::NAN, depth))
    });
    all.push(PlotLine::dashed(
        "zeroth order (no bound)",
        5,
        zeroth.collect(),
    ));
    all.push(PlotLine::solid(
        format!(
            "stable up to {} mm, the largest depth looked at (--depth-mm)",
            number::setting(1e3 * diagram.up_to)
        ),
        2,
        without_limit(diagram, depth(diagram.up_to)),
    ));
    all.retain(|line| line.points.iter().any(|(_, y)| y.is_finite()));
    all
}

/// Line along the largest depth where there is no limit up to it: to the middle between a speed that has none and one
/// that has.
fn without_limit(diagram: &LobeDiagram, top: f64) -> Vec<(f64, f64)> {
    let has_none = |point: &LobePoint| point.exact.limit().is_none();
    let mut points = Vec::new();
    for pair in diagram.points.windows(2) {
        let [left, right] = [&pair[0], &pair[1]].map(|point| point.exact.speed_rpm);
        let middle = 0.5 * (left + right);
        let stretch = match (has_none(&pair[0]), has_none(&pair[1])) {
            (true, true) => [left, right],
            (true, false) => [left, middle],
            (false, true) => [middle, right],
            (false, false) => continue,
        };
        points.extend(stretch.map(|speed| (speed, top)));
        points.push((f64::NAN, f64::NAN));
    }
    points
}

/// The slowest and the fastest speed that were asked for, at a height.
fn ends(diagram: &LobeDiagram, height: f64) -> Vec<(f64, f64)> {
    let answered = diagram.points.iter().map(|point| point.exact.speed_rpm);
    let others = diagram.without_answer.iter().map(|(speed, _)| *speed);
    let mut all: Vec<f64> = answered.chain(others).collect();
    all.sort_by(f64::total_cmp);
    match diagram.points.is_empty() {
        true => Vec::new(),
        false => [all.first(), all.last()]
            .into_iter()
            .flatten()
            .map(|speed| (*speed, height))
            .collect(),
    }
}

/// Crossings of two speeds that belong together: one by one where there are as many, else the limits.
fn neighbours<'a>(a: &'a LobePoint, b: &'a LobePoint) -> Vec<(&'a Crossing, &'a Crossing)> {
    let (a, b) = (&a.exact.crossings, &b.exact.crossings);
    let together = if a.len() == b.len() {
        a.len()
    } else {
        a.len().min(b.len()).min(1)
    };
    a.iter().zip(b).take(together).collect()
}

/// Stretches of depth that are unstable at a speed.
fn unstable(point: &LobePoint) -> Vec<(f64, f64)> {
    let mut from = None;
    let mut all = Vec::new();
    for crossing in &point.exact.crossings {
        match (from, crossing.unstable_above) {
            (None, true) => from = Some(crossing.depth),
            (Some(low), false) => {
                all.push((low, crossing.depth));
                from = None;
            }
            _ => {}
        }
    }
    all.extend(from.map(|low| (low, point.exact.up_to)));
    all
}

/// Unstable areas between the speeds: joined where both have as many stretches, each up to the middle where not.
fn areas(diagram: &LobeDiagram, depth: impl Fn(f64) -> f64) -> Vec<Vec<(f64, f64)>> {
    let mut all = Vec::new();
    for pair in diagram.points.windows(2) {
        let (a, b) = (unstable(&pair[0]), unstable(&pair[1]));
        let (left, right) = (pair[0].exact.speed_rpm, pair[1].exact.speed_rpm);
        let mut between = |(x0, low0, high0): (f64, f64, f64), (x1, low1, high1)| {
            all.push(vec![
                (x0, depth(low0)),
                (x1, depth(low1)),
                (x1, depth(high1)),
                (x0, depth(high0)),
            ]);
        };
        if a.len() == b.len() {
            for ((low0, high0), (low1, high1)) in a.iter().zip(&b) {
                between((left, *low0, *high0), (right, *low1, *high1));
            }
        } else {
            let middle = 0.5 * (left + right);
            for (low, high) in &a {
                between((left, *low, *high), (middle, *low, *high));
            }
            for (low, high) in &b {
                between((middle, *low, *high), (right, *low, *high));
            }
        }
    }
    all
}

/// The speed with the largest limit.
fn best(diagram: &LobeDiagram, depth: impl Fn(f64) -> f64) -> Vec<PlotMark> {
    let Some((speed, limit)) = diagram.best() else {
        return Vec::new();
    };
    let shown = format!("{speed:.0} rpm: stable to {:.3} mm", 1e3 * limit);
    let name = match limit < diagram.up_to {
        true => shown,
        // Many speeds may be stable to the end of the diagram: none of them is the best.
        false => return Vec::new(),
    };
    vec![PlotMark {
        at: (speed, depth(limit)),
        name: name.clone(),
        detail: format!("largest limit of the speeds that were looked at: {name}"),
    }]
}

/// One curve of a receptance.
#[derive(Clone, Debug, PartialEq)]
pub struct ReceptanceCurve {
    /// Name in the legend, as `x by force along x`.
    pub name: String,
    /// Dashed, as for what is measured beside a model.
    pub dashed: bool,
    /// Frequencies, Hz, above 0.
    pub frequencies_hz: Vec<f64>,
    /// Displacement by force at each, m/N.
    pub receptance: Vec<Complex<f64>>,
}

/// Motion by force that is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DrawnMotion {
    /// Displacement by force.
    #[default]
    Receptance,
    /// Velocity by force.
    Mobility,
    /// Acceleration by force.
    Accelerance,
}

impl DrawnMotion {
    /// Axis label, order of the derivative of a displacement, and unit by that of SI.
    fn axis(self) -> (&'static str, i32, f64) {
        match self {
            Self::Receptance => ("receptance, \u{b5}m/N", 0, 1e6),
            Self::Mobility => ("mobility, mm/(s N)", 1, 1e3),
            Self::Accelerance => ("accelerance, m/(s\u{b2} N)", 2, 1.0),
        }
    }
}

/// Receptances over the frequency as a document: magnitude over logarithms, phase below it.
pub(crate) fn receptance(curves: &[ReceptanceCurve], motion: DrawnMotion, title: &str) -> String {
    let (y_label, order, unit) = motion.axis();
    let drawn = |hertz: f64, value: &Complex<f64>| {
        let turned = Complex::new(0.0, std::f64::consts::TAU * hertz).powi(order);
        value * turned * unit
    };
    let line =
        |number: usize, curve: &ReceptanceCurve, of: &dyn Fn(&Complex<f64>) -> f64| PlotLine {
            name: curve.name.clone(),
            colour: number,
            dashed: curve.dashed,
            points: curve
                .frequencies_hz
                .iter()
                .zip(&curve.receptance)
                .map(|(f, value)| (logarithm(*f), of(&drawn(*f, value))))
                .collect(),
            ..PlotLine::default()
        };
    let all = |of: &dyn Fn(&Complex<f64>) -> f64| -> Vec<PlotLine> {
        let numbered = curves.iter().enumerate();
        numbered.map(|(k, curve)| line(k, curve, of)).collect()
    };
    let magnitude = Plot {
        title: title.to_owned(),
        x_label: "frequency, Hz".into(),
        y_label: y_label.into(),
        lines: all(&|value| logarithm(value.norm())),
        marks: Vec::new(),
    };
    let nameless = |line: PlotLine| PlotLine {
        name: String::new(),
        ..line
    };
    let phase = Plot {
        title: "phase".into(),
        x_label: "frequency, Hz".into(),
        y_label: "phase, deg".into(),
        // A jump of a whole turn is no line.
        lines: all(&|value| value.arg().to_degrees())
            .into_iter()
            .map(|line| lifted(nameless(line)))
            .collect(),
        marks: Vec::new(),
    };
    let look = |y: bool| Look {
        decades: [true, y],
        ..Look::default()
    };
    stacked(&[(&magnitude, look(true)), (&phase, look(false))], "")
}

fn logarithm(value: f64) -> f64 {
    if value > 0.0 { value.log10() } else { f64::NAN }
}

fn lifted(mut line: PlotLine) -> PlotLine {
    let mut points = Vec::with_capacity(line.points.len());
    for (k, point) in line.points.iter().enumerate() {
        if k > 0 && (point.1 - line.points[k - 1].1).abs() > 270.0 {
            points.push((f64::NAN, f64::NAN));
        }
        points.push(*point);
    }
    line.points = points;
    line
}
