//! Warnings about fitted coefficients.

use kinetostat::number::{larger, smaller};
use kinetostat_machining::{Warning, WarningCode as Code};

use crate::force::fit::answer::{CoefficientAnswer, FitAnswer, FitRow};
use crate::ui::numbers::{given, number};

/// Feeds by which a straight line can be judged, and those that show how straight it is.
const FEEDS: (usize, usize) = (3, 5);
/// The largest feed should be so many times the smallest: the edge force is where the line meets no feed at all.
const RANGE: f64 = 2.0;
/// A largest feed so many times the next one decides the slope alone.
const FAR: f64 = 3.0;
/// Feed per tooth, as a share of the diameter, that hardly anybody mills with.
const LARGE: f64 = 0.05;
/// Residuals beyond so many times their scatter, in so many rows.
const OUTLIER: (f64, usize) = (2.5, 8);
/// Scatter, as a share of the force, that is no straight line any more.
const SCATTER: f64 = 0.1;
/// Tangential coefficients from soft plastic to nickel alloys, N/mm2.
const TANGENTIAL: [f64; 2] = [20.0, 15_000.0];

pub(super) fn findings(a: &FitAnswer, diameter_mm: f64) -> Vec<Warning> {
    let mut list = Vec::new();
    let mut say = |code, message: String| list.push(Warning::new(code, message));
    if let Some(message) = exchanged_axes(&a.coefficients) {
        say(Code::ImplausibleCoefficient, message);
    }
    if let Some(message) = odd_sign(&a.coefficients, a.tool.helix_deg) {
        say(Code::ImplausibleCoefficient, message);
    }
    for message in of_coefficients(&a.coefficients, a.acts_on) {
        say(Code::ImplausibleCoefficient, message);
    }
    for c in &a.coefficients {
        if let Some(message) = wide(c) {
            say(Code::UncertainCoefficient, message);
        }
    }
    for (code, message) in of_feeds(&a.rows, diameter_mm) {
        say(code, message);
    }
    for message in outliers(&a.rows) {
        say(Code::OutliersInMeans, message);
    }
    if let Some(message) = poor(&a.rows) {
        say(Code::PoorFit, message);
    }
    list
}

/// Objection to a radial coefficient above the tangential one.
pub(crate) fn radial_above_tangential([radial, tangential]: [f64; 2], unit: &str) -> String {
    format!(
        "K_rc = {} {unit} is above K_tc = {} {unit}, and no chip pushes the tooth more than it brakes it",
        number(radial, 3),
        number(tangential, 3)
    )
}

/// Coefficients that no material has, and that exchanged axes make.
pub(super) fn exchanged_axes(all: &[CoefficientAnswer]) -> Option<String> {
    let of = |symbol: &str| all.iter().find(|c| c.symbol == symbol);
    let (tangential, radial) = (of("K_tc")?, of("K_rc")?);
    if tangential.value <= 0.0 {
        return None;
    }
    let low = |c: &CoefficientAnswer| c.low_95.unwrap_or(c.value);
    let high = |c: &CoefficientAnswer| c.high_95.unwrap_or(c.value);
    if low(radial) > high(tangential) {
        return Some(format!(
            "{}: x (along the feed) and y (to its left) of the forces look exchanged. Exchange fx_n and fy_n with their signs, or correct on which side the part was",
            radial_above_tangential([radial.value, tangential.value], radial.unit)
        ));
    }
    None
}

/// An axial coefficient with a sign that the helix does not make; with friction above 1 it may.
fn odd_sign(all: &[CoefficientAnswer], helix_deg: f64) -> Option<String> {
    let axial = all.iter().find(|c| c.symbol == "K_ac")?;
    let low = axial.low_95.unwrap_or(axial.value);
    let high = axial.high_95.unwrap_or(axial.value);
    let (is_odd, helix, side) = match helix_deg < 0.0 {
        true => (high < 0.0, "pushes the chip down", "towards the spindle"),
        false => (
            helix_deg > 0.0 && low > 0.0,
            "lifts the chip",
            "to the part",
        ),
    };
    is_odd.then(|| {
        format!(
            "K_ac = {} {}: positive pushes the tool towards the spindle, and a helix that {helix} pushes it {side} (the part the other way). Turn the sign of fz_n (z is along the tool towards the spindle), or state the helix with its sign (--helix-deg)",
            number(axial.value, 3),
            axial.unit
        )
    })
}

/// Coefficients that hardly any material has.
fn of_coefficients(all: &[CoefficientAnswer], acts_on: &str) -> Vec<String> {
    let mut list = Vec::new();
    let other = match acts_on {
        "part" => "tool",
        _ => "part",
    };
    if let Some(c) = all.iter().find(|c| c.symbol == "K_tc" && c.value < 0.0) {
        // The others follow from the same mistake.
        return vec![format!(
            "K_tc = {} {}: the chip would pull the tooth along. If the forces of the file are those on the {other}, give --acts-on {other}; else look at its axes and signs, and on which side the part was",
            number(c.value, 3),
            c.unit
        )];
    }
    for c in all {
        let value = format!("{} = {} {}", c.symbol, number(c.value, 3), c.unit);
        // The interval tells a sign from what scatter may make.
        let below_zero = c.high_95.unwrap_or(c.value) < 0.0;
        match c.symbol {
            "K_tc" if !(TANGENTIAL[0]..=TANGENTIAL[1]).contains(&c.value) => list.push(format!(
                "{value}: plastics have some tens, nickel alloys some thousands; look at the units of feed and force, and at depth and teeth"
            )),
            "K_te" if below_zero => list.push(format!(
                "{value}: the line meets no feed below no force. A signal that was not set to zero in air, or forces that do not grow straight with the feed, give that"
            )),
            "K_rc" | "K_re" if below_zero => list.push(format!(
                "{value}: the part would pull the edge in, which sharp edges with a large rake alone do; look at signs and axes, and on which side the part was"
            )),
            _ => {}
        }
    }
    list
}

/// A cutting coefficient that is not known to a half of it, where that is much beside the tangential one.
fn wide(c: &CoefficientAnswer) -> Option<String> {
    let (low, high) = (c.low_95?, c.high_95?);
    let tangential = c.symbol == "K_tc";
    let half = 0.5 * (high - low);
    (tangential && half > 0.5 * c.value.abs()).then(|| {
        format!(
            "{} is known to +-{} {} only: more feeds, further apart, or longer means",
            c.symbol,
            number(half, 2),
            c.unit
        )
    })
}

fn of_feeds(rows: &[FitRow], diameter_mm: f64) -> Vec<(Code, String)> {
    let mut feeds: Vec<f64> = rows.iter().map(|row| row.feed_mm_per_tooth).collect();
    feeds.sort_by(f64::total_cmp);
    feeds.dedup_by(|a, b| (*a - *b).abs() <= 1e-6 * *b);
    let mut list = Vec::new();
    let count = feeds.len();
    if count < FEEDS.0 {
        list.push((
            Code::FeedsOfFit,
            format!("{count} feeds: any two points lie on a line, and nobody sees whether the force grows straight with the feed; measure five"),
        ));
    } else if count < FEEDS.1 {
        list.push((
            Code::FeedsOfFit,
            format!("{count} feeds show little of how straight the force grows; measure five"),
        ));
    }
    let [.., before, last] = feeds[..] else {
        return list;
    };
    let first = feeds[0];
    if last < RANGE * first {
        list.push((
            Code::FeedsOfFit,
            format!(
                "the feeds go from {} to {} mm only: the edge coefficients are where the lines meet no feed, far outside",
                given(first),
                given(last)
            ),
        ));
    }
    if count > 2 && last > FAR * before {
        list.push((
            Code::FeedsOfFit,
            format!(
                "the feed of {} mm is {} times the next one: it decides the slope alone",
                given(last),
                number(last / before, 2)
            ),
        ));
    }
    if last > LARGE * diameter_mm {
        list.push((
            Code::FeedsOfFit,
            format!(
                "a feed of {} mm per tooth is large for a tool of {} mm: is it the feed per turn?",
                given(last),
                given(diameter_mm)
            ),
        ));
    }
    list
}

/// Rows far beside the lines.
fn outliers(rows: &[FitRow]) -> Vec<String> {
    if rows.len() < OUTLIER.1 {
        return Vec::new();
    }
    let mut list = Vec::new();
    for (k, axis) in ["x", "y", "z"].into_iter().enumerate() {
        let squares: f64 = rows.iter().map(|row| row.residual_n[k].powi(2)).sum();
        let scatter = (squares / (rows.len() - 2) as f64).sqrt();
        let scale = rows.iter().map(|row| row.force_n[k].abs());
        let rounding = 1e-9 * scale.fold(0.0, larger);
        for row in rows {
            let residual = row.residual_n[k];
            if residual.abs() > OUTLIER.0 * scatter && residual.abs() > rounding {
                list.push(format!(
                    "the force along {axis} at {} mm per tooth lies {} N beside the line, {} times the scatter: look at that measurement",
                    given(row.feed_mm_per_tooth),
                    number(residual.abs(), 3),
                    number(residual.abs() / scatter, 2)
                ));
            }
        }
    }
    list
}

/// Scatter that is large beside the force itself.
fn poor(rows: &[FitRow]) -> Option<String> {
    let size = |v: [f64; 3]| v[0].hypot(v[1]).hypot(v[2]);
    let residuals: f64 = rows.iter().map(|row| size(row.residual_n).powi(2)).sum();
    let scatter = (residuals / rows.len() as f64).sqrt();
    let least = rows
        .iter()
        .map(|row| size(row.force_n))
        .fold(f64::INFINITY, smaller);
    (scatter > SCATTER * least).then(|| {
        format!(
            "the forces scatter by {} N about the lines, and the smallest is {} N: the linear law does not describe them well, or they were not measured in one cut",
            number(scatter, 2),
            number(least, 3)
        )
    })
}
