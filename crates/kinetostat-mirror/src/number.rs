//! Extremes and medians that do not lose a NaN.

/// Standard deviations, each of two directions, in the median length of a vector of both: `1 / sqrt(2 ln 2)` (Rayleigh).
pub(crate) const OF_TWO_DIRECTIONS: f64 = 0.849_321_800_288_019;

/// Standard deviation over the length that three of four vectors keep below: `1 / sqrt(2 ln 4)` (Rayleigh).
pub(crate) const OF_THREE_QUARTERS: f64 = 0.600_561_204_393_225;

/// Standard deviation over the length that nine of ten keep below: `1 / sqrt(2 ln 10)`.
pub(crate) const OF_NINE_IN_TEN: f64 = 0.465_990_601_784_656_1;

/// The larger of two numbers, NaN where one of them is.
pub(crate) fn larger(a: f64, b: f64) -> f64 {
    if b > a || b.is_nan() { b } else { a }
}

/// The smaller of two numbers, NaN where one of them is.
pub(crate) fn smaller(a: f64, b: f64) -> f64 {
    if b < a || b.is_nan() { b } else { a }
}

/// The median; of an even number the mean of the two in the middle. NaN of nothing, and where one of them is.
pub(crate) fn median(mut values: Vec<f64>) -> f64 {
    if values.is_empty() || values.iter().any(|value| value.is_nan()) {
        return f64::NAN;
    }
    let middle = values.len() / 2;
    let even = values.len().is_multiple_of(2);
    let (below, upper, _) = values.select_nth_unstable_by(middle, f64::total_cmp);
    let upper = *upper;
    match even {
        true => 0.5 * (upper + below.iter().copied().fold(f64::NEG_INFINITY, larger)),
        false => upper,
    }
}

/// The value that this share of all keep below, one of them. NaN of nothing, and where one of them is.
pub(crate) fn quantile(mut values: Vec<f64>, share: f64) -> f64 {
    if values.is_empty() || values.iter().any(|value| value.is_nan()) {
        return f64::NAN;
    }
    let at = (values.len() as f64 * share) as usize;
    let at = at.min(values.len() - 1);
    *values.select_nth_unstable_by(at, f64::total_cmp).1
}
