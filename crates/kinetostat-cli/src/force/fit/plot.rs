//! Mean force over feed: the points, the lines through them with their band, and below what is left.

use kinetostat_report::{Plot, PlotLine, PlotMark};

use crate::force::fit::answer::{AtFeed, FitAnswer};
use crate::ui::numbers::{given, number};

const NAMES: [&str; 3] = [
    "Fx, along the feed",
    "Fy, to its left",
    "Fz, along the tool",
];
const OVER: &str = "feed per tooth, mm";

pub(crate) fn drawing(a: &FitAnswer) -> String {
    let line = |k: usize, name: &str, dashed: bool, of: &dyn Fn(&AtFeed) -> f64| PlotLine {
        name: name.to_owned(),
        colour: k,
        dashed,
        points: a
            .lines
            .iter()
            .map(|at| (at.feed_mm_per_tooth, of(at)))
            .collect(),
    };
    let mut lines: Vec<PlotLine> = (0..3)
        .map(|k| line(k, NAMES[k], false, &|at| at.fitted_n[k]))
        .collect();
    for k in 0..3 {
        let name = ["95 % interval", "", ""][k];
        for sign in [1.0, -1.0] {
            let end = |at: &AtFeed| match at.half_width_95_n[k] {
                Some(width) => at.fitted_n[k] + sign * width,
                None => f64::NAN,
            };
            lines.push(line(k, name, true, &end));
        }
    }
    let known = |line: &PlotLine| line.points.iter().any(|(_, force)| force.is_finite());
    lines.retain(known);
    let forces = Plot {
        title: format!("{}: mean force on the tool over the feed", a.name),
        x_label: OVER.into(),
        y_label: "mean force on the tool, N".into(),
        lines,
        marks: marks(a, |k| NAMES[k], |row| row.force_n),
    };
    let residuals = Plot {
        title: "Measured less fitted".into(),
        x_label: OVER.into(),
        y_label: "residual, N".into(),
        lines: residual_lines(a),
        marks: marks(a, |k| NAMES[k], |row| row.residual_n),
    };
    forces.svg_above(&[residuals])
}

/// The residuals in the order of their feeds, and the axis that they scatter about.
fn residual_lines(a: &FitAnswer) -> Vec<PlotLine> {
    let last = a.lines.last().map_or(0.0, |at| at.feed_mm_per_tooth);
    let zero = PlotLine::dashed(String::new(), 5, vec![(0.0, 0.0), (last, 0.0)]);
    let of = |k: usize| {
        let rows = a.rows.iter();
        let mut points: Vec<(f64, f64)> = rows
            .map(|row| (row.feed_mm_per_tooth, row.residual_n[k]))
            .collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        PlotLine::solid(["Fx", "Fy", "Fz"][k], k, points)
    };
    (0..3).map(of).chain([zero]).collect()
}

fn marks(
    a: &FitAnswer,
    name: impl Fn(usize) -> &'static str,
    of: impl Fn(&crate::force::fit::answer::FitRow) -> [f64; 3],
) -> Vec<PlotMark> {
    let mut marks = Vec::new();
    for row in &a.rows {
        for (k, force) in of(row).into_iter().enumerate() {
            marks.push(PlotMark {
                at: (row.feed_mm_per_tooth, force),
                name: String::new(),
                detail: format!(
                    "{}: {} N at {} mm per tooth",
                    name(k),
                    number(force, 4),
                    given(row.feed_mm_per_tooth)
                ),
            });
        }
    }
    marks
}
