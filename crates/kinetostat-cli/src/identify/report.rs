//! The report of an identification: what was found, how well it is known, and how well it fits, with pictures.

use kinetostat::{Mechanism, PostureRequest};
use kinetostat_identification::{
    ErrorAtWork, Identification, IdentifiedNumber, Observation, PostureResiduals,
};
use kinetostat_report::{Bar, Bars, Cell, Document, Placed, Plot, PlotLine, Section};

use crate::files::origin;
use crate::identify::answer::IdentifyAnswer;
use crate::identify::text;
use crate::ui::numbers::{fixed, number};

/// Limit of the numbers whose correlations are drawn: a matrix has 21.
const MOST_DRAWN: usize = 150;

/// The report of an answer; `observations` are those that were fitted.
pub(crate) fn report(
    a: &IdentifyAnswer,
    mechanism: &Mechanism,
    observations: &[Observation],
) -> Document {
    let found = &a.found;
    let made_by = format!("kinetostat {}", a.kinetostat_version);
    let mut out = Document::new("Identification of a machine", &a.model, &made_by);
    out.dated(origin::day());
    text::sentences(a).iter().for_each(|s| out.paragraph(s));
    if !found.findings.is_empty() {
        out.heading("What must be known");
        out.list(found.findings.iter().map(ToString::to_string));
    }
    out.heading("Numbers");
    let mut rows = text::rows(found.numbers.iter());
    let heads = rows.remove(0);
    let heads: Vec<&str> = heads.iter().map(String::as_str).collect();
    out.table(&heads[..2], &heads[2..], rows);
    let combined = |n: &IdentifiedNumber| {
        let known = n.known_combination.as_ref().filter(|_| !n.is_geometry())?;
        Some(format!("of {} only this is known: {known}", n.number))
    };
    out.list(found.numbers.iter().filter_map(combined));
    if !a.work.is_empty() {
        out.heading("Where the machine works");
        out.paragraph(&text::of_work(a));
        let shows = "Errors after compensation along the program, before and after identification";
        out.picture(along_work(a).svg(), shows);
    }
    out.picture(
        explained(found).svg(),
        "Part of the displacements that comes from each number",
    );
    if (2..=MOST_DRAWN).contains(&found.numbers.len()) {
        let shows =
            "Correlations of the numbers, counted as in the table: those near 1 are known together";
        out.picture(correlations(found).svg(), shows);
    }
    out.heading("How well it fits");
    let figures = ["read, mm", "left before, mm", "left after, mm"];
    let along = found.directions.iter();
    out.table(
        &["along"],
        &figures,
        along.map(|d| {
            let mut row = vec![d.axis.clone()];
            row.extend([d.reading_mm, d.before_mm, d.after_mm].map(|x| fixed(x, 4)));
            row
        }),
    );
    let shows = "Residuals of each posture before and after identification";
    out.picture(residuals(a).svg(), shows);
    let shows = "The machine in the postures that were measured, from the side";
    out.picture(postures(mechanism, observations).shape_svg(), shows);
    out.paragraph("Residuals of the postures in standard deviations of a reading:");
    let figures = ["readings", "before", "after", "left out"];
    let of = |r: &PostureResiduals| {
        let left_out = r.left_out.map_or_else(|| "-".to_owned(), |x| fixed(x, 2));
        let [before, after] = [r.before, r.after].map(|x| fixed(x, 2));
        vec![
            r.posture.clone(),
            r.readings.to_string(),
            before,
            after,
            left_out,
        ]
    };
    out.table(&["posture"], &figures, found.residuals.iter().map(of));
    out
}

/// Residuals of the postures before and after.
pub(crate) fn residuals(a: &IdentifyAnswer) -> Plot {
    let line = |name: &str, colour, of: &dyn Fn(&PostureResiduals) -> Option<f64>| {
        let numbered = (1..).zip(&a.found.residuals);
        let points = numbered.filter_map(|(i, r): (i32, _)| Some((f64::from(i), of(r)?)));
        PlotLine::solid(name, colour, points.collect())
    };
    Plot {
        title: format!("{}: residuals of {} postures", a.model, a.found.postures),
        x_label: "posture, in the order of the table".to_owned(),
        y_label: "root mean square, standard deviations of a reading".to_owned(),
        lines: vec![
            line("the model as it was", 1, &|r| Some(r.before)),
            line("identified", 0, &|r| Some(r.after)),
            line("identified from all other postures", 2, &|r| r.left_out),
        ],
        marks: Vec::new(),
    }
}

fn explained(found: &Identification) -> Bars {
    let bars = found.numbers.iter().map(|n| {
        let short = n.number.trim_start_matches("chain.");
        let short = short.trim_start_matches("deviation.");
        Bar {
            name: short.to_owned(),
            value: n.explains_mm,
            figure: format!("{} mm", number(n.explains_mm, 2)),
        }
    });
    Bars {
        title: "Part of the displacements that comes from each number, root mean square".to_owned(),
        bars: bars.collect(),
    }
}

/// Size of the correlation of each pair.
fn correlations(found: &Identification) -> Section {
    let c = &found.covariance;
    let count = c.len();
    let places: Vec<f64> = (1..).map(f64::from).take(count).collect();
    let size = |i: usize, k: usize| (c[i][k] / (c[i][i] * c[k][k]).sqrt()).abs();
    let cells = (0..count).flat_map(|k| (0..count).map(move |i| Cell::Value(size(i, k))));
    Section {
        title: "Correlations of the identified numbers".to_owned(),
        x_label: "number".to_owned(),
        y_label: "number".to_owned(),
        value_label: "size of the correlation".to_owned(),
        x: places.clone(),
        y: places,
        cells: cells.collect(),
        scale_from: Some(0.0),
        ..Section::default()
    }
}

/// The machine in all postures, seen along y of the base.
fn postures(mechanism: &Mechanism, observations: &[Observation]) -> Plot {
    let mut drawn: Vec<&[f64]> = Vec::new();
    let mut lines = Vec::new();
    for observation in observations {
        if drawn.contains(&observation.commands.as_slice()) {
            continue;
        }
        drawn.push(&observation.commands);
        let Ok(posture) = mechanism.posture(PostureRequest::commands(&observation.commands)) else {
            continue;
        };
        let limbs = Placed::at(&posture).limb_lines(mechanism);
        lines.extend(limbs.into_iter().map(|limb| {
            let points = limb.iter().map(|p| (1e3 * p.x, 1e3 * p.z)).collect();
            PlotLine::solid("", drawn.len() - 1, points)
        }));
    }
    Plot {
        title: format!("{} postures, seen along y of the base", drawn.len()),
        x_label: "x, mm".to_owned(),
        y_label: "z, mm".to_owned(),
        lines,
        marks: Vec::new(),
    }
}

/// Errors along the program of a job.
fn along_work(a: &IdentifyAnswer) -> Plot {
    let line = |name: &str, colour, of: &dyn Fn(&ErrorAtWork) -> Option<f64>| {
        let points = a.work.iter();
        let points = points.map(|w| (w.path_mm, of(&w.error).unwrap_or(f64::NAN)));
        PlotLine::solid(name, colour, points.collect())
    };
    Plot {
        title: "Errors of the program after compensation".to_owned(),
        x_label: "length of the path, mm".to_owned(),
        y_label: "mm".to_owned(),
        lines: vec![
            line("without compensation", 2, &|e| Some(e.displacement_mm)),
            line("compensated with the model as it was", 1, &|e| {
                Some(e.before_mm)
            }),
            line(
                "compensated with the identified one: less than this (95 %)",
                0,
                &|e| e.after_mm,
            ),
        ],
        marks: Vec::new(),
    }
}
