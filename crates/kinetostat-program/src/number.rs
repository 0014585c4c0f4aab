//! Numbers as controllers read them, and irregular ones.

/// `value` with exactly `decimals` digits after the point, never an exponent, never `-0`.
pub fn fixed(value: f64, decimals: usize) -> String {
    if let Some(text) = of_units(value, decimals) {
        return text;
    }
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(digits) if digits.bytes().all(|byte| matches!(byte, b'0' | b'.')) => digits.to_owned(),
        _ => text,
    }
}

/// Rounds to whole units of the last digit, if their number is far enough from a half to be rounded to the right side: the
/// product is off by no more than 1e-7 units.
fn of_units(value: f64, decimals: usize) -> Option<String> {
    const MOST: f64 = 1e9;
    const NEAREST_TO_HALF: f64 = 1e-6;
    if decimals > 9 {
        return None;
    }
    let units = value.abs() * 10_f64.powi(decimals as i32);
    let whole = units.round();
    // Also where it is no number.
    let is_clear = units < MOST && (units - whole).abs() < 0.5 - NEAREST_TO_HALF;
    if !is_clear {
        return None;
    }
    let mut text = String::with_capacity(16);
    if value < 0.0 && whole > 0.0 {
        text.push('-');
    }
    let digits = (whole as u64).to_string();
    let (before, zeros) = match digits.len().checked_sub(decimals) {
        Some(0) | None => ("0", decimals - digits.len()),
        Some(before) => (&digits[..before], 0),
    };
    text.push_str(before);
    if decimals > 0 {
        text.push('.');
        text.extend(std::iter::repeat_n('0', zeros));
        text.push_str(&digits[digits.len().saturating_sub(decimals)..]);
    }
    Some(text)
}

/// A largest value with three digits, as results show it, never stated too small; what is a round number but for its
/// last binary digits stays it.
pub fn at_most(value: f64) -> String {
    let decimals = (2.0 - value.abs().log10().floor()).clamp(0.0, 12.0) as usize;
    let unit = 10_f64.powi(decimals as i32);
    fixed((value * unit * (1.0 - 1e-9)).ceil() / unit, decimals)
}

/// A positive feed with a relative rounding error of at most 0.01 %.
pub fn feed(value: f64) -> String {
    // Half a unit of the last decimal against 1e-4 of the value.
    let decimals = (-(2e-4 * value).log10()).ceil().clamp(0.0, 12.0) as usize;
    let text = fixed(value, decimals);
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}

/// The value that a controller reads in one of our own fixed-point numbers.
pub(crate) fn of_own_text(text: &str) -> f64 {
    text.parse().unwrap_or(0.0)
}

/// A number with so many digits after the point.
pub(crate) fn rounded(value: f64, decimals: usize) -> f64 {
    let unit = 10_f64.powi(decimals as i32);
    (value * unit).round() / unit
}

/// Digits after the point in a number as it was written.
pub(crate) fn decimals_of(text: &[u8]) -> usize {
    text.iter()
        .position(|byte| *byte == b'.')
        .map_or(0, |point| text.len() - point - 1)
}

/// The larger of two numbers, NaN where one of them is: `f64::max` forgets it, and what is checked would look right.
pub(crate) fn larger(a: f64, b: f64) -> f64 {
    if b > a || b.is_nan() { b } else { a }
}

/// The smaller of two numbers, NaN where one of them is.
pub(crate) fn smaller(a: f64, b: f64) -> f64 {
    if b < a || b.is_nan() { b } else { a }
}

/// A number as a controller reads it, with all its digits; what is left of zero after the arithmetic is zero.
pub(crate) fn number(value: f64) -> String {
    match value.abs() < NOTHING {
        true => "0".to_owned(),
        false => format!("{value}"),
    }
}

/// Smallest size that a program means.
const NOTHING: f64 = 1e-12;

/// The `k`th irregular number for something numbered `index`, between 0 and 1 (both excluded).
///
/// It depends on the two numbers and the `seed` and on nothing else. The mixing is that of `SplitMix64`
/// (Steele, Lea, Flood: Fast splittable pseudorandom number generators, 2014).
///
/// Such places follow no pattern and are the same in every run: a check that looks where a division looked sees no more than the
/// division did.
pub fn irregular(seed: u64, index: u64, k: u64) -> f64 {
    let mut state = seed;
    for number in [index, k] {
        state = mixed(
            state
                .wrapping_add(0x9e37_79b9_7f4a_7c15)
                .wrapping_add(number),
        );
    }
    // 52 bits and a half: never 0, never 1.
    ((state >> 12) as f64 + 0.5) / (1_u64 << 52) as f64
}

fn mixed(mut state: u64) -> u64 {
    state = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    state = (state ^ (state >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    state ^ (state >> 31)
}
