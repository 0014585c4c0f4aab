//! One small picture of a run: the path from above and the error along it.

use kinetostat_machining::{PointKind, Quantity};

use crate::chart::axis::{Span, Tick};
use crate::chart::label::Frame;
use crate::chart::panel::{Panel, Series};
use crate::number::{self, norm};
use crate::run::plan;
use crate::run::shown::Shown;
use crate::svg::{Anchor, Svg};

const SIZE: (f64, f64) = (900.0, 420.0);

const STYLE: &str = concat!(
    include_str!("../template/palette.css"),
    include_str!("../template/plot.css")
);

/// Decades that are shown at most.
const MOST_DECADES: f64 = 7.0;

/// Draws the picture.
pub(crate) fn draw(result: &Shown<'_>) -> String {
    let mut svg = Svg::default();
    svg.rectangle("card", (0.5, 0.5), (SIZE.0 - 1.0, SIZE.1 - 1.0), 10.0);
    let frame = Frame {
        x: 66.0,
        y: 48.0,
        width: 330.0,
        height: 316.0,
    };
    let title = match plan::magnification(result) {
        Some(factor) => format!("Path from above, deviation × {}", number::setting(factor)),
        None => "Path from above".to_owned(),
    };
    plan::view_from_above(&mut svg, result, frame, &title);
    if !errors(&mut svg, result) {
        svg.text("name", (450.0, 210.0), Anchor::Middle, "no points to show");
    }
    svg.document(
        SIZE,
        "Deviation of the tool along the path, without and with compensation",
        STYLE,
    )
}

/// The error before and after over powers of ten; says if there was anything to draw.
fn errors(svg: &mut Svg, result: &Shown<'_>) -> bool {
    let Some(along) = result.along() else {
        return false;
    };
    let largest = |error: fn(&kinetostat_machining::PointResult) -> f64| {
        let cutting = result.points.iter().filter(|p| p.kind != PointKind::Rapid);
        number::largest(cutting.map(error)).filter(|error| *error > 0.0)
    };
    let before = largest(|p| norm(&p.error_before_mm));
    let after = largest(|p| norm(&p.error_after_mm)).filter(|_| result.run_inputs.compensated);
    let Some(top) = before.into_iter().chain(after).reduce(f64::max) else {
        return false;
    };
    // Room for a name above the upper curve, and for the ups and downs of the lower one.
    let high = top.log10() + 0.7;
    let low = after.unwrap_or(top / 30.0).log10() - 1.3;
    let span = Span {
        low: low.max(high - MOST_DECADES),
        high,
    };
    let curve = |quantity: Quantity| -> Vec<Option<(f64, f64)>> {
        let values = result.curve(&along, quantity, 1.0).into_iter();
        let shown = |value: f64| value.log10().clamp(span.low, span.high);
        values
            .map(|at| at.map(|(x, value)| (x, shown(value))))
            .collect()
    };
    let mut series = vec![Series {
        class: "line before",
        values: curve(Quantity::ErrorBefore),
    }];
    if after.is_some() {
        series.push(Series {
            class: "line after",
            values: curve(Quantity::ErrorAfter),
        });
    }
    let panel = Panel {
        title: "Distance from the programmed place".to_owned(),
        y_label: "distance".to_owned(),
        span,
        areas: Vec::new(),
        ticks: Some(
            (span.low.ceil() as i32..=span.high.floor() as i32)
                .map(decade)
                .collect(),
        ),
        series,
        limits: Vec::new(),
        marks: Vec::new(),
    };
    let frame = Frame {
        x: 506.0,
        y: 48.0,
        width: 372.0,
        height: 316.0,
    };
    panel.draw(svg, frame, (frame.x, SIZE.0 - 8.0), &along, true);
    let y_of =
        |error: f64| frame.bottom() - (error.log10() - span.low) / span.length() * frame.height;
    let named = [
        (
            "before-name",
            "without compensation",
            before,
            &result.figures.error_before,
        ),
        (
            "after-name",
            "with compensation",
            after,
            &result.figures.error_after,
        ),
    ];
    for (class, name, error, up_to) in named {
        if let Some(error) = error {
            let y = y_of(error) - 10.0;
            svg.text(
                class,
                (frame.right() - 8.0, y),
                Anchor::End,
                &format!("{name}: up to {up_to}"),
            );
        }
    }
    true
}

fn decade(power: i32) -> Tick {
    let value = 10f64.powi(power);
    let label = if power >= -2 {
        number::with_unit(&number::setting(value), "mm")
    } else {
        number::with_unit(&number::setting(value * 1000.0), "µm")
    };
    Tick {
        value: f64::from(power),
        label,
    }
}
