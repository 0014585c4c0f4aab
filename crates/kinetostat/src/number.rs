//! Formats of numbers in text: one formatter for messages, for the terminal and for the report, so that a figure has
//! the same digits everywhere.
//!
//! Text is plain ASCII with a point, `um` for micrometres and engineering notation (`12.5e6`, powers in
//! steps of three) outside 1e-5 to 1e7. The report sets the same text in type (`µm`, thousands apart,
//! powers of ten).
//!
//! Small values follow one rule. Below 1e-12 a value is the rounding of its arithmetic: it is stated as 0.
//! Lengths, angles and shares have a smallest figure (0.001 um, 0.0001 deg, 0.0001 %): a largest value
//! below it is stated as that figure, which is an upper bound; a mean or a least value is "below" it.
//!
//! The extremes of measured numbers are here, too, because they must not lose a NaN.

use std::borrow::Borrow;

/// Word for a number that is infinite.
pub const INFINITE: &str = "infinite";

/// Text in place of a missing number.
pub const MISSING: &str = "not available";

/// Digits of a figure: enough for what a model knows.
pub const DIGITS: usize = 3;

/// Direction of rounding: a largest value must not be stated too small.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rounding {
    /// To the nearest: means, settings, coordinates.
    Nearest,
    /// Away from zero: largest values, which must not look smaller than they are.
    Up,
    /// Towards zero: least values, which must not look larger than they are.
    Down,
}

/// A number with a number of significant digits; digits before the point are never cut. Zeros after the
/// point are kept: they are digits.
#[must_use]
pub fn significant(value: f64, digits: usize, rounding: Rounding) -> String {
    if let Some(word) = no_number(value) {
        return word.to_owned();
    }
    if value == 0.0 {
        return "0".to_owned();
    }
    let digits = digits.max(1);
    let value = rounded(value, digits, rounding);
    let exponent = exponent(value, digits);
    if (-5..7).contains(&exponent) {
        let decimals = usize::try_from(digits as i32 - 1 - exponent).unwrap_or(0);
        return format!("{value:.decimals$}");
    }
    engineering(value, digits)
}

/// The powers in steps of three.
fn engineering(value: f64, digits: usize) -> String {
    let text = format!("{:.*e}", digits - 1, value);
    let Some((mantissa, power)) = text.split_once('e') else {
        return text;
    };
    let power: i32 = power.parse().unwrap_or(0);
    let shift = power.rem_euclid(3) as usize;
    let (sign, mantissa) = match mantissa.strip_prefix('-') {
        Some(rest) => ("-", rest),
        None => ("", mantissa),
    };
    let mut figures: String = mantissa.chars().filter(char::is_ascii_digit).collect();
    while figures.len() < shift + 1 {
        figures.push('0');
    }
    let (whole, rest) = figures.split_at(shift + 1);
    let point = if rest.is_empty() { "" } else { "." };
    format!("{sign}{whole}{point}{rest}e{}", power - shift as i32)
}

/// A number with fixed decimals, as components of a vector are shown beside each other: never `-0.000`.
#[must_use]
pub fn fixed(value: f64, decimals: usize) -> String {
    if let Some(word) = no_number(value) {
        return word.to_owned();
    }
    if value.abs() >= 1e9 {
        return engineering(value, 4);
    }
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(rest) if rest.bytes().all(|b| matches!(b, b'0' | b'.')) => rest.to_owned(),
        _ => text,
    }
}

/// Formats like [`fixed`], without zeros at the end: for the cells of long tables.
///
/// ```
/// use kinetostat::number::fixed_and_short;
/// assert_eq!([-0.124_806_5, 100.0, -1e-9].map(|x| fixed_and_short(x, 6)), ["-0.124807", "100", "0"]);
/// ```
#[must_use]
pub fn fixed_and_short(value: f64, decimals: usize) -> String {
    let exactly = || without_zeros(&fixed(value, decimals)).to_owned();
    in_whole_numbers(value, decimals).unwrap_or_else(exactly)
}

/// Powers of ten by which a number is made a whole one.
const POWERS: [u32; 8] = [1, 10, 100, 1_000, 10_000, 100_000, 1_000_000, 10_000_000];

/// [`fixed_and_short`] by arithmetic of whole numbers. `None` where the product in floating point may not tell which way it is
/// rounded: near to halfway between two whole numbers, and beyond twelve digits.
fn in_whole_numbers(value: f64, decimals: usize) -> Option<String> {
    let power = *POWERS.get(decimals)?;
    let scaled = value.abs() * f64::from(power);
    // The product is off by less than 1e-4 here.
    let (whole, rest) = (scaled.floor(), scaled.fract());
    let is_small = scaled < 1e12 && value.abs() < 1e9;
    if !is_small || (rest - 0.5).abs() < 1e-3 {
        return None;
    }
    let number = whole as u64 + u64::from(rest > 0.5);
    let power = u64::from(power);
    let (units, mut rest) = (number / power, number % power);
    let sign = if value < 0.0 && number > 0 { "-" } else { "" };
    if rest == 0 {
        return Some(format!("{sign}{units}"));
    }
    let mut width = decimals;
    while rest.is_multiple_of(10) {
        (rest, width) = (rest / 10, width - 1);
    }
    Some(format!("{sign}{units}.{rest:0width$}"))
}

/// A number as somebody set it: no digits that mean nothing.
#[must_use]
pub fn setting(value: f64) -> String {
    trimmed(value, 6)
}

/// A number in a message: three digits, to the nearest.
#[must_use]
pub fn short(value: f64) -> String {
    trimmed(value, DIGITS)
}

/// A number to the nearest, without zeros at its end.
#[must_use]
pub fn trimmed(value: f64, digits: usize) -> String {
    without_zeros(&significant(value, digits, Rounding::Nearest)).to_owned()
}

/// The text of a number without zeros at the end of its decimals. What has none, or has a power of ten
/// behind them, stays as it is: zeros of `1e30` are the number's size.
#[must_use]
pub fn without_zeros(text: &str) -> &str {
    match text.contains('.') && !text.contains('e') {
        true => text.trim_end_matches('0').trim_end_matches('.'),
        false => text,
    }
}

/// Number with its noun: "1 point", "3 points".
///
/// ```
/// use kinetostat::number::counted;
/// assert_eq!([0, 1, 2].map(|n| counted(n, "point")), ["0 points", "1 point", "2 points"]);
/// ```
#[must_use]
pub fn counted(count: usize, one: &str) -> String {
    match count {
        1 => format!("1 {one}"),
        _ => format!("{count} {one}s"),
    }
}

/// A number and its unit; no unit where there is no number.
#[must_use]
pub fn with_unit(number: &str, unit: &str) -> String {
    if unit.is_empty() || number == MISSING || number.ends_with(INFINITE) {
        number.to_owned()
    } else {
        format!("{number} {unit}")
    }
}

/// Unit for a length of this size and the factor from mm to it.
#[must_use]
pub fn length_unit(largest_mm: f64) -> (&'static str, f64) {
    if largest_mm.abs() >= 0.01 || largest_mm == 0.0 || !largest_mm.is_finite() {
        ("mm", 1.0)
    } else {
        ("um", 1000.0)
    }
}

/// A length with its unit, in micrometres where it is small.
#[must_use]
pub fn length(value_mm: f64, digits: usize, rounding: Rounding) -> String {
    if value_mm.abs() < NOTHING {
        return with_unit("0", "mm");
    }
    let (unit, factor) = length_unit(value_mm);
    with_unit(&above(value_mm * factor, 0.001, digits, rounding), unit)
}

/// A length that somebody set.
#[must_use]
pub fn length_setting(value_mm: f64) -> String {
    let (unit, factor) = length_unit(value_mm);
    with_unit(&setting(value_mm * factor), unit)
}

/// The largest of lengths, never stated too small.
#[must_use]
pub fn largest_length(value_mm: f64) -> String {
    length(value_mm, DIGITS, Rounding::Up)
}

/// The least of lengths, never stated too large.
#[must_use]
pub fn least_length(value_mm: f64) -> String {
    length(value_mm, DIGITS, Rounding::Down)
}

/// A mean of lengths in mm, rounded to the nearest.
#[must_use]
pub fn mean_length(value_mm: f64) -> String {
    length(value_mm, DIGITS, Rounding::Nearest)
}

/// Below this a force, a motion or a share is the rounding of its arithmetic.
const NOTHING: f64 = 1e-12;

/// A number that has a smallest figure, by the rule of small values; zero: it has none.
fn above(value: f64, smallest: f64, digits: usize, rounding: Rounding) -> String {
    if value.abs() < NOTHING {
        return "0".to_owned();
    }
    if value.abs() >= smallest || value.is_nan() {
        return significant(value, digits, rounding);
    }
    match rounding {
        Rounding::Up if value > 0.0 => setting(smallest),
        // Upper bound of a value a little below zero.
        Rounding::Up => "0".to_owned(),
        _ => format!("below {}", setting(smallest)),
    }
}

/// The largest of values, never stated too small.
#[must_use]
pub fn largest(value: f64, unit: &str) -> String {
    with_unit(&above(value, 0.0, DIGITS, Rounding::Up), unit)
}

/// The least of values, never stated too large.
#[must_use]
pub fn least(value: f64, unit: &str) -> String {
    with_unit(&above(value, 0.0, DIGITS, Rounding::Down), unit)
}

/// An angle in degrees.
#[must_use]
pub fn angle(value_deg: f64, digits: usize, rounding: Rounding) -> String {
    with_unit(&above(value_deg, 1e-4, digits, rounding), "deg")
}

/// The largest of angles in degrees, never stated too small.
#[must_use]
pub fn largest_angle(value_deg: f64) -> String {
    angle(value_deg, DIGITS, Rounding::Up)
}

/// Distance of one pose from another; a part that is the rounding of the search for it is zero.
#[must_use]
pub fn apart(distance_mm: f64, angle_deg: f64) -> String {
    /// Searches end at about this share of what they began with (mm and deg).
    const LEFT: f64 = 1e-9;
    let clean = |value: f64| if value.abs() < LEFT { 0.0 } else { value };
    format!(
        "{} and {}",
        mean_length(clean(distance_mm)),
        angle(clean(angle_deg), DIGITS, Rounding::Nearest)
    )
}

/// The largest of shares of the way to buckling (1 is there), in percent, never stated too small. A
/// load that stretches what could buckle has a share below zero.
#[must_use]
pub fn share(value: f64) -> String {
    let percent = 100.0 * value;
    // Away from zero is upwards only above it.
    let number = match percent <= -1e-4 {
        true => significant(percent, DIGITS, Rounding::Down),
        false => above(percent, 1e-4, DIGITS, Rounding::Up),
    };
    with_unit(&number, "%")
}

/// A largest length beside the bound that it is compared with, with as many digits as show on which side
/// it lies: a bound that is missed never looks met, and one that is met never looks missed.
#[must_use]
pub fn against(value_mm: f64, bound_mm: f64) -> (String, String) {
    let parsed = |text: &str| -> Option<f64> {
        let (number, unit) = text.split_once(' ')?;
        let factor = if unit == "um" { 1e-3 } else { 1.0 };
        Some(factor * number.parse::<f64>().ok()?)
    };
    for digits in DIGITS..=9 {
        let value = length(value_mm, digits, Rounding::Up);
        let bound = length(bound_mm, digits, Rounding::Nearest);
        let shown = parsed(&value).zip(parsed(&bound));
        let distinct = match shown {
            Some((value, bound)) => (value > bound) == (value_mm > bound_mm),
            None => true,
        };
        if distinct {
            // The bound is a setting: zeros at its end say nothing.
            let (number, unit) = bound.split_once(' ').unwrap_or((&bound, ""));
            return (value, with_unit(without_zeros(number), unit));
        }
    }
    // Both are equally long beyond nine digits.
    let digits = 9;
    (
        length(value_mm, digits, Rounding::Nearest),
        length(bound_mm, digits, Rounding::Nearest),
    )
}

/// A number and its spread, with as many decimals as two digits of the spread have.
///
/// ```
/// use kinetostat::number::plus_minus;
///
/// assert_eq!(plus_minus(0.403, 0.0712), "0.403 +- 0.071");
/// assert_eq!(plus_minus(1234.0, 71.2), "1234 +- 71");
/// ```
#[must_use]
pub fn plus_minus(value: f64, spread: f64) -> String {
    if !(spread > 0.0 && spread.is_finite() && spread < 1e6) {
        return format!("{} +- {}", short(value), short(spread));
    }
    let decimals = (1.0 - spread.log10().floor()).clamp(0.0, 9.0) as usize;
    format!("{} +- {}", fixed(value, decimals), fixed(spread, decimals))
}

/// A length and its spread in the unit that fits the length.
///
/// ```
/// assert_eq!(kinetostat::number::length_plus_minus(0.403, 0.0712), "0.403 mm +- 0.071");
/// assert_eq!(kinetostat::number::length_plus_minus(0.004, 0.0001), "4.00 um +- 0.10");
/// ```
#[must_use]
pub fn length_plus_minus(value_mm: f64, spread_mm: f64) -> String {
    let (unit, factor) = length_unit(value_mm);
    let text = plus_minus(value_mm * factor, spread_mm * factor);
    match text.split_once(' ') {
        Some((value, rest)) => format!("{value} {unit} {rest}"),
        None => text,
    }
}

/// The larger of two numbers, NaN where one of them is: `f64::max` forgets it, and a maximum of residuals that
/// are not numbers would look small.
#[inline]
#[must_use]
pub fn larger(a: f64, b: f64) -> f64 {
    if b > a || b.is_nan() { b } else { a }
}

/// The smaller of two numbers, NaN where one of them is.
#[inline]
#[must_use]
pub fn smaller(a: f64, b: f64) -> f64 {
    if b < a || b.is_nan() { b } else { a }
}

/// The largest size of some numbers, 0 for none, NaN where one of them is.
#[inline]
#[must_use]
pub fn largest_size<N: Borrow<f64>>(numbers: impl IntoIterator<Item = N>) -> f64 {
    let sizes = numbers.into_iter().map(|x| x.borrow().abs());
    sizes.fold(0.0, larger)
}

fn no_number(value: f64) -> Option<&'static str> {
    if value.is_nan() {
        Some(MISSING)
    } else if value == f64::INFINITY {
        Some(INFINITE)
    } else if value == f64::NEG_INFINITY {
        Some("-infinite")
    } else {
        None
    }
}

fn exponent(value: f64, digits: usize) -> i32 {
    let text = format!("{:.*e}", digits.saturating_sub(1), value);
    text.split_once('e')
        .and_then(|(_, power)| power.parse().ok())
        .unwrap_or(0)
}

fn rounded(value: f64, digits: usize, rounding: Rounding) -> f64 {
    if rounding == Rounding::Nearest {
        return value;
    }
    let place = digits as i32 - 1 - exponent(value, digits);
    // Powers of ten are exact up to 22; dividing by one is more exact than multiplying by 0.1, 0.01...
    let scale = 10f64.powi(place.abs());
    let scaled = if place >= 0 {
        value * scale
    } else {
        value / scale
    };
    if !scaled.is_finite() || scaled == 0.0 || !scale.is_finite() {
        return value;
    }
    // A value that is a round number up to the noise of arithmetic stays that round number: a small length is the
    // difference of places in a machine, with a few of their last binary digits.
    let noise = 1e-9 * scaled.abs().max(1.0);
    let size = match rounding {
        Rounding::Down => (scaled.abs() + noise).floor(),
        _ => (scaled.abs() - noise).ceil(),
    };
    let size = size.copysign(scaled);
    let result = if place >= 0 {
        size / scale
    } else {
        size * scale
    };
    if result.is_finite() { result } else { value }
}
