//! Sweep of an arc about a stated centre, and arcs for which it is ambiguous.
//!
//! A full circle ends where it begins. If its words are rounded apart, it ends slightly after its start, and reads as an arc of a
//! micrometre. Manuals say no more than that start and end are the same (Heidenhain, `C`; SINUMERIK, G2 with I and J), and controls
//! differ in what they take for the same: below 5e-7 rad (grbl), 1e-6 rad (LinuxCNC), a length of their machine data. An arc that
//! is not longer than the rounding of its words is therefore neither taken for a circle nor for an arc; the reader of G-code takes
//! it as LinuxCNC and grbl do where these two agree, and says so. The other side is clear: an arc that lacks a hair of the whole
//! turn is a full circle but for that hair.

use std::f64::consts::TAU;
use std::fmt;

use crate::number::{larger, smaller};

/// Ends nearer than this are one point: the words were equal, up to the arithmetic, in mm.
const SAME_POINT_MM: f64 = 1e-9;

/// Angle in rad below which some controllers take an arc for a full circle and some for nothing (5e-7 in grbl, 1e-6 in LinuxCNC;
/// neither asks whether the arc had an R).
const DISPUTED_ANGLE: f64 = 1e-6;

/// Distance of the ends of a full circle in last digits, if each was rounded or summed up from steps.
const ROUNDED_DIGITS: f64 = 3.0;

/// Radii at start and end that differ by more are no roundings (0.016 mm in Heidenhain's controls, 0.01 mm in SINUMERIK), in mm.
const MOST_DIFFERENCE_MM: f64 = 0.02;

/// Largest angle between the ends, rad, of a possible full circle: beyond it the digits are too coarse for the radius
/// to say anything.
const LARGEST_DOUBT: f64 = 0.1;

/// Finest digits that are looked for.
const MOST_DECIMALS: i32 = 9;

/// The ends of an arc are so near each other that a full circle is meant as well as the arc between them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NearlyClosed {
    /// Distance between end and start in the plane, in mm.
    pub apart_mm: f64,
    /// The short arc between its ends, in rad, as LinuxCNC and grbl take it; `None` if they disagree as well, about less than
    /// 1e-6 rad.
    pub short: Option<f64>,
}

impl NearlyClosed {
    /// Remedy for such an arc.
    pub const REMEDY: &str =
        "end the circle exactly where it starts, or write a straight move instead of the arc";
}

impl fmt::Display for NearlyClosed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "the arc's ends are only {:.7} mm apart: controllers disagree whether this is a full circle",
            self.apart_mm
        )
    }
}

/// The angle by which an arc turns about its centre, in rad, above 0 and at most a full turn, which it is where its ends are one
/// point.
///
/// `from` and `to` lead from the centre to its ends, in mm, in a right-handed plane; `sense` is 1 for counter-clockwise (G3, DR+)
/// and -1 for clockwise. `digit_mm` is the last digit of its words, see [`last_digit_mm`]; 0 where something else than its ends
/// says whether it is a short arc or nearly the whole circle (the sign of a radius).
///
/// ```
/// use kinetostat_program::{angle_about, last_digit_mm};
///
/// // From (20, 0) about (0, 0) with three decimals.
/// let to = |x: f64, y: f64| angle_about([20.0, 0.0], [x, y], 1.0, last_digit_mm(&[x, y], 1.0));
/// assert_eq!(to(20.0, 0.0), Ok(std::f64::consts::TAU));
/// assert!((to(0.0, 20.0).unwrap() - 90_f64.to_radians()).abs() < 1e-12);
/// // A micrometre behind the start, or beside it: a full circle whose end was rounded, or not.
/// assert!(to(20.0, 0.001).is_err() && to(20.003, 0.0).is_err());
/// // With more digits a few micrometres are an arc.
/// assert!(to(20.0, 0.003_000_1).unwrap() < 2e-4);
/// ```
///
/// # Errors
/// Where that depends on the control.
pub fn angle_about(
    from: [f64; 2],
    to: [f64; 2],
    sense: f64,
    digit_mm: f64,
) -> Result<f64, NearlyClosed> {
    let apart_mm = (to[0] - from[0]).hypot(to[1] - from[1]);
    if apart_mm < SAME_POINT_MM {
        return Ok(TAU);
    }
    let across = from[0] * to[1] - from[1] * to[0];
    let along = from[0] * to[0] + from[1] * to[1];
    let angle = sense * across.atan2(along);
    let (first, last) = (from[0].hypot(from[1]), to[0].hypot(to[1]));
    let doubt_mm = match digit_mm > 0.0 {
        true => ROUNDED_DIGITS * digit_mm + smaller((first - last).abs(), MOST_DIFFERENCE_MM),
        false => 0.0,
    };
    let is_short = (0.0..LARGEST_DOUBT).contains(&angle) && angle * larger(first, last) <= doubt_mm;
    if is_short || angle.abs() <= DISPUTED_ANGLE {
        return Err(NearlyClosed {
            apart_mm,
            short: Some(angle).filter(|angle| *angle > DISPUTED_ANGLE),
        });
    }
    Ok(match angle > 0.0 {
        true => angle,
        false => angle + TAU,
    })
}

/// The last digit of a block's words, in mm, for a unit of so many mm: that of the word with most decimals, and no coarser than
/// what programs are usually written in (0.001 mm, 0.0001 inch), for zeros at the end may be left out.
///
/// ```
/// use kinetostat_program::last_digit_mm;
///
/// assert_eq!(last_digit_mm(&[20.0, 0.0], 1.0), 0.001);
/// assert_eq!(last_digit_mm(&[19.9999, 0.0], 1.0), 0.0001);
/// assert!((last_digit_mm(&[1.0], 25.4) - 0.00254).abs() < 1e-12);
/// ```
#[must_use]
pub fn last_digit_mm(words: &[f64], mm_per_unit: f64) -> f64 {
    let usual = match mm_per_unit > 1.0 {
        true => 4,
        false => 3,
    };
    let decimals = words.iter().map(|word| decimals(*word)).max();
    mm_per_unit / 10_f64.powi(decimals.unwrap_or(0).max(usual))
}

fn decimals(value: f64) -> i32 {
    let mut found = 0..MOST_DECIMALS;
    let is_whole = |decimals: &i32| {
        let scaled = value * 10_f64.powi(*decimals);
        (scaled - scaled.round()).abs() <= 4.0 * f64::EPSILON * scaled.abs()
    };
    found.find(is_whole).unwrap_or(MOST_DECIMALS)
}
