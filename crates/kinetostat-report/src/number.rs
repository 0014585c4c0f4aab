//! How numbers look: sensible digits, thousands apart, "not available" where there is no number.

/// What stands where there is no number.
pub(crate) const MISSING: &str = "not available";

/// Narrow space that does not break, between thousands and before units.
const THIN: char = '\u{202f}';

/// From here on numbers are written with a power of ten.
const HUGE: f64 = 1e9;

/// Which way a figure is rounded: a largest value must not be stated too small.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Rounding {
    Nearest,
    Up,
    Down,
}

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

/// A count with its thousands apart.
pub(crate) fn count(value: usize) -> String {
    group(&value.to_string())
}

/// A number with a given number of decimals.
pub(crate) fn fixed(value: f64, decimals: usize) -> String {
    if !value.is_finite() {
        return MISSING.to_owned();
    }
    if value.abs() >= HUGE {
        return power_of_ten(value, 3);
    }
    let text = format!("{value:.decimals$}");
    let digits = text.trim_start_matches('-');
    // "-0.000" would be a sign without a number.
    let negative = text.starts_with('-') && digits.bytes().any(|b| (b'1'..=b'9').contains(&b));
    let (whole, fraction) = digits.split_once('.').unwrap_or((digits, ""));
    let mut out = String::new();
    if negative {
        out.push('\u{2212}');
    }
    out.push_str(&group(whole));
    if !fraction.is_empty() {
        out.push('.');
        out.push_str(fraction);
    }
    out
}

/// A number with a given number of significant digits; digits before the point are never cut.
pub(crate) fn significant(value: f64, digits: usize, rounding: Rounding) -> String {
    if !value.is_finite() {
        return MISSING.to_owned();
    }
    if value.abs() < NOTHING {
        return "0".to_owned();
    }
    let value = rounded(value, digits, rounding);
    let exponent = exponent(value, digits);
    if value.abs() >= HUGE || exponent < -6 {
        return power_of_ten(value, digits);
    }
    let decimals = usize::try_from(digits as i32 - 1 - exponent).unwrap_or(0);
    fixed(value, decimals)
}

/// A number as somebody set it: no digits that mean nothing.
pub(crate) fn setting(value: f64) -> String {
    let text = significant(value, 6, Rounding::Nearest);
    if text.contains('.') && !text.contains('×') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
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
    if largest_mm.abs() >= 0.01 || largest_mm == 0.0 || !largest_mm.is_finite() {
        ("mm", 1.0)
    } else {
        ("µm", 1000.0)
    }
}

/// A length in mm, or in µm where it is small.
pub(crate) fn length(value_mm: f64, digits: usize, rounding: Rounding) -> String {
    let (unit, factor) = length_unit(value_mm);
    let value = value_mm * factor;
    if value != 0.0 && value.abs() < 0.001 {
        // Rounded up, the smallest length that is stated is an upper bound without a word for it.
        let number = if rounding == Rounding::Up && value > 0.0 {
            "0.001"
        } else {
            "below 0.001"
        };
        return with_unit(number, unit);
    }
    with_unit(&significant(value, digits, rounding), unit)
}

/// A length that somebody set.
pub(crate) fn length_setting(value_mm: f64) -> String {
    let (unit, factor) = length_unit(value_mm);
    with_unit(&setting(value_mm * factor), unit)
}

/// A largest length for a sentence: always mm, two digits, never stated too small.
pub(crate) fn sentence_mm(value_mm: f64) -> String {
    if value_mm > 0.0 && value_mm < 1e-6 {
        return with_unit("0.000001", "mm");
    }
    with_unit(&significant(value_mm, 2, Rounding::Up), "mm")
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

fn exponent(value: f64, digits: usize) -> i32 {
    let text = format!("{:.*e}", digits.saturating_sub(1), value);
    text.split_once('e')
        .and_then(|(_, power)| power.parse().ok())
        .unwrap_or(0)
}

fn rounded(value: f64, digits: usize, rounding: Rounding) -> f64 {
    let place = digits as i32 - 1 - exponent(value, digits);
    let scale = 10f64.powi(place);
    let scaled = value * scale;
    if !scaled.is_finite() || scaled == 0.0 {
        return value;
    }
    // A value that is a round number up to the noise of arithmetic stays that round number.
    let scaled = match rounding {
        Rounding::Nearest => return value,
        Rounding::Up => (scaled - 1e-6).ceil(),
        Rounding::Down => (scaled + 1e-6).floor(),
    };
    let result = scaled / scale;
    if result.is_finite() { result } else { value }
}

fn power_of_ten(value: f64, digits: usize) -> String {
    let text = format!("{:.*e}", digits.saturating_sub(1), value);
    match text.split_once('e') {
        Some((mantissa, power)) => {
            let power: String = power.chars().map(superscript).collect();
            format!("{} × 10{power}", mantissa.replace('-', "\u{2212}"))
        }
        None => text,
    }
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
    fn digits_and_thousands() {
        assert_eq!(count(80532), "80\u{202f}532");
        assert_eq!(count(999), "999");
        assert_eq!(fixed(-0.0004, 3), "0.000");
        assert_eq!(fixed(-1234.5, 1), "\u{2212}1\u{202f}234.5");
        assert_eq!(significant(0.7583, 2, Rounding::Up), "0.76");
        assert_eq!(significant(1e-320, 2, Rounding::Up), "0");
        assert_eq!(significant(0.76, 2, Rounding::Up), "0.76");
        assert_eq!(significant(0.7583, 3, Rounding::Nearest), "0.758");
        assert_eq!(significant(9.996, 2, Rounding::Up), "10");
        assert_eq!(significant(1543.0, 2, Rounding::Down), "1\u{202f}500");
        assert_eq!(significant(12.5e12, 3, Rounding::Nearest), "1.25 × 10¹³");
        assert_eq!(setting(0.5), "0.5");
        assert_eq!(setting(1500.0), "1\u{202f}500");
    }

    #[test]
    fn lengths_choose_their_unit() {
        assert_eq!(length(0.000_62, 2, Rounding::Up), "0.62\u{202f}µm");
        assert_eq!(length(0.758, 2, Rounding::Up), "0.76\u{202f}mm");
        assert_eq!(length(f64::NAN, 2, Rounding::Up), MISSING);
        assert_eq!(length_setting(0.0005), "0.5\u{202f}µm");
        assert_eq!(sentence_mm(0.000_596), "0.00060\u{202f}mm");
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
