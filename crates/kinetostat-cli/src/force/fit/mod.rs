//! `kinetostat force --fit`: from mean forces of a dynamometer to the coefficients of a material.
//!
//! It takes a table of mean forces over the feed, the tool and the cut in which they were measured, and gives the
//! coefficients of the linear law with their intervals, how well they fit, and the material as a file.

mod answer;
mod answer_of;
pub(crate) mod findings;
mod material_file;
mod text;

use std::path::Path;

use kinetostat_diagnostic::ErrorCode;
use kinetostat_report::{Plot, PlotLine, PlotMark};

use crate::files::answer_files::{ClaimedFiles, Shown};
use crate::files::csv_text::with_decimal_points;
use crate::files::input_files::InputFiles;
use crate::force::arguments::ForceArgs;
use crate::force::fit::answer::AtFeed;
pub(crate) use crate::force::fit::answer::FitAnswer;
use crate::force::fit::answer_of::answer_of;
use crate::force::tool::tool_of;
use crate::ui::csv_table::{cell, cell_if_any, written};
use crate::ui::failure::{Answer, Failing};
use crate::ui::numbers::{given, number};

pub(crate) fn run(files: &InputFiles, args: &ForceArgs, means: &Path) -> Answer<()> {
    let tool = tool_of(files, &args.tool)?;
    let text = files.text("table of mean forces", means)?;
    let mut inputs = vec![means.to_owned()];
    inputs.extend(tool.table.clone());
    let mut claimed = ClaimedFiles::claim(&args.outputs, &inputs)?;
    let target = args.fit.out_material.as_deref();
    let material = target
        .map(|path| claimed.claim_also("material", path))
        .transpose()?;
    let mut answer = answer_of(args, &tool, means, &with_decimal_points(&text))?;
    if let Some(claim) = material {
        let toml = answer.material_toml.as_deref().ok_or_else(|| {
            ErrorCode::Unused.failure(format!(
                "--out-material: {}; leave the option out to see the whole fit",
                answer.no_material.as_deref().unwrap_or("there is none")
            ))
        })?;
        claimed.fill(claim, toml.as_bytes())?;
    }
    if answer.material_toml.is_none() {
        answer.spread_percent = None;
        answer.spread_from = None;
    }
    let shown = Shown {
        text: text::answer_text(&answer, target),
        csv: of_fit(&answer)?,
        svg: drawing(&answer),
        failure: None,
    };
    claimed.finish(&shown, &answer)
}

const HEADER: [&str; 13] = [
    "feed_mm_per_tooth",
    "fx_n",
    "fy_n",
    "fz_n",
    "fx_fitted_n",
    "fy_fitted_n",
    "fz_fitted_n",
    "fx_residual_n",
    "fy_residual_n",
    "fz_residual_n",
    "fx_half_width_95_n",
    "fy_half_width_95_n",
    "fz_half_width_95_n",
];

fn of_fit(answer: &FitAnswer) -> Answer<Vec<u8>> {
    let mut rows = vec![HEADER.map(String::from).to_vec()];
    for of in &answer.rows {
        let mut row = vec![cell(of.feed_mm_per_tooth)];
        let forces = [of.force_n, of.fitted_n, of.residual_n];
        row.extend(forces.iter().flatten().map(|n| cell(*n)));
        let widths = of.half_width_95_n.iter();
        row.extend(widths.copied().map(cell_if_any));
        rows.push(row);
    }
    written(&rows)
}

const NAMES: [&str; 3] = [
    "Fx, along the feed",
    "Fy, to its left",
    "Fz, along the tool",
];
const OVER: &str = "feed per tooth, mm";

fn drawing(a: &FitAnswer) -> String {
    let line = |k: usize, name: &str, dashed: bool, of: &dyn Fn(&AtFeed) -> f64| PlotLine {
        name: name.to_owned(),
        colour: k,
        dashed,
        points: a
            .lines
            .iter()
            .map(|at| (at.feed_mm_per_tooth, of(at)))
            .collect(),
        ..PlotLine::default()
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
        marks: marks(a),
    };
    let residuals = Plot {
        title: "Measured less fitted".into(),
        x_label: OVER.into(),
        y_label: "residual, N".into(),
        lines: residual_lines(a),
        marks: Vec::new(),
    };
    forces.svg_above(&[residuals])
}

/// The residuals, and the axis that they scatter about.
fn residual_lines(a: &FitAnswer) -> Vec<PlotLine> {
    let last = a.lines.last().map_or(0.0, |at| at.feed_mm_per_tooth);
    let zero = PlotLine::dashed(String::new(), 5, vec![(0.0, 0.0), (last, 0.0)]);
    let of = |k: usize| {
        let rows = a.rows.iter();
        let points = rows.map(|row| (row.feed_mm_per_tooth, row.residual_n[k]));
        PlotLine::dots(["Fx", "Fy", "Fz"][k], k, points.collect())
    };
    (0..3).map(of).chain([zero]).collect()
}

/// The measured forces.
fn marks(a: &FitAnswer) -> Vec<PlotMark> {
    let mut marks = Vec::new();
    for row in &a.rows {
        for (name, force) in NAMES.iter().zip(row.force_n) {
            marks.push(PlotMark {
                at: (row.feed_mm_per_tooth, force),
                name: String::new(),
                detail: format!(
                    "{name}: {} N at {} mm per tooth",
                    number(force, 4),
                    given(row.feed_mm_per_tooth)
                ),
            });
        }
    }
    marks
}
