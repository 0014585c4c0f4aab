//! The stock from above: in grey what stays, in colour how deep it is cut, with the path and the worst lines.

use kinetostat_cutting::Stock;
use kinetostat_machining::CutPlace;
use kinetostat_program::{Curve, Knowledge, MoveKind, Path};
use kinetostat_report::{Cell, PlotLine, PlotMark, Section};

use crate::engagement::answer::EngagementAnswer;
use crate::ui::numbers::{number, short};

/// Upper limit of the cells along an axis.
const MOST_CELLS: f64 = 400.0;
/// Heights that differ by less are the same, mm.
const SAME_MM: f64 = 1e-3;
/// Room around the stock, as a share of its longer side.
const AROUND: f64 = 0.06;
/// Upper limit of the lines that are named.
const MOST_MARKS: usize = 4;
/// Named places are at least so far from each other, as a share of the map's longer side.
const APART: f64 = 0.1;
/// Shade of a stock with one height.
const EVEN: f64 = 0.8;

/// The map of a stock before and after a program.
pub(crate) fn map(a: &EngagementAnswer, whole: &Stock, left: &Stock, path: &Path) -> Section {
    let [low, high] = whole.corners_mm();
    let longest = [0, 1].map(|k| high[k] - low[k]);
    let longest = longest[0].max(longest[1]);
    let cell = whole
        .cell_mm()
        .max(longest * (1.0 + 2.0 * AROUND) / MOST_CELLS);
    let [x, y] = [0, 1].map(|k| {
        let (from, to) = (low[k] - AROUND * longest, high[k] + AROUND * longest);
        let count = ((to - from) / cell).round().max(2.0);
        let step = (to - from) / count;
        let places = (0..count as usize).map(|i| from + (i as f64 + 0.5) * step);
        places.collect::<Vec<f64>>()
    });
    let heights = heights(whole, left, &x, &y);
    let cells = y.iter().flat_map(|y| x.iter().map(move |x| (*x, *y)));
    let cells = cells
        .map(|(x, y)| look(whole, left, (x, y), heights))
        .collect();
    let grey_label = match heights {
        Some((least, most)) if most - least > SAME_MM => format!(
            "not cut, {} (dark) to {} mm (light) high",
            short(least),
            short(most)
        ),
        Some((_, top)) => format!("not cut, top at z = {} mm", short(top)),
        None => String::new(),
    };
    Section {
        title: format!("{} in {}: the stock from above", a.program, a.material),
        x_label: "x, mm".to_owned(),
        y_label: "y, mm".to_owned(),
        value_label: "taken off, mm deep".to_owned(),
        x,
        y,
        cells,
        others: vec!["cut through".to_owned()],
        grey_label,
        scale_from: Some(0.0),
        lines: lines(path, 0.2 * cell),
        marks: marks(&a.cutting.worst_lines, longest),
    }
}

/// Stock height at an uncut place; none where it is cut.
fn kept(whole: &Stock, left: &Stock, (x, y): (f64, f64)) -> Option<f64> {
    let (before, after) = (whole.top_mm(x, y)?, left.top_mm(x, y)?);
    (before - after <= SAME_MM).then_some(after)
}

/// Smallest and largest height of the uncut surface.
fn heights(whole: &Stock, left: &Stock, x: &[f64], y: &[f64]) -> Option<(f64, f64)> {
    let places = y.iter().flat_map(|y| x.iter().map(move |x| (*x, *y)));
    places
        .filter_map(|at| kept(whole, left, at))
        .fold(None, |found, top| match found {
            None => Some((top, top)),
            Some((least, most)) => Some((least.min(top), most.max(top))),
        })
}

fn look(whole: &Stock, left: &Stock, at: (f64, f64), heights: Option<(f64, f64)>) -> Cell {
    let Some(before) = whole.top_mm(at.0, at.1) else {
        return Cell::Value(f64::NAN);
    };
    if let Some(top) = kept(whole, left, at) {
        return Cell::Grey(match heights {
            Some((least, most)) if most - least > SAME_MM => (top - least) / (most - least),
            _ => EVEN,
        });
    }
    match left.top_mm(at.0, at.1) {
        // Depths are round numbers, and so are the ends of colours: rounding must not speckle them.
        Some(after) => Cell::Value(1e-4 * (1e4 * (before - after)).round()),
        None => Cell::Other(0),
    }
}

/// The path at feed and in rapids, from above.
fn lines(path: &Path, tolerance_mm: f64) -> Vec<PlotLine> {
    let kinds = [
        (MoveKind::Rapid, "rapid", true),
        (MoveKind::Feed, "path of the tip at feed", false),
    ];
    let line = |(kind, name, dashed): (MoveKind, &str, bool)| {
        let mut points: Vec<(f64, f64)> = Vec::new();
        let mut at: Option<[f64; 3]> = None;
        let moves = path.moves.iter();
        for motion in moves.filter(|m| m.kind == kind && m.known == Knowledge::Whole) {
            if at != Some(motion.start.into()) {
                points.push((f64::NAN, f64::NAN));
                points.push((motion.start.x, motion.start.y));
            }
            let pieces = match &motion.curve {
                Curve::Line => 1,
                Curve::Arc(arc) => arc.chords_within(tolerance_mm),
            };
            points.extend((1..=pieces).map(|i| {
                let place = motion.point(i as f64 / pieces as f64);
                (place.x, place.y)
            }));
            at = Some(motion.point(1.0).into());
        }
        PlotLine {
            name: name.to_owned(),
            colour: 0,
            dashed,
            points,
        }
    };
    let lines = kinds.map(line).into_iter();
    lines.filter(|line| !line.points.is_empty()).collect()
}

/// The lines with the largest forces, not two beside each other.
fn marks(worst: &[CutPlace], longest: f64) -> Vec<PlotMark> {
    let mut marks: Vec<PlotMark> = Vec::new();
    for place in worst {
        let [x, y, _] = place.position_mm;
        let near = |m: &PlotMark| (m.at.0 - x).hypot(m.at.1 - y) < APART * longest;
        if marks.len() == MOST_MARKS || marks.iter().any(near) {
            continue;
        }
        let line = format!("line {}", place.line);
        let force = number(place.force_n(), 3);
        marks.push(PlotMark {
            at: (x, y),
            detail: format!("{line}: {force} N, {} mm deep", short(place.depth_mm)),
            name: format!("{line}, {force} N"),
        });
    }
    marks
}
