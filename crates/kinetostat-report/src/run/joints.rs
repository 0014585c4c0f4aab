//! Joint values along the path between their limits, and how near limits and ratings are.

use kinetostat_machining::{ActuatorColumn, PointKind, Quantity};
use minijinja::{Value, context};

use crate::chart::Span;
use crate::chart::panel::{Along, Limit, Mark, Panel, Series, Sheet};
use crate::run::Shown;
use crate::run::along::{MOST_ACTUATORS, grid};
use crate::{number, text};

/// Joint values over the path as small panels, with the limits that the model states; empty where no joint has limits.
pub(crate) fn figure(result: &Shown<'_>, sheet: Sheet) -> String {
    let actuators = &result.run_inputs.actuators;
    let Some(along) = result.along().filter(|_| actuators.iter().any(limited)) else {
        return String::new();
    };
    let drawn = actuators.iter().take(MOST_ACTUATORS).enumerate();
    let panels: Vec<Panel> = drawn
        .filter_map(|(index, actuator)| panel(result, &along, index, actuator))
        .collect();
    grid(
        &panels,
        &along,
        sheet,
        "Joint values along the path between their limits",
    )
}

fn limited(actuator: &ActuatorColumn) -> bool {
    actuator.limits.is_some()
}

fn panel(
    result: &Shown<'_>,
    along: &Along,
    index: usize,
    actuator: &ActuatorColumn,
) -> Option<Panel> {
    let values = result.curve(along, Quantity::ActuatorCommand(index), 1.0);
    let span = Span::of(values.iter().flatten().map(|value| value.1))?;
    let unit = text::shorten(&actuator.motion_unit, 8);
    let [low, high] = result.joints.ranges.get(index).copied()?;
    let title = format!(
        "{}: {} to {}",
        text::shorten(&actuator.name, 24),
        number::setting(low),
        number::with_unit(&number::setting(high), &unit)
    );
    let ends = actuator.limits.iter().flatten();
    let ends: Vec<f64> = ends.copied().filter_map(number::drawable).collect();
    let limits = ends.iter().map(|value| Limit {
        value: *value,
        label: format!("limit {}", tenths(*value)),
    });
    let with_limits = ends.iter().fold(span, |span, end| span.including(*end));
    Some(Panel {
        title,
        y_label: unit,
        span: with_limits.widened().padded(0.1, 0.1),
        areas: Vec::new(),
        series: vec![Series {
            class: "line strong",
            values,
        }],
        limits: limits.collect(),
        marks: nearest(result, along, index).into_iter().collect(),
    })
}

/// A limit beside a plot, to a tenth: models in radians have limits with many digits.
fn tenths(value: f64) -> String {
    number::setting((10.0 * value).round() / 10.0 + 0.0)
}

/// Mark where the joint is nearest to its limit, if it is the joint that comes nearest of all and cuts there.
fn nearest(result: &Shown<'_>, along: &Along, index: usize) -> Option<Mark> {
    let found = result.joints.nearest_limit.as_ref()?;
    if found.limit.actuator != index {
        return None;
    }
    let point = result
        .points
        .iter()
        .filter(|p| p.kind != PointKind::Rapid && p.line == found.line)
        .find(|p| p.position_mm == found.position_mm)?;
    let value = number::drawable(*point.actuator_command.get(index)?)?;
    let line = number::count(found.line);
    Some(Mark {
        at: (number::drawable(point.path_mm)? * along.factor, value),
        label: format!("line {line}"),
        tooltip: format!(
            "line {line}: {} from its {} limit",
            result.figures.nearest_limit.as_deref().unwrap_or_default(),
            found.limit.end.word()
        ),
    })
}

/// Facts on joints (nearest to its limit, most loaded, configuration of an arm): name, size, explanation. Empty for
/// machines whose model states neither limits nor ratings and which are no arms.
pub(crate) fn facts(result: &Shown<'_>) -> Vec<Value> {
    let row = |name: &str, size: String, text: String| context! { name, size, text };
    let figures = &result.figures;
    let mut rows = Vec::new();
    if let Some(distance) = &figures.nearest_limit {
        let at = text::shorten(&figures.nearest_limit_at, 120);
        let said = format!("The smallest distance of a joint to one of its limits: {at}.");
        rows.push(row("Nearest to a limit", distance.clone(), said));
    }
    if let Some(share) = &figures.share_of_rating {
        let at = text::shorten(&figures.share_of_rating_at, 120);
        let said = format!(
            "The largest force or torque of a drive as a share of the rating in the model: {at}."
        );
        rows.push(row("Load by rating", share.clone(), said));
    }
    if let Some(found) = &figures.configuration {
        let changes = result.joints.change_count;
        let size = match changes {
            0 => "no change".to_owned(),
            count => number::counted(count, "change"),
        };
        let way = result.joints.way_out.as_ref();
        let way = way.map_or_else(String::new, |way| format!(" {}.", way.description()));
        rows.push(row(
            "Configuration of the arm",
            size,
            format!("At the first cut: {found}.{way}"),
        ));
    }
    rows
}
