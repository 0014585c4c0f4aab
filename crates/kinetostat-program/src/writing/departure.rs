//! Distance of a correction from its chord, between the places where it was requested.
//!
//! A stretch between two breaks of the field is followed by the polynomial of fourth degree through five values,
//! `t = 0, 1/4, 1/2, 3/4, 1`. The departure of that polynomial is bounded without a gap: it is evaluated on a grid,
//! and between two points of the grid a curve leaves its chord by no more than `h^2/8` times its largest second
//! derivative.
//!
//! The error of that polynomial is estimated by [`remainder`].

use nalgebra::Vector6;

use crate::number::larger;

/// Values of a correction on a stretch, at its ends and quarters.
pub type Values = [Vector6<f64>; 5];

/// Steps of the grid in one quarter of the stretch.
const STEPS: usize = 4;

/// The polynomial through five values at a part of the stretch.
pub fn polynomial(values: &Values, part: f64) -> Vector6<f64> {
    newton(&differences(values), 4.0 * part)
}

/// Newton's forward differences: the first value, and the first of each order.
fn differences(values: &Values) -> Values {
    let mut row = *values;
    let mut first = row;
    for order in 1..5 {
        for i in 0..5 - order {
            row[i] = row[i + 1] - row[i];
        }
        first[order] = row[0];
    }
    first
}

/// Newton's polynomial with these differences, `x` from 0 to 4.
fn newton(differences: &Values, x: f64) -> Vector6<f64> {
    let mut sum = differences[0];
    let mut factor = 1.0;
    for (order, difference) in differences.iter().enumerate().skip(1) {
        factor *= (x - (order - 1) as f64) / order as f64;
        sum += difference * factor;
    }
    sum
}

/// Values at the quarters of the parabola through ends and middle.
pub fn parabola(first: Vector6<f64>, middle: Vector6<f64>, last: Vector6<f64>) -> Values {
    let bulge = middle - first.lerp(&last, 0.5);
    let quarter = |part: f64| first.lerp(&last, part) + bulge * (4.0 * part * (1.0 - part));
    [first, quarter(0.25), middle, quarter(0.75), last]
}

/// Upper bound of the distance between the polynomial through the values and the straight line from
/// `chord[0]` to `chord[1]`, at equal parts.
pub fn departure(values: &Values, chord: [Vector6<f64>; 2]) -> f64 {
    let mut off = *values;
    for (i, value) in off.iter_mut().enumerate() {
        *value -= chord[0].lerp(&chord[1], 0.25 * i as f64);
    }
    let difference = |from: usize| off[from] - off[from + 1] * 2.0 + off[from + 2];
    let second = [difference(0), difference(1), difference(2)];
    let third = [second[1] - second[0], second[2] - second[1]];
    let fourth = third[1] - third[0];
    // P'' = D2 + D3 (x - 1) + D4 (6 x^2 - 18 x + 11) / 12, x from 0 to 4.
    let bend = second[0].norm() + 3.0 * third[0].norm() + 35.0 / 12.0 * fourth.norm();
    let step = 1.0 / STEPS as f64;
    let between = bend * step * step / 8.0;
    let grid = 4 * STEPS;
    let differences = differences(&off);
    let on_grid = (0..=grid)
        .map(|i| newton(&differences, 4.0 * (i as f64 / grid as f64)).norm())
        .fold(0.0, larger);
    on_grid + between
}

/// Upper bound of what the polynomial through two, three or five evenly spaced values may be off from a
/// correction that can be continued analytically `radius` farther to every side (also into the complex
/// plane) and is there at most twice as large as `size`.
///
/// By Hermite's formula on a contour at that distance, `|f - P| <= max|f| (1 + l / (pi r)) max|w| / r^n`,
/// `w` the product of the distances to the `n` places.
pub fn remainder(points: u8, size: f64, length: f64, radius: f64) -> f64 {
    let ratio = length / radius;
    let largest = 2.0 * size * (1.0 + ratio / std::f64::consts::PI);
    match points {
        // (l/2)^2
        2 => largest * 0.25 * ratio.powi(2),
        // (l/2)^3 times 2 / sqrt(27)
        3 => largest * 0.0482 * ratio.powi(3),
        // (l/4)^5 times 3.632
        _ => largest * 0.003_55 * ratio.powi(5),
    }
}
