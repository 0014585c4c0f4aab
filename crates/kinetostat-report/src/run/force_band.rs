//! The error along the path if the force of the cut is larger or smaller by the spread of its coefficients.

use kinetostat_machining::{ForceBand, PointKind, PointResult, Quantity};

use crate::chart::Span;
use crate::chart::panel::{Along, Area, Panel, Series};
use crate::number::{self, Rounding, norm};
use crate::run::Shown;

/// A band that is wider than the error by less than this share of it cannot be seen.
const VISIBLE: f64 = 0.02;

/// The band of a compensated program, from what is left with the force as computed to what is left at most; none where it
/// cannot be seen.
pub(crate) fn panel(result: &Shown<'_>, along: &Along) -> Option<Panel> {
    let band = result.force_band.as_ref()?;
    let most = seen(result)?;
    let (unit, factor) = number::length_unit(most);
    let ends = |p: &PointResult| {
        let (more, less) = ends(p)?;
        let own = norm(&p.error_after_mm);
        Some((own.min(less), more.max(own)))
    };
    let span = Span {
        low: 0.0,
        high: most * factor,
    };
    Some(Panel {
        title: format!(
            "The same if the force is {} larger or smaller: up to {} off (line {})",
            spread(band),
            number::length(most, 3, Rounding::Up),
            number::count(band.line)
        ),
        y_label: format!("distance, {unit}"),
        span: span.widened().padded(0.0, 0.2),
        areas: vec![area(result, along, factor, ends)],
        series: vec![Series {
            class: "line after",
            values: result.curve(along, Quantity::ErrorAfter, factor),
        }],
        limits: Vec::new(),
        marks: Vec::new(),
    })
}

/// Largest error in the band, mm; none where the band cannot be seen beside the error itself.
fn seen(result: &Shown<'_>) -> Option<f64> {
    let most = result.force_band.as_ref()?.max_error_mm();
    let own = result.summary.max_position_error_after_mm;
    most.and_then(number::drawable)
        .filter(|most| *most > (1.0 + VISIBLE) * own)
}

/// The name of the band below the panels.
pub(crate) fn name(result: &Shown<'_>) -> Option<(&'static str, String)> {
    let band = result.force_band.as_ref()?;
    seen(result)?;
    Some(("area", format!("force {} larger or smaller", spread(band))))
}

/// The band around the error of a program that is only analysed.
pub(crate) fn without_compensation(result: &Shown<'_>, along: &Along, factor: f64) -> Vec<Area> {
    match result.force_band.is_some() && !result.run_inputs.compensated {
        true => vec![area(result, along, factor, ends)],
        false => Vec::new(),
    }
}

/// Largest error of a program that is only analysed, mm.
pub(crate) fn largest_without_compensation(result: &Shown<'_>) -> Option<f64> {
    let band = result.force_band.as_ref()?;
    let most = band.max_error_mm().and_then(number::drawable);
    most.filter(|_| !result.run_inputs.compensated)
}

/// The errors with the larger and the smaller force, the larger error first.
fn ends(p: &PointResult) -> Option<(f64, f64)> {
    let (a, b) = (p.error_if_force_larger_mm?, p.error_if_force_smaller_mm?);
    Some((a.max(b), a.min(b)))
}

/// An area over the points at which the band was solved; rapids end a piece of it.
fn area(
    result: &Shown<'_>,
    along: &Along,
    factor: f64,
    ends: impl Fn(&PointResult) -> Option<(f64, f64)>,
) -> Area {
    let solved = |p: &&PointResult| p.kind == PointKind::Rapid || ends(p).is_some();
    let values = result.points.iter().filter(solved).map(|p| {
        let (a, b) = ends(p).filter(|_| p.kind != PointKind::Rapid)?;
        let x = number::drawable(p.path_mm)? * along.factor;
        let (low, high) = (a.min(b), a.max(b));
        Some((
            x,
            number::drawable(low)? * factor,
            number::drawable(high)? * factor,
        ))
    });
    Area {
        values: values.collect(),
    }
}

fn spread(band: &ForceBand) -> String {
    let percent = number::significant(band.spread_percent, 2, Rounding::Nearest);
    number::with_unit(&percent, "%")
}
