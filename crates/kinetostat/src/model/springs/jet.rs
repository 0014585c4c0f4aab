//! Numbers that carry their gradient and second derivative by the six coordinates of a spring: exact
//! torques and tangents of energies in coordinates of rotation.

use std::ops::{Add, Mul, Sub};

use nalgebra::{Matrix6, Vector6};

use crate::model::springs::response::Response;

/// A number with its gradient and second derivative by the six coordinates.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Jet {
    pub value: f64,
    pub gradient: Vector6<f64>,
    curvature: Matrix6<f64>,
}

impl Jet {
    pub fn coordinate(value: f64, index: usize) -> Self {
        let mut gradient = Vector6::zeros();
        gradient[index] = 1.0;
        Self {
            value,
            gradient,
            curvature: Matrix6::zeros(),
        }
    }

    /// A function of this number, from its value, first and second derivative.
    pub fn map(&self, [f, first, second]: [f64; 3]) -> Self {
        Self {
            value: f,
            gradient: self.gradient * first,
            curvature: self.curvature * first + self.gradient * self.gradient.transpose() * second,
        }
    }

    pub fn scaled(&self, factor: f64) -> Self {
        self.map([factor * self.value, factor, 0.0])
    }
}

impl Add for Jet {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self {
            value: self.value + other.value,
            gradient: self.gradient + other.gradient,
            curvature: self.curvature + other.curvature,
        }
    }
}

impl Sub for Jet {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + other.scaled(-1.0)
    }
}

impl Mul for Jet {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let mixed = self.gradient * other.gradient.transpose();
        Self {
            value: self.value * other.value,
            gradient: self.gradient * other.value + other.gradient * self.value,
            curvature: self.curvature * other.value
                + other.curvature * self.value
                + mixed
                + mixed.transpose(),
        }
    }
}

pub(crate) fn cross(a: &[Jet; 3], b: &[Jet; 3]) -> [Jet; 3] {
    std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        a[j] * b[k] - a[k] * b[j]
    })
}

/// `asin(sqrt s) / sqrt s`, half a turn's angle per its sine, and two derivatives.
pub(crate) fn angle_per_sine(s: f64) -> [f64; 3] {
    if s < 0.1 {
        let (mut sum, mut coefficient) = ([0.0; 3], 1.0);
        for k in 0..24 {
            let n = f64::from(k);
            sum[0] += coefficient * s.powi(k);
            if k > 0 {
                sum[1] += coefficient * n * s.powi(k - 1);
            }
            if k > 1 {
                sum[2] += coefficient * n * (n - 1.0) * s.powi(k - 2);
            }
            coefficient *= (2.0 * n + 1.0).powi(2) / ((2.0 * n + 2.0) * (2.0 * n + 3.0));
        }
        return sum;
    }
    // Half a turn has no unique logarithm; it is kept finite.
    let left = (1.0 - s).max(1e-12);
    let f = s.min(1.0).sqrt().asin() / s.sqrt();
    let first = (1.0 / left.sqrt() - f) / (2.0 * s);
    [f, first, (0.5 / left.powf(1.5) - 3.0 * first) / (2.0 * s)]
}

/// `(1 - sqrt(t)/2 cot(sqrt(t)/2)) / t` and two derivatives: `sum |B_2k| / (2k)! t^(k-1)`.
pub(crate) fn logarithm_factor(t: f64) -> [f64; 3] {
    const SERIES: [f64; 10] = [
        1.0 / 12.0,
        1.0 / 720.0,
        1.0 / 30_240.0,
        1.0 / 1_209_600.0,
        1.0 / 47_900_160.0,
        691.0 / 1_307_674_368_000.0,
        1.0 / 74_724_249_600.0,
        3_617.0 / 10_670_622_842_880_000.0,
        43_867.0 / 5_109_094_217_170_944_000.0,
        174_611.0 / 802_857_662_698_291_200_000.0,
    ];
    if t < 1.0 {
        let mut sum = [0.0; 3];
        for c in SERIES.into_iter().rev() {
            sum[2] = sum[2] * t + 2.0 * sum[1];
            sum[1] = sum[1] * t + sum[0];
            sum[0] = sum[0] * t + c;
        }
        return sum;
    }
    let half = 0.5 * t.sqrt();
    let f = half / half.tan();
    let first = (f - 0.25 * t - f * f) / (2.0 * t);
    let second = (first - 0.25 - 2.0 * f * first) / (2.0 * t) - first / t;
    let c = (1.0 - f) / t;
    let c_first = (-first - c) / t;
    [c, c_first, (-second - 2.0 * c_first) / t]
}

pub(crate) fn square(v: &[Jet; 3]) -> Jet {
    v[0] * v[0] + v[1] * v[1] + v[2] * v[2]
}

/// `1/2 e^T K e` for strains `e` with derivatives.
pub(crate) fn quadratic(matrix: &Matrix6<f64>, strain: &[Jet; 6]) -> Response {
    let values = Vector6::from_fn(|i, _| strain[i].value);
    let force = matrix * values;
    let mut rates = Matrix6::zeros();
    let mut geometric = Matrix6::zeros();
    for i in 0..6 {
        rates.set_row(i, &strain[i].gradient.transpose());
        geometric += strain[i].curvature * force[i];
    }
    Response {
        energy: 0.5 * force.dot(&values),
        torque: rates.transpose() * force,
        material: rates.transpose() * matrix * rates,
        geometric,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn series_and_closed_forms_meet() {
        for (f, at, step) in [
            (angle_per_sine as fn(f64) -> [f64; 3], 0.1, 1e-9),
            (logarithm_factor, 1.0, 1e-9),
        ] {
            let (below, above) = (f(at - step), f(at + step));
            for k in 0..3 {
                let change = if k < 2 {
                    2.0 * step * f(at)[k + 1]
                } else {
                    0.0
                };
                assert!((above[k] - below[k] - change).abs() < 1e-7 * below[k].abs());
            }
        }
    }
}
