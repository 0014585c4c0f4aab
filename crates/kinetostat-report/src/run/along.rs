//! Figures along the path: errors, forces and corrections of actuators, stiffness and load factor; panels under each other.

use kinetostat_machining::Quantity;
use kinetostat_machining::number::larger;

use crate::chart::Span;
use crate::chart::label::Frame;
use crate::chart::panel::{Along, Limit, Mark, Panel, Series, Sheet, legend};
use crate::number::{self, MISSING, Rounding, norm};
use crate::run::{Shown, force_band, uncertainty};
use crate::svg::Svg;
use crate::text;

/// Maximum number of actuators drawn; more are in the result file.
pub(crate) const MOST_ACTUATORS: usize = 12;

/// The error before and after compensation, one above the other; empty without points.
pub(crate) fn errors(result: &Shown<'_>, sheet: Sheet) -> String {
    let Some(along) = result.along() else {
        return String::new();
    };
    let mut panels = Vec::new();
    panels.extend(before_panel(result, &along, sheet));
    if result.run_inputs.compensated {
        panels.extend(after_panel(result, &along));
        panels.extend(force_band::panel(result, &along));
        panels.extend(uncertainty::panel(result, &along));
    }
    let heights = if sheet.narrow() {
        [170.0, 150.0, 130.0, 130.0]
    } else {
        [210.0, 160.0, 140.0, 140.0]
    };
    let names = force_band::name(result).into_iter();
    let names: Vec<_> = names.chain(uncertainty::name(result)).collect();
    stacked(
        &panels,
        &heights,
        &names,
        &along,
        sheet,
        "Distance of the tool from its programmed place along the path",
    )
}

/// Smallest stiffness and share of the way to buckling along the path.
pub(crate) fn stiffness(result: &Shown<'_>, sheet: Sheet) -> String {
    let Some(along) = result.along() else {
        return String::new();
    };
    let mut panels = Vec::new();
    let values = result.curve(&along, Quantity::SmallestStiffness, 1.0);
    if let Some(span) = span_of(&values) {
        panels.push(Panel {
            title: format!(
                "Smallest stiffness against a force: at least {}",
                result.figures.stiffness
            ),
            y_label: "stiffness, N/mm".to_owned(),
            span: span
                .with_near_zero()
                .widened()
                .moderate()
                .padded(0.08, 0.08),
            areas: Vec::new(),
            series: vec![Series {
                class: "line strong",
                values,
            }],
            limits: Vec::new(),
            marks: Vec::new(),
        });
    }
    let values = result.curve(&along, Quantity::ShareToBuckling, 100.0);
    if let (Some(span), Some(most)) = (span_of(&values), &result.figures.share_to_buckling) {
        // A share far from buckling would be pressed flat by the line at 100 %.
        let near = span.high > 20.0;
        let limits = near.then(|| Limit {
            value: 100.0,
            label: "100 %: buckling".to_owned(),
        });
        let span = span.including(0.0);
        let span = if near { span.including(100.0) } else { span };
        panels.push(Panel {
            title: format!("Share of the way to buckling: at most {most}"),
            y_label: "share, %".to_owned(),
            span: span.widened().padded(0.08, 0.24),
            areas: Vec::new(),
            series: vec![Series {
                class: "line strong",
                values,
            }],
            limits: limits.into_iter().collect(),
            marks: Vec::new(),
        });
    }
    let heights = if sheet.narrow() {
        [140.0, 130.0]
    } else {
        [160.0, 130.0]
    };
    stacked(
        &panels,
        &heights,
        &[],
        &along,
        sheet,
        "Smallest stiffness against a force and share of the way to buckling along the path",
    )
}

/// Forces and corrections of the actuators as small panels; empty without points or actuators.
pub(crate) fn actuators(result: &Shown<'_>, sheet: Sheet) -> String {
    let Some(along) = result.along() else {
        return String::new();
    };
    let mut panels = Vec::new();
    for (index, actuator) in result
        .run_inputs
        .actuators
        .iter()
        .take(MOST_ACTUATORS)
        .enumerate()
    {
        let name = text::shorten(&actuator.name, 24);
        let turning = actuator.force_unit.contains('m');
        let word = if turning { "torque" } else { "force" };
        let values = result.curve(&along, Quantity::ActuatorForce(index), 1.0);
        let most = result.figures.actuator_force.get(index);
        panels.extend(actuator_panel(
            &name,
            word,
            &actuator.force_unit,
            most,
            values,
        ));
        if result.run_inputs.compensated {
            let values = result.curve(&along, Quantity::ActuatorCorrection(index), 1.0);
            panels.extend(actuator_panel(
                &name,
                "correction",
                &actuator.motion_unit,
                result.figures.actuator_correction.get(index),
                values,
            ));
        }
    }
    share_spans(&mut panels);
    grid(
        &panels,
        &along,
        sheet,
        "Forces and corrections of the actuators along the path",
    )
}

fn before_panel(result: &Shown<'_>, along: &Along, sheet: Sheet) -> Option<Panel> {
    let worst = number::largest(result.cutting_points().map(|p| norm(&p.error_before_mm)))?;
    let bands = [
        force_band::largest_without_compensation(result),
        uncertainty::largest_without_compensation(result),
    ];
    let worst = bands.into_iter().flatten().fold(worst, larger);
    let (unit, factor) = number::length_unit(worst);
    let most = &result.figures.error_before;
    let over_machines = uncertainty::before_text(result);
    let over_machines = over_machines.map(|text| format!("; over all machines {text}"));
    let mut areas = force_band::without_compensation(result, along, factor);
    areas.extend(uncertainty::without_compensation(result, along, factor));
    Some(Panel {
        title: format!(
            "Without compensation: up to {most} off{}",
            over_machines.unwrap_or_default()
        ),
        y_label: format!("distance, {unit}"),
        span: Span {
            low: 0.0,
            high: worst * factor,
        }
        .widened()
        .padded(0.0, 0.2),
        areas,
        series: vec![Series {
            class: "line before",
            values: result.curve(along, Quantity::ErrorBefore, factor),
        }],
        limits: Vec::new(),
        marks: worst_marks(result, along, factor, sheet),
    })
}

fn after_panel(result: &Shown<'_>, along: &Along) -> Option<Panel> {
    let (place, worst) = result
        .cutting_points()
        .filter_map(|p| Some((p, number::drawable(norm(&p.error_after_mm))?)))
        .reduce(|a, b| if b.1 > a.1 { b } else { a })?;
    let (unit, factor) = number::length_unit(worst);
    let most = &result.figures.error_after;
    // The bound that errors are compared with, not a part of it.
    let tolerance = result.allowed_mm();
    let mut span = Span {
        low: 0.0,
        high: worst * factor,
    }
    .widened();
    let mut limits = Vec::new();
    // A tolerance far above the curve would press it flat.
    if tolerance > 0.0 && tolerance <= 6.0 * worst {
        span = span.including(tolerance * factor);
        limits.push(Limit {
            value: tolerance * factor,
            label: format!(
                "allowed {}",
                number::against(result.summary.max_position_error_after_mm, tolerance).1
            ),
        });
    }
    let mark = number::drawable(place.path_mm).map(|x| Mark {
        at: (x * along.factor, worst * factor),
        label: format!("line {}", number::count(place.line)),
        tooltip: format!("line {}: {most} off", number::count(place.line)),
    });
    Some(Panel {
        title: format!("With compensation: at most {most} off"),
        y_label: format!("distance, {unit}"),
        span: span.padded(0.0, 0.22),
        areas: Vec::new(),
        series: vec![Series {
            class: "line after",
            values: result.curve(along, Quantity::ErrorAfter, factor),
        }],
        limits,
        marks: mark.into_iter().collect(),
    })
}

/// The worst points that are apart from each other: neighbours would only cover one another.
fn worst_marks(result: &Shown<'_>, along: &Along, factor: f64, sheet: Sheet) -> Vec<Mark> {
    let (most, apart) = if sheet.narrow() { (2, 0.2) } else { (4, 0.08) };
    let mut marks: Vec<Mark> = Vec::new();
    for point in &result.worst_points {
        let error = norm(&point.error_before_mm);
        let (Some(x), Some(y)) = (number::drawable(point.path_mm), number::drawable(error)) else {
            continue;
        };
        let x = x * along.factor;
        let near = |mark: &Mark| (mark.at.0 - x).abs() < apart * along.span.length();
        if marks.len() == most || marks.iter().any(near) {
            continue;
        }
        let line = number::count(point.line);
        marks.push(Mark {
            at: (x, y * factor),
            label: format!("line {line}"),
            tooltip: format!(
                "line {line}: {} off",
                number::length(error, 3, Rounding::Nearest)
            ),
        });
    }
    marks
}

fn actuator_panel(
    name: &str,
    word: &str,
    unit: &str,
    most: Option<&String>,
    values: Vec<Option<(f64, f64)>>,
) -> Option<Panel> {
    // The title tells the largest value, a spike included.
    let span = Span::without_spikes(values.iter().flatten().map(|value| value.1))?;
    let most = most.map_or_else(|| MISSING.to_owned(), |most| text::clean(most));
    Some(Panel {
        title: format!("{name}: {word} up to {most}"),
        y_label: text::shorten(unit, 8),
        span: span.with_near_zero().widened().moderate(),
        areas: Vec::new(),
        series: vec![Series {
            class: if word == "correction" {
                "line after"
            } else {
                "line strong"
            },
            values,
        }],
        limits: Vec::new(),
        marks: Vec::new(),
    })
}

/// Panels of one unit get one scale if that leaves every curve readable.
fn share_spans(panels: &mut [Panel]) {
    let kinds: Vec<(String, &'static str)> = panels
        .iter()
        .map(|panel| {
            (
                panel.y_label.clone(),
                panel.series.first().map_or("", |s| s.class),
            )
        })
        .collect();
    let original: Vec<Span> = panels.iter().map(|panel| panel.span).collect();
    for (index, panel) in panels.iter_mut().enumerate() {
        let group = original
            .iter()
            .zip(&kinds)
            .filter(|(_, kind)| **kind == kinds[index]);
        let group: Vec<Span> = group.map(|(span, _)| *span).collect();
        let joined = group
            .iter()
            .copied()
            .reduce(Span::joined)
            .unwrap_or(panel.span);
        if group
            .iter()
            .all(|span| span.length() > joined.length() / 5.0)
        {
            panel.span = joined;
        }
        panel.span = panel.span.padded(0.1, 0.1);
    }
}

fn span_of(values: &[Option<(f64, f64)>]) -> Option<Span> {
    Span::of(values.iter().flatten().map(|value| value.1))
}

/// Panels under each other as an element of the page; empty without panels.
fn stacked(
    panels: &[Panel],
    heights: &[f64],
    names: &[(&str, String)],
    along: &Along,
    sheet: Sheet,
    description: &str,
) -> String {
    if panels.is_empty() {
        return String::new();
    }
    let (svg, height) = stack(panels, heights, along, sheet.width(), names);
    svg.inline(sheet.class(), [sheet.width(), height], description)
}

/// Small panels in two columns, or one on a narrow sheet.
pub(crate) fn grid(panels: &[Panel], along: &Along, sheet: Sheet, description: &str) -> String {
    if panels.is_empty() {
        return String::new();
    }
    let columns = if sheet.narrow() { 1 } else { 2 };
    let height = if sheet.narrow() { 76.0 } else { 84.0 };
    let gutter = panels.iter().map(|p| p.gutter(height)).fold(0.0, f64::max);
    let column_width =
        (sheet.width() - 14.0 + 22.0) / columns as f64 - 22.0 * f64::from(columns > 1);
    let rows = panels.len().div_ceil(columns);
    let title = column_width - 8.0;
    let titles = panels.iter().map(|p| p.more_title(title));
    let above = 26.0 + titles.fold(0.0, f64::max);
    let row_height = above + height + 12.0;
    let mut svg = Svg::default();
    for (index, panel) in panels.iter().enumerate() {
        let (row, column) = (index / columns, index % columns);
        let frame = Frame {
            x: gutter + column as f64 * (column_width + 22.0),
            y: above + row as f64 * row_height,
            width: column_width - gutter - if columns == 1 { 22.0 } else { 0.0 },
            height,
        };
        // Below the last panel of each column stand the numbers.
        let left = 4.0 + column as f64 * (column_width + 22.0);
        let room = Span {
            low: left,
            high: left + title,
        };
        let numbered = index + columns >= panels.len();
        panel.draw(&mut svg, frame, room, along, numbered);
    }
    let total = rows as f64 * row_height + 34.0;
    svg.inline(sheet.class(), [sheet.width(), total], description)
}

/// Heights of the frames of panels that have none of their own, pixels.
const HEIGHT: f64 = 130.0;

/// Panels with the heights of their frames on a drawing of a width, and below them what the names of lines mean; gives the
/// drawing and its height.
pub(crate) fn stack(
    panels: &[Panel],
    heights: &[f64],
    along: &Along,
    width: f64,
    names: &[(&str, String)],
) -> (Svg, f64) {
    let mut svg = Svg::default();
    let heights = || heights.iter().copied().chain(std::iter::repeat(HEIGHT));
    let gutter = panels
        .iter()
        .zip(heights())
        .map(|(p, h)| p.gutter(h))
        .fold(0.0, f64::max);
    let room = Span {
        low: 4.0,
        high: width - 4.0,
    };
    let mut y = 26.0;
    for (index, (panel, height)) in panels.iter().zip(heights()).enumerate() {
        y += panel.more_title(room.length());
        let frame = Frame {
            x: gutter,
            y,
            width: width - gutter - 14.0,
            height,
        };
        panel.draw(&mut svg, frame, room, along, index + 1 == panels.len());
        y += height + 42.0;
    }
    y += 14.0;
    let mut entries = names.to_vec();
    if along.has_rapids() {
        entries.push(("rapids", "rapid move (nothing is cut)".to_owned()));
    }
    if !entries.is_empty() {
        y += legend(&mut svg, &entries, [gutter, y], width);
    }
    (svg, y - 8.0)
}
