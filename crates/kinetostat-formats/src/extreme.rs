//! The larger and the smaller of two numbers, which do not forget NaN as `f64::max` does.

/// The larger of two; NaN where one of them is.
pub(crate) fn larger(one: f64, other: f64) -> f64 {
    match one > other || one.is_nan() {
        true => one,
        false => other,
    }
}

/// The smaller of two; NaN where one of them is.
pub(crate) fn smaller(one: f64, other: f64) -> f64 {
    match one < other || one.is_nan() {
        true => one,
        false => other,
    }
}
