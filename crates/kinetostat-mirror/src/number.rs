//! Extremes and medians that do not lose a NaN.

/// Standard deviations, each of two directions, in the median length of a vector of both: `1 / sqrt(2 ln 2)` (Rayleigh).
pub(crate) const OF_TWO_DIRECTIONS: f64 = 0.849_321_800_288_019;

/// The larger of two numbers, NaN where one of them is.
pub(crate) fn larger(a: f64, b: f64) -> f64 {
    if b > a || b.is_nan() { b } else { a }
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
