//! Pictures of a paper: the error along the path, and the path from above, the machine.

use kinetostat_machining::{PointKind, PointResult, Quantity};

use crate::chart::panel::Along;
use crate::chart::plot::{Look, Plot, PlotLine, stacked};
use crate::number;
use crate::paper::block::Block;
use crate::paper::content::of::Of;
use crate::paper::language::Language;
use crate::paper::words::table::fill;
use crate::run::plan;

/// The plots, and the machine where it is drawn; none without a path.
pub(super) fn pictures(of: &Of<'_>) -> Vec<Block> {
    let Some(along) = of.result.along() else {
        return Vec::new();
    };
    let machine = of.paper.machine.map(|machine| {
        let line = number::count(machine.line);
        Block::Picture {
            svg: machine.picture.clone(),
            shows: fill(of.words.picture_machine, &[("line", line.as_str())]),
        }
    });
    let look = |shape: bool| Look {
        shape,
        comma: of.language != Language::English,
        ..Look::default()
    };
    let words = of.words;
    let names = match of.paper.verified {
        Some(_) => [words.of_original, words.of_verified],
        None => [words.before, words.after],
    };
    let figures = &of.result.figures;
    let before = (Quantity::ErrorBefore, names[0], &figures.error_before);
    let after = (Quantity::ErrorAfter, names[1], &figures.error_after);
    let shown: &[_] = match of.has_after() {
        true => &[before, after],
        false => &[before],
    };
    let plots: Vec<Plot> = (shown.iter().enumerate())
        .map(|(k, of_one)| error(of, &along, *of_one, 1 - k))
        .collect();
    let plots: Vec<_> = plots.iter().map(|plot| (plot, look(false))).collect();
    let above = above(of);
    let plots = [
        (stacked(&plots, ""), words.picture_along),
        (stacked(&[(&above, look(true))], ""), words.picture_above),
    ]
    .map(|(svg, shows)| Block::Picture {
        svg,
        shows: shows.to_owned(),
    });
    plots.into_iter().chain(machine).collect()
}

fn error(
    of: &Of<'_>,
    along: &Along,
    (quantity, name, most): (Quantity, &str, &String),
    colour: usize,
) -> Plot {
    let values = of.result.curve(along, quantity, 1.0);
    let worst = number::largest(values.iter().flatten().map(|(_, mm)| *mm)).unwrap_or(0.0);
    let (unit, factor) = number::length_unit(worst);
    let lifted = (f64::NAN, f64::NAN);
    let points = values
        .iter()
        .map(|p| p.map_or(lifted, |(x, mm)| (x, mm * factor)));
    let path_unit = match along.factor < 1.0 {
        true => "m",
        false => "mm",
    };
    Plot {
        title: format!("{}, {name}: {}", of.words.largest_error, of.figure(most)),
        x_label: format!("{}, {path_unit}", of.words.along_path),
        y_label: format!("{}, {unit}", of.words.distance),
        lines: vec![PlotLine::solid("", colour, points.collect())],
        marks: Vec::new(),
    }
}

/// The programmed path from above, and that of the tool before the correction, its deviation magnified.
fn above(of: &Of<'_>) -> Plot {
    let words = of.words;
    let factor = plan::magnification(of.result).unwrap_or(1.0);
    let line = |name: &str, colour: usize, at: &dyn Fn(&PointResult) -> Option<[f64; 3]>| {
        let points = of.result.points.iter().map(|point| match at(point) {
            Some([x, y, _]) if point.kind != PointKind::Rapid => (x, y),
            _ => (f64::NAN, f64::NAN),
        });
        PlotLine::solid(name, colour, points.collect())
    };
    let times = of.figure(&number::setting(factor));
    Plot {
        title: words.picture_above.to_owned(),
        x_label: "X, mm".to_owned(),
        y_label: "Y, mm".to_owned(),
        lines: vec![
            line(words.programmed, 5, &|p| Some(p.position_mm)),
            line(
                &fill(words.displaced, &[("factor", times.as_str())]),
                1,
                &|p| plan::displaced(p, factor),
            ),
        ],
        marks: Vec::new(),
    }
}
