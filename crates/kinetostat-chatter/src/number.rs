//! Extremes that do not lose a NaN on their way, and complex numbers.

/// A complex number of double precision.
pub(crate) type Complex64 = nalgebra::Complex<f64>;

/// The larger of two numbers, NaN where one of them is: `f64::max` forgets it.
#[inline]
pub(crate) fn larger(a: f64, b: f64) -> f64 {
    if b > a || b.is_nan() { b } else { a }
}

/// The smaller of two numbers, NaN where one of them is: `f64::min` forgets it.
#[inline]
pub(crate) fn smaller(a: f64, b: f64) -> f64 {
    if b < a || b.is_nan() { b } else { a }
}

/// `e^(i angle)`.
#[inline]
pub(crate) fn cis(angle: f64) -> Complex64 {
    Complex64::new(angle.cos(), angle.sin())
}

/// The number turns back to an interval of one turn: `angle - 2 pi k` within 0 (included) and 2 pi.
pub(crate) fn wrapped(angle: f64, turn: f64) -> f64 {
    let rest = angle.rem_euclid(turn);
    if rest >= turn { 0.0 } else { rest }
}
