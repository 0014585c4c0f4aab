//! Evaluation of the table of mean forces.

use std::f64::consts::PI;
use std::path::Path;

use kinetostat::number::{larger, largest_size};
use kinetostat_cutting::{
    CoefficientFit, CutError, MeanForce, MeasuredCut, Rotation, Series, Shape, fit_coefficients,
};
use kinetostat_diagnostic::ErrorCode;

use crate::force::answer_of::{milling_word, part_word, tool_answer};
use crate::force::arguments::ForceArgs;
use crate::force::cut::{Straight, straight};
use crate::force::fit::answer::{AtFeed, CoefficientAnswer, Component, FitAnswer, FitCut, FitRow};
use crate::force::fit::findings::findings;
use crate::force::fit::material_file::material_file;
use crate::force::fit_arguments::ActsOnWord;
use crate::force::refusal::{refused, within};
use crate::force::text::way_text;
use crate::force::tool::CutTool;
use crate::ui::failure::{Answer, Failing};

/// Places at which the lines of the drawing are computed, and how far they go beyond the largest feed.
const PLACES: usize = 60;
const BEYOND: f64 = 1.05;

/// A fit with the cut in which its forces were measured.
struct Fitted {
    fit: CoefficientFit,
    series: Series,
    straight: Straight,
    /// The spindle turns counter-clockwise: the fit is that of the mirror image.
    mirrored: bool,
}

pub(super) fn answer_of(
    args: &ForceArgs,
    tool: &CutTool,
    path: &Path,
    text: &str,
) -> Answer<FitAnswer> {
    let straight = straight(&tool.tool, &args.cut)?;
    if tool.tool.shape() != Shape::Flat {
        return Err(ErrorCode::Unused.failure(format!(
                "--fit: the closed form of the mean force is that of a flat cutter, and this is a {} one; measure with a flat cutter: the coefficients hold for the others too",
                tool.tool.shape().word()
            ),
        ));
    }
    let file = path.display().to_string();
    let acts_on = args.fit.acts_on.unwrap_or_default();
    let fitted = fitted(tool, straight, acts_on, &file, text)?;
    let name = match &args.material.material {
        Some(name) => name.clone(),
        None => path
            .file_stem()
            .map_or_else(|| file.clone(), |stem| stem.to_string_lossy().into_owned()),
    };
    let rpm = args.cut.rpm;
    let rpm = rpm
        .map(|rpm| within("speed of the spindle", rpm, 1e-3..=1e6, "turns per minute"))
        .transpose()?;
    let speed = rpm.map(|rpm| 1e-3 * PI * tool.tool.diameter_mm() * rpm);
    let rows = rows(&fitted);
    let (spread_percent, spread_from) = match args.fit.spread_percent {
        Some(percent) => {
            let percent = within("spread", percent, 0.0..=200.0, "%")?;
            (Some(percent), Some("given"))
        }
        None => (of_interval(&rows), Some("fit")),
    };
    let mut answer = FitAnswer {
        schema: 1,
        kinetostat_version: env!("CARGO_PKG_VERSION"),
        question: format!(
            "Coefficients of {name} from {} mean forces: {}",
            rows.len(),
            way_text(fitted.straight.way)
        ),
        name,
        file,
        acts_on: match acts_on {
            ActsOnWord::Tool => "tool",
            ActsOnWord::Part => "part",
        },
        axes: "force on the tool; x along the feed of the tool over the part, y to the left of the feed, z along the tool towards the spindle".to_owned(),
        tool: tool_answer(tool),
        cut: cut(&fitted, rpm, speed),
        coefficients: coefficients(&fitted.fit),
        components: components(&fitted, &rows),
        lines: lines(&fitted, &rows),
        rows,
        spread_percent,
        spread_from: spread_percent.and(spread_from),
        material_toml: None,
        no_material: None,
        assumed: assumed(acts_on),
        warnings: Vec::new(),
    };
    answer.warnings = findings(&answer, tool.tool.diameter_mm());
    match material_file(&answer, &fitted.fit, args) {
        Ok(text) => answer.material_toml = Some(text),
        Err(reason) => answer.no_material = Some(reason),
    }
    Ok(answer)
}

fn fitted(
    tool: &CutTool,
    straight: Straight,
    acts_on: ActsOnWord,
    file: &str,
    text: &str,
) -> Answer<Fitted> {
    let mirrored = straight.rotation != Rotation::Clockwise;
    let engagement = match mirrored {
        true => straight.engagement.mirrored(),
        false => straight.engagement.clone(),
    };
    let cut = MeasuredCut::new(&tool.tool, &engagement).map_err(|error| refused(&error))?;
    let read = Series::read(file, text, cut).map_err(|error| refused(&error))?;
    let turned = match acts_on {
        ActsOnWord::Tool => 1.0,
        ActsOnWord::Part => -1.0,
    };
    let signs = [turned, turned * mirror(mirrored), turned];
    let rows = read.rows().iter().map(|row| MeanForce {
        force_n: [0, 1, 2].map(|k| row.force_n[k].map(|force| signs[k] * force)),
        ..*row
    });
    let of_file = |error: CutError| refused(&error.at(file, None));
    let series = Series::new(cut, rows.collect()).map_err(of_file)?;
    let fit = fit_coefficients(std::slice::from_ref(&series)).map_err(of_file)?;
    Ok(Fitted {
        fit,
        series,
        straight,
        mirrored,
    })
}

/// Sign of the force across the feed in a mirrored cut.
fn mirror(mirrored: bool) -> f64 {
    match mirrored {
        true => -1.0,
        false => 1.0,
    }
}

impl Fitted {
    /// The fitted force at a feed, as it is with this sense of the spindle.
    fn at(&self, feed_mm_per_tooth: f64) -> AtFeed {
        let cut = self.series.cut();
        let value = |i: usize| self.fit.coefficients[i].value;
        let law = kinetostat_cutting::Linear {
            cutting_n_per_mm2: [value(0), value(1), value(2)],
            edge_n_per_mm: [value(3), value(4), value(5)],
        };
        let [x, y, z] = cut.mean_force_n(&law, feed_mm_per_tooth);
        AtFeed {
            feed_mm_per_tooth,
            fitted_n: [x, mirror(self.mirrored) * y, z],
            half_width_95_n: self.fit.force_half_width_95(cut, feed_mm_per_tooth),
        }
    }
}

fn rows(of: &Fitted) -> Vec<FitRow> {
    let row = |row: &MeanForce| {
        let at = of.at(row.feed_mm_per_tooth);
        // A row without one of the three was refused by the fit.
        let [x, y, z] = row.force_n.map(|force| force.unwrap_or(f64::NAN));
        let force_n = [x, mirror(of.mirrored) * y, z];
        FitRow {
            feed_mm_per_tooth: row.feed_mm_per_tooth,
            force_n,
            fitted_n: at.fitted_n,
            residual_n: [0, 1, 2].map(|k| force_n[k] - at.fitted_n[k]),
            half_width_95_n: at.half_width_95_n,
        }
    };
    of.series.rows().iter().map(row).collect()
}

/// The largest half width of the interval of the fitted force at the feeds that were measured, in percent of the force.
fn of_interval(rows: &[FitRow]) -> Option<f64> {
    let share = |row: &FitRow| -> Option<f64> {
        let [x, y, z] = row.half_width_95_n;
        let (width, force) = ([x?, y?, z?], row.fitted_n);
        let norm = |v: [f64; 3]| v[0].hypot(v[1]).hypot(v[2]);
        Some(norm(width) / norm(force))
    };
    let shares: Option<Vec<f64>> = rows.iter().map(share).collect();
    let percent = 100.0 * shares?.into_iter().fold(0.0, larger);
    // Rounded up to a tenth: a band is not narrower than what it stands for.
    percent.is_finite().then(|| (10.0 * percent).ceil() / 10.0)
}

fn cut(of: &Fitted, rpm: Option<f64>, speed: Option<f64>) -> FitCut {
    let straight = &of.straight;
    let contact = straight.engagement.contacts.first();
    let (from, to) = contact.map_or((0.0, 0.0), |c| (c.entry, c.exit));
    FitCut {
        width_mm: straight.width_mm,
        depth_mm: straight.depth_mm,
        part: part_word(straight.part),
        milling: milling_word(straight.way),
        counter_clockwise: of.mirrored,
        arc_from_deg: from.to_degrees(),
        arc_to_deg: to.to_degrees(),
        rpm,
        cutting_speed_m_per_min: speed,
        chip_from_mm: of.fit.least_mean_chip_mm,
        chip_to_mm: of.fit.largest_chip_mm,
    }
}

fn coefficients(fit: &CoefficientFit) -> Vec<CoefficientAnswer> {
    let answer = |c: &kinetostat_cutting::Coefficient| CoefficientAnswer {
        symbol: c.symbol,
        unit: c.unit,
        value: c.value,
        standard_error: c.standard_error,
        low_95: c.half_width_95.map(|width| c.value - width),
        high_95: c.half_width_95.map(|width| c.value + width),
    };
    fit.coefficients.iter().map(answer).collect()
}

fn components(of: &Fitted, rows: &[FitRow]) -> Vec<Component> {
    let component = |k: usize| {
        let residuals: Vec<f64> = rows.iter().map(|row| row.residual_n[k]).collect();
        let largest = largest_size(residuals.iter().copied());
        let at = rows.iter().find(|row| row.residual_n[k].abs() >= largest);
        let squares: f64 = residuals.iter().map(|r| r * r).sum();
        Component {
            axis: ["x", "y", "z"][k],
            r_squared: of.fit.r_squared[k],
            residual_rms_n: (squares / rows.len() as f64).sqrt(),
            largest_residual_n: largest,
            largest_residual_at_feed_mm_per_tooth: at.map_or(f64::NAN, |r| r.feed_mm_per_tooth),
        }
    };
    (0..3).map(component).collect()
}

fn lines(of: &Fitted, rows: &[FitRow]) -> Vec<AtFeed> {
    let most = rows.iter().map(|row| row.feed_mm_per_tooth);
    let most = BEYOND * most.fold(0.0, larger);
    let feed = |i: usize| most * i as f64 / PLACES as f64;
    (0..=PLACES).map(|i| of.at(feed(i))).collect()
}

fn assumed(acts_on: ActsOnWord) -> Vec<String> {
    let mut list = Vec::new();
    if acts_on == ActsOnWord::Part {
        list.push(
            "The forces of the file act on the part; those on the tool have the other sign."
                .to_owned(),
        );
    }
    list.extend(
        [
            "Linear law: each length of edge bears K_c times the chip and K_e. The intervals (95 %, Student's t) take the errors of the means as independent and of one size, x and y together, z alone.",
            "The means are those of whole turns; run-out leaves them as they are while every tooth cuts.",
        ]
        .map(str::to_owned),
    );
    list
}
