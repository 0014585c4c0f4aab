//! The band of the errors over machines that are not exactly as drawn.

use kinetostat_machining::{BandPlace, UncertaintyBand};

use crate::chart::Span;
use crate::chart::panel::{Along, Area, Panel, Series};
use crate::number::{self, typeset};
use crate::run::Shown;

/// The band of a compensated program: what is left of the error in nine machines of ten; none where nothing is uncertain.
pub(crate) fn panel(result: &Shown<'_>, along: &Along) -> Option<Panel> {
    let band = result.uncertainty.as_ref()?;
    let after = band.after.as_ref()?;
    let of = |place: &BandPlace| place.after_mm;
    let highest = most(band, of)?;
    let (unit, factor) = number::length_unit(highest);
    let span = Span {
        low: 0.0,
        high: highest * factor,
    };
    Some(Panel {
        title: format!(
            "Compensated, on {} machines as they may be built: at most {} off",
            number::count(band.machines),
            typeset(&after.band_text())
        ),
        y_label: format!("distance, {unit}"),
        span: span.widened().padded(0.0, 0.2),
        areas: vec![area(band, along, factor, of)],
        series: vec![Series {
            class: "line after",
            values: middle(band, along, factor, of),
        }],
        limits: Vec::new(),
        marks: Vec::new(),
    })
}

/// The name of the band below the panels.
pub(crate) fn name(result: &Shown<'_>) -> Option<(&'static str, String)> {
    result.uncertainty.as_ref()?;
    Some((
        "area",
        "nine in ten machines as they may be built".to_owned(),
    ))
}

/// The band around the error of the program as it is.
pub(crate) fn without_compensation(result: &Shown<'_>, along: &Along, factor: f64) -> Vec<Area> {
    let band = result.uncertainty.as_ref();
    band.map(|band| area(band, along, factor, |place| Some(place.before_mm)))
        .into_iter()
        .collect()
}

/// Upper end of that, mm.
pub(crate) fn largest_without_compensation(result: &Shown<'_>) -> Option<f64> {
    most(result.uncertainty.as_ref()?, |place| Some(place.before_mm))
}

/// The largest error of the program as it is, over all machines, in type.
pub(crate) fn before_text(result: &Shown<'_>) -> Option<String> {
    let band = result.uncertainty.as_ref()?;
    Some(typeset(&band.before.band_text()))
}

fn most(band: &UncertaintyBand, of: impl Fn(&BandPlace) -> Option<[f64; 3]>) -> Option<f64> {
    let ends = band.places.iter().filter_map(|place| Some(of(place)?[2]));
    number::largest(ends)
}

fn area(
    band: &UncertaintyBand,
    along: &Along,
    factor: f64,
    of: impl Fn(&BandPlace) -> Option<[f64; 3]>,
) -> Area {
    let value = |place: &BandPlace| {
        let [low, _, high] = of(place)?;
        let x = number::drawable(place.path_mm)? * along.factor;
        let [low, high] = [number::drawable(low)?, number::drawable(high)?];
        Some((x, low * factor, high * factor))
    };
    Area {
        values: band.places.iter().map(value).collect(),
    }
}

fn middle(
    band: &UncertaintyBand,
    along: &Along,
    factor: f64,
    of: impl Fn(&BandPlace) -> Option<[f64; 3]>,
) -> Vec<Option<(f64, f64)>> {
    let value = |place: &BandPlace| {
        let x = number::drawable(place.path_mm)? * along.factor;
        Some((x, number::drawable(of(place)?[1])? * factor))
    };
    band.places.iter().map(value).collect()
}
