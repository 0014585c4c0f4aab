//! Numbers in type: the formatter's text with thousands apart, true minus signs and powers of ten.

use kinetostat_machining::number as plain;
pub(crate) use kinetostat_machining::number::{MISSING, Rounding};

/// Narrow space that does not break, between thousands and before units.
const THIN: char = '\u{202f}';

/// Smaller than anything that means something in mm, µm, N or deg.
const NOTHING: f64 = 1e-9;

/// The value if it can be drawn: finite and not absurdly large (differences must stay finite). What is
/// next to nothing is nothing: ticks would have more zeros than a reader.
pub(crate) fn drawable(value: f64) -> Option<f64> {
    (value.is_finite() && value.abs() < 1e12).then_some(if value.abs() < NOTHING {
        0.0
    } else {
        value
    })
}

/// Largest value of those that can be drawn.
pub(crate) fn largest(values: impl Iterator<Item = f64>) -> Option<f64> {
    values.filter_map(drawable).reduce(f64::max)
}

/// A number, or a number with its unit, as the formatter writes it: set in type.
pub(crate) fn typeset(text: &str) -> String {
    if text == MISSING {
        return text.to_owned();
    }
    if let Some((value, spread)) = text.split_once(" +- ") {
        return format!("{} ± {}", typeset(value), typeset(spread));
    }
    let (number, unit) = match text.strip_prefix("below ") {
        Some(rest) => return format!("below {}", typeset(rest)),
        None => text.split_once(' ').unwrap_or((text, "")),
    };
    if !number.ends_with(|c: char| c.is_ascii_digit()) {
        return text.to_owned();
    }
    let (number, power) = number.split_once('e').unwrap_or((number, ""));
    let digits = number.trim_start_matches('-');
    let (whole, fraction) = digits.split_once('.').unwrap_or((digits, ""));
    let mut out = String::new();
    if number.starts_with('-') {
        out.push('\u{2212}');
    }
    out.push_str(&group(whole));
    if !fraction.is_empty() {
        out.push('.');
        out.push_str(fraction);
    }
    if !power.is_empty() {
        out.push_str(" × 10");
        out.extend(power.chars().map(superscript));
    }
    match unit {
        "" => out,
        "um" => format!("{out}{THIN}µm"),
        unit => format!("{out}{THIN}{unit}"),
    }
}

/// A count with its thousands apart.
pub(crate) fn count(value: usize) -> String {
    group(&value.to_string())
}

/// Number of things, thousands apart.
pub(crate) fn counted(value: usize, one: &str) -> String {
    plain::counted(value, one).replacen(&value.to_string(), &count(value), 1)
}

/// A number with a given number of decimals.
pub(crate) fn fixed(value: f64, decimals: usize) -> String {
    match drawable(value) {
        Some(value) => typeset(&plain::fixed(value, decimals)),
        None if value.is_finite() => typeset(&plain::significant(value, 3, Rounding::Nearest)),
        None => MISSING.to_owned(),
    }
}

/// A number with a given number of significant digits; digits before the point are never cut.
pub(crate) fn significant(value: f64, digits: usize, rounding: Rounding) -> String {
    if !value.is_finite() {
        return MISSING.to_owned();
    }
    let value = if value.abs() < NOTHING { 0.0 } else { value };
    typeset(&plain::significant(value, digits, rounding))
}

/// A number as somebody set it: no digits that mean nothing.
pub(crate) fn setting(value: f64) -> String {
    typeset(&plain::setting(value))
}

/// A number with its unit, a narrow space between; no unit where there is no number.
pub(crate) fn with_unit(number: &str, unit: &str) -> String {
    if number == MISSING || unit.is_empty() {
        number.to_owned()
    } else {
        format!("{number}{THIN}{unit}")
    }
}

/// Unit for a length of this size and the factor from mm to it.
pub(crate) fn length_unit(largest_mm: f64) -> (&'static str, f64) {
    match plain::length_unit(largest_mm) {
        ("um", factor) => ("µm", factor),
        other => other,
    }
}

/// A length in mm, or in µm where it is small.
pub(crate) fn length(value_mm: f64, digits: usize, rounding: Rounding) -> String {
    if !value_mm.is_finite() {
        return MISSING.to_owned();
    }
    typeset(&plain::length(value_mm, digits, rounding))
}

/// A largest length beside the bound that it is compared with, see [`plain::against`].
pub(crate) fn against(value_mm: f64, bound_mm: f64) -> (String, String) {
    let (value, bound) = plain::against(value_mm, bound_mm);
    (typeset(&value), typeset(&bound))
}

/// A length that somebody set.
pub(crate) fn length_setting(value_mm: f64) -> String {
    if !value_mm.is_finite() {
        return MISSING.to_owned();
    }
    typeset(&plain::length_setting(value_mm))
}

/// Euclidean length of an error vector.
pub(crate) fn norm(vector: &[f64; 3]) -> f64 {
    vector[0].hypot(vector[1]).hypot(vector[2])
}

/// The largest of 1, 2, 5 times a power of ten that is not above the value (positive and finite).
pub(crate) fn round_number(value: f64) -> f64 {
    let power = 10f64.powf(value.log10().floor());
    let share = value / power;
    let step = if share >= 5.0 {
        5.0
    } else if share >= 2.0 {
        2.0
    } else {
        1.0
    };
    step * power
}

fn superscript(digit: char) -> char {
    match digit {
        '0' => '⁰',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        '4' => '⁴',
        '5' => '⁵',
        '6' => '⁶',
        '7' => '⁷',
        '8' => '⁸',
        '9' => '⁹',
        _ => '⁻',
    }
}

fn group(digits: &str) -> String {
    let mut out = String::with_capacity(digits.len() * 2);
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            out.push(THIN);
        }
        out.push(digit);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_is_set_in_type() {
        assert_eq!(count(80532), "80\u{202f}532");
        assert_eq!(count(999), "999");
        assert_eq!(fixed(-1234.5, 1), "\u{2212}1\u{202f}234.5");
        assert_eq!(typeset("-12.5e-9 mm"), "\u{2212}12.5 × 10⁻⁹\u{202f}mm");
        assert_eq!(typeset("0.539 um"), "0.539\u{202f}µm");
        assert_eq!(typeset("0.40 mm +- 0.07"), "0.40\u{202f}mm ± 0.07");
        assert_eq!(typeset("below 0.001 um"), "below 0.001\u{202f}µm");
        assert_eq!(typeset("1234.5 N m"), "1\u{202f}234.5\u{202f}N m");
        assert_eq!(significant(f64::INFINITY, 3, Rounding::Up), MISSING);
        assert_eq!(typeset("infinite"), "infinite");
    }

    #[test]
    fn nothing_upsets_the_formatting() {
        for value in [
            f64::NAN,
            f64::INFINITY,
            f64::MAX,
            f64::MIN_POSITIVE,
            -5e-324,
            0.0,
            -0.0,
        ] {
            for rounding in [Rounding::Nearest, Rounding::Up, Rounding::Down] {
                let text = significant(value, 3, rounding) + &length(value, 3, rounding);
                assert!(!text.contains("NaN") && !text.contains("inf"), "{text}");
                assert!(text.len() < 60, "{text}");
            }
        }
    }
}
