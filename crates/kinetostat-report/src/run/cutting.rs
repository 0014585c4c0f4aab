//! The cut along the path: charts of the force with its band, its parts, depth and arc in the material, torque and the spindle's
//! limit; a sentence and the lines with the largest forces; the stock from above.

use kinetostat_machining::{CutPlace, CuttingResult};
use minijinja::{Value, context};

use crate::chart::Span;
use crate::chart::panel::{Along, Area, Limit, Mark, Panel, Series, Sheet};
use crate::chart::plot::Plot;
use crate::chart::section::Section;
use crate::number::{self, MISSING, Rounding};
use crate::run::Shown;
use crate::run::along::stack;
use crate::svg::{Anchor, Svg};

/// A limit so many times above the curve is said, not drawn: it would press the curve flat.
const FAR: f64 = 4.0;

/// The figure of the report; empty where no force was computed from the cut.
pub(crate) fn figure(result: &Shown<'_>, sheet: Sheet) -> String {
    let Some(cutting) = &result.cutting else {
        return String::new();
    };
    match charts(cutting, sheet.width()) {
        Some((svg, height)) => svg.inline(
            sheet.class(),
            [sheet.width(), height],
            "Force, engagement and torque of the cut along the path",
        ),
        None => String::new(),
    }
}

/// All panels on a drawing of a width, with its height; none where nothing is cut.
pub(crate) fn charts(cutting: &CuttingResult, width: f64) -> Option<(Svg, f64)> {
    cutting.largest_force?;
    let along = Along::of(&cutting.places)?;
    let most = if width < 500.0 { 2 } else { 4 };
    let panels: Vec<Panel> = [
        force(cutting, &along, most),
        parts(cutting, &along),
        depth(cutting, &along),
        arc(cutting, &along),
        torque(cutting, &along),
    ]
    .into_iter()
    .flatten()
    .collect();
    let mut names = Vec::new();
    if cutting.spread_percent > 0.0 {
        names.push(("area", format!("force {} more or less", spread(cutting))));
    }
    for (class, name) in PARTS {
        names.push((class, name.to_owned()));
    }
    let limited = panels
        .last()
        .is_some_and(|p| p.series.iter().any(|s| s.class == "limit"));
    if limited {
        names.push(("limit", "torque that the spindle gives".to_owned()));
    }
    let heights = [150.0, 130.0, 90.0, 90.0, 110.0];
    Some(stack(&panels, &heights, &along, width, &names))
}

/// The force's parts as they are named below the panels.
const PARTS: [(&str, &str); 3] = [
    ("line c0", "along the feed"),
    ("line c1", "to its left"),
    ("line c2", "along the tool"),
];

fn force(cutting: &CuttingResult, along: &Along, most_marks: usize) -> Option<Panel> {
    let largest = cutting.largest_force?;
    let share = 0.01 * cutting.spread_percent;
    let values = along.values(&cutting.places, |p| Some(p.force_n()));
    let band = values
        .iter()
        .map(|v| v.map(|(x, y)| (x, (1.0 - share) * y, (1.0 + share) * y)))
        .collect();
    let mut marks: Vec<Mark> = Vec::new();
    for place in &cutting.worst_lines {
        let Some(x) = number::drawable(place.path_mm) else {
            continue;
        };
        let x = x * along.factor;
        let near = |mark: &Mark| (mark.at.0 - x).abs() < 0.12 * along.span.length();
        if marks.len() < most_marks && !marks.iter().any(near) {
            let line = number::count(place.line);
            marks.push(Mark {
                at: (x, place.force_n()),
                label: format!("line {line}"),
                tooltip: format!("line {line}: {}", with_unit(place.force_n(), "N")),
            });
        }
    }
    let beyond = match share > 0.0 {
        true => format!(
            ", {} if it is {} more",
            with_unit((1.0 + share) * largest.force_n(), "N"),
            spread(cutting)
        ),
        false => String::new(),
    };
    let mut panel = panel(
        format!(
            "Force on the tool: up to {}{beyond}",
            at(&largest, largest.force_n(), "N")
        ),
        "force, N",
        vec![strong(values)],
    )?;
    panel.span = panel.span.including((1.0 + share) * largest.force_n());
    panel.span = panel.span.padded(0.0, 0.2);
    if share > 0.0 {
        panel.areas.push(Area { values: band });
    }
    panel.marks = marks;
    Some(panel)
}

fn parts(cutting: &CuttingResult, along: &Along) -> Option<Panel> {
    let of = |k: usize, figure: fn(&CutPlace) -> f64| Series {
        class: PARTS[k].0,
        values: along.values(&cutting.places, |p| Some(figure(p))),
    };
    let panel = panel(
        "Parts of the force".to_owned(),
        "force, N",
        vec![
            of(0, |p| p.force_along_feed_n),
            of(1, |p| p.force_left_n),
            of(2, |p| p.force_up_n),
        ],
    )?;
    Some(Panel {
        span: panel.span.padded(0.08, 0.08),
        ..panel
    })
}

fn depth(cutting: &CuttingResult, along: &Along) -> Option<Panel> {
    let deepest = largest(cutting, |p| p.depth_mm)?;
    let values = along.values(&cutting.places, |p| Some(p.depth_mm));
    let title = format!(
        "Depth in the material: up to {}",
        at(deepest, deepest.depth_mm, "mm")
    );
    let panel = panel(title, "depth, mm", vec![strong(values)])?;
    Some(Panel {
        span: panel.span.padded(0.0, 0.12),
        ..panel
    })
}

fn arc(cutting: &CuttingResult, along: &Along) -> Option<Panel> {
    let longest = largest(cutting, |p| p.arc_deg)?;
    let values = along.values(&cutting.places, |p| Some(p.arc_deg));
    let title = format!(
        "Arc in the material (180 deg is a slot): up to {}",
        at(longest, longest.arc_deg, "deg")
    );
    let panel = panel(title, "arc, deg", vec![strong(values)])?;
    Some(Panel {
        span: panel.span.padded(0.0, 0.12),
        ..panel
    })
}

fn torque(cutting: &CuttingResult, along: &Along) -> Option<Panel> {
    let largest = cutting.largest_torque?;
    let power = cutting.largest_power?;
    let limit = cutting.nearest_to_spindle;
    let values = along.values(&cutting.places, |p| Some(p.torque_n_m));
    let share = match limit.and_then(|p| Some((p, p.share_of_spindle()?))) {
        Some((place, share)) if place.line == largest.line => {
            format!(", {} of what it gives", percent(share))
        }
        Some((place, share)) => format!(
            ", at line {} {} of what it gives",
            number::count(place.line),
            percent(share)
        ),
        None => String::new(),
    };
    let title = format!(
        "Torque of the spindle: up to {}{share}; power up to {}",
        at(&largest, largest.torque_n_m, "N m"),
        with_unit(power.power_w, "W")
    );
    let mut panel = panel(title, "torque, N m", vec![strong(values)])?;
    let limits = || cutting.places.iter().filter_map(|p| p.spindle_torque_n_m);
    let highest = limits().reduce(kinetostat::number::larger);
    let lowest = limits().reduce(kinetostat::number::smaller);
    if let (Some(low), Some(high)) = (lowest, highest)
        && high < FAR * largest.torque_n_m
    {
        panel.span = panel.span.including(high);
        match low == high {
            true => panel.limits.push(Limit {
                value: high,
                label: format!("the spindle gives {}", with_unit(high, "N m")),
            }),
            // Draws, for several speeds, the limit of each where it is used.
            false => panel.series.push(Series {
                class: "limit",
                values: along.values(&cutting.places, |p| p.spindle_torque_n_m),
            }),
        }
    }
    panel.span = panel.span.padded(0.0, 0.22);
    Some(panel)
}

/// The one line of a panel.
fn strong(values: Vec<Option<(f64, f64)>>) -> Series {
    Series {
        class: "line strong",
        values,
    }
}

/// A panel of lines from zero; none if nothing can be drawn.
fn panel(title: String, y_label: &str, series: Vec<Series>) -> Option<Panel> {
    let all = series.iter().flat_map(|line| line.values.iter().flatten());
    let span = Span::of(all.map(|(_, y)| *y))?;
    Some(Panel {
        title,
        y_label: y_label.to_owned(),
        span: span.including(0.0).widened(),
        areas: Vec::new(),
        series,
        limits: Vec::new(),
        marks: Vec::new(),
    })
}

/// The place with the largest figure.
fn largest(cutting: &CuttingResult, figure: fn(&CutPlace) -> f64) -> Option<&CutPlace> {
    let places = cutting.places.iter();
    places.max_by(|a, b| figure(a).total_cmp(&figure(b)))
}

/// A value with its unit and line.
fn at(place: &CutPlace, value: f64, unit: &str) -> String {
    format!(
        "{} (line {})",
        with_unit(value, unit),
        number::count(place.line)
    )
}

fn with_unit(value: f64, unit: &str) -> String {
    number::with_unit(&number::significant(value, 3, Rounding::Nearest), unit)
}

/// A share in whole percent.
pub(crate) fn percent(share: f64) -> String {
    number::with_unit(&number::fixed(100.0 * share, 0), "%")
}

/// The spread, as in `25 %`.
pub(crate) fn spread(cutting: &CuttingResult) -> String {
    with_unit(cutting.spread_percent, "%")
}

/// The section's content; nothing where no force was computed from the cut or nothing is cut.
pub(crate) fn section(result: &Shown<'_>, figure: Value) -> Value {
    let Some(cut) = result.cutting.as_ref().filter(|_| figure.is_true()) else {
        return Value::from(());
    };
    let limited = cut.nearest_to_spindle.is_some();
    let rows: Vec<Value> = cut.worst_lines.iter().map(row).collect();
    let reduced = (cut.places.len() >= CuttingResult::MAX_PLACES / 2
        && cut.stations > cut.places.len())
    .then(|| {
        format!(
            "Drawn from {} of {} places: of every stretch those with the largest and the smallest values.",
            number::count(cut.places.len()),
            number::count(cut.stations)
        )
    });
    context! { sentence => sentence(cut), figure, rows, limited, reduced }
}

fn sentence(cut: &CuttingResult) -> String {
    let band = match cut.spread_percent > 0.0 {
        true => format!(
            "Coefficients of tables fit another batch or tool to {}: the band shows it.",
            spread(cut)
        ),
        false => String::new(),
    };
    let spindle = match cut
        .nearest_to_spindle
        .as_ref()
        .and_then(CutPlace::share_of_spindle)
    {
        Some(share) if share > 1.0 => {
            " The spindle has not the torque that is needed: see the warnings."
        }
        _ => "",
    };
    format!(
        "{band}{spindle} The lines with the largest forces stand below; what was assumed, at the end of the report."
    )
}

fn row(p: &CutPlace) -> Value {
    let digits = |value: f64| number::significant(value, 3, Rounding::Nearest);
    let parts = [p.force_along_feed_n, p.force_left_n, p.force_up_n];
    context! {
        line => number::count(p.line),
        force => number::fixed(p.force_n(), 1),
        parts => parts.map(|n| number::fixed(n, 1)).to_vec(),
        torque => digits(p.torque_n_m),
        share => p.share_of_spindle().map_or_else(|| MISSING.to_owned(), percent),
        power => digits(p.power_w),
        depth => number::fixed(p.depth_mm, 2),
        arc => number::fixed(p.arc_deg, 0),
        chip => digits(p.chip_mm),
    }
}

/// Width of the picture, that of a section, pixels.
const WIDTH: f64 = 760.0;

/// Style of bands.
const AREA: &str = include_str!("../template/area.css");

/// Room around the charts, pixels.
const MARGIN: f64 = 16.0;

/// The picture as a document; `map` is the stock, where it is known.
pub(crate) fn engagement(cutting: &CuttingResult, map: Option<&Section>, title: &str) -> String {
    let mut svg = Svg::default();
    let mut down = 0.0;
    if let Some(map) = map {
        let (drawn, size) = map.fitted();
        svg.below(0.0, &drawn);
        down = size[1] + 8.0;
    }
    let mut lower = Svg::default();
    let height = match charts(cutting, WIDTH - 2.0 * MARGIN) {
        Some((charts, height)) => {
            lower.at([MARGIN, 12.0], &charts);
            height + 24.0
        }
        None => {
            lower.text(
                "name",
                [0.5 * WIDTH, 60.0],
                Anchor::Middle,
                "nothing is cut",
            );
            110.0
        }
    };
    let mut card = Svg::default();
    card.rectangle("card", [0.5, 0.5], [WIDTH - 1.0, height - 1.0], 10.0);
    svg.below(down, &card);
    svg.below(down, &lower);
    let style = [Plot::style(), Section::style(), AREA].concat();
    svg.document([WIDTH, down + height], title, &style)
}
