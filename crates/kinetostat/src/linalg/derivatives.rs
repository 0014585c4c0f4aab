//! Numbers that spring laws are written for: single ones, several postures in one (the batch's lanes), and either
//! with its derivatives.
//!
//! A law is a formula on a [`Number`]. The general engine evaluates it at `f64`, the vectorised kernels at their
//! lanes, and both get derivatives by [`Forward`] over their own numbers (forward-mode differentiation: every
//! number carries its gradient). Each kind of number brings its own approximation of the few functions that laws
//! need; nothing else differs between engines.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// Operations of a law with numbers.
pub trait Number:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Mul<f64, Output = Self>
    + Neg<Output = Self>
{
    /// A constant of the same kind.
    fn same(self, value: f64) -> Self;
    /// `self * b + c`.
    fn times_plus(self, b: Self, c: Self) -> Self;
    /// `c - self * b`.
    fn times_from(self, b: Self, c: Self) -> Self;
    /// Sine and cosine of any angle, rad.
    fn sin_cos(self) -> (Self, Self);
    /// Sine and cosine of an angle by which a spring turns. Kernels know them to pi / 4.
    fn sin_cos_of_spring(self) -> (Self, Self);
    /// `asin(sqrt s) / sqrt s` for this `s`: half a turn's angle per its sine.
    fn angle_per_sine(self) -> Self;
    /// `c = (1 - sqrt(t)/2 cot(sqrt(t)/2)) / t` for this `t`, and `dc/dt`.
    fn logarithm_factor(self) -> [Self; 2];
    /// Clamps between `-most` and `most`.
    fn clamped(self, most: f64) -> Self;
    /// Below zero. Several postures in one never are: what asks for it turns by more than their springs do.
    fn is_negative(self) -> bool;
}

/// A number without derivatives that knows those of the functions of [`Number`].
pub trait Real: Number {
    /// [`Number::angle_per_sine`] and its derivative.
    fn angle_per_sine_and_rate(self) -> [Self; 2];
    /// [`Number::logarithm_factor`] and the second derivative.
    fn logarithm_factor_and_rates(self) -> [Self; 3];
    /// One where the size of this is less than `most`, zero elsewhere.
    fn is_within(self, most: f64) -> Self;
}

/// A number with its derivatives by `K` others.
#[derive(Clone, Copy, Debug)]
pub struct Forward<R, const K: usize> {
    /// The number.
    pub value: R,
    /// Derivatives.
    pub rate: [R; K],
}

impl<R: Real, const K: usize> Forward<R, K> {
    /// A number that depends on none of the others.
    #[inline(always)]
    pub fn constant(value: R) -> Self {
        Self {
            value,
            rate: [value.same(0.0); K],
        }
    }

    /// The `k`-th of the numbers that derivatives are taken by.
    #[inline(always)]
    pub fn variable(value: R, k: usize) -> Self {
        let mut own = Self::constant(value);
        own.rate[k] = value.same(1.0);
        own
    }

    /// All of them.
    #[inline(always)]
    pub fn variables(values: &[R; K]) -> [Self; K] {
        let mut out = [Self::constant(values[0]); K];
        for k in 0..K {
            out[k] = Self::variable(values[k], k);
        }
        out
    }

    /// A function of this number from its value and its derivative.
    #[inline(always)]
    fn map(mut self, value: R, derivative: R) -> Self {
        self.value = value;
        for k in 0..K {
            self.rate[k] = self.rate[k] * derivative;
        }
        self
    }
}

impl<R: Real, const K: usize> Add for Forward<R, K> {
    type Output = Self;
    #[inline(always)]
    fn add(mut self, other: Self) -> Self {
        self.value = self.value + other.value;
        for k in 0..K {
            self.rate[k] = self.rate[k] + other.rate[k];
        }
        self
    }
}

impl<R: Real, const K: usize> Sub for Forward<R, K> {
    type Output = Self;
    #[inline(always)]
    fn sub(mut self, other: Self) -> Self {
        self.value = self.value - other.value;
        for k in 0..K {
            self.rate[k] = self.rate[k] - other.rate[k];
        }
        self
    }
}

impl<R: Real, const K: usize> Mul for Forward<R, K> {
    type Output = Self;
    #[inline(always)]
    fn mul(mut self, other: Self) -> Self {
        for k in 0..K {
            let own = self.rate[k] * other.value;
            self.rate[k] = self.value.times_plus(other.rate[k], own);
        }
        self.value = self.value * other.value;
        self
    }
}

impl<R: Real, const K: usize> Div for Forward<R, K> {
    type Output = Self;
    #[inline(always)]
    fn div(mut self, other: Self) -> Self {
        let value = self.value / other.value;
        for k in 0..K {
            self.rate[k] = value.times_from(other.rate[k], self.rate[k]) / other.value;
        }
        self.value = value;
        self
    }
}

impl<R: Real, const K: usize> Mul<f64> for Forward<R, K> {
    type Output = Self;
    #[inline(always)]
    fn mul(mut self, factor: f64) -> Self {
        self.value = self.value * factor;
        for k in 0..K {
            self.rate[k] = self.rate[k] * factor;
        }
        self
    }
}

impl<R: Real, const K: usize> Neg for Forward<R, K> {
    type Output = Self;
    #[inline(always)]
    fn neg(mut self) -> Self {
        self.value = -self.value;
        for k in 0..K {
            self.rate[k] = -self.rate[k];
        }
        self
    }
}

impl<R: Real, const K: usize> Number for Forward<R, K> {
    #[inline(always)]
    fn same(self, value: f64) -> Self {
        Self::constant(self.value.same(value))
    }
    #[inline(always)]
    fn times_plus(self, b: Self, c: Self) -> Self {
        self * b + c
    }
    #[inline(always)]
    fn times_from(self, b: Self, c: Self) -> Self {
        c - self * b
    }
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let (s, c) = self.value.sin_cos();
        (self.map(s, c), self.map(c, -s))
    }
    #[inline(always)]
    fn sin_cos_of_spring(self) -> (Self, Self) {
        let (s, c) = self.value.sin_cos_of_spring();
        (self.map(s, c), self.map(c, -s))
    }
    #[inline(always)]
    fn angle_per_sine(self) -> Self {
        let [value, rate] = self.value.angle_per_sine_and_rate();
        self.map(value, rate)
    }
    #[inline(always)]
    fn logarithm_factor(self) -> [Self; 2] {
        let [value, first, second] = self.value.logarithm_factor_and_rates();
        [self.map(value, first), self.map(first, second)]
    }
    #[inline(always)]
    fn clamped(self, most: f64) -> Self {
        self.map(self.value.clamped(most), self.value.is_within(most))
    }
    #[inline(always)]
    fn is_negative(self) -> bool {
        self.value.is_negative()
    }
}

impl Number for f64 {
    #[inline(always)]
    fn same(self, value: f64) -> Self {
        value
    }
    // Rounded twice: a fused operation is a slow call where the processor is not known to have one.
    #[inline(always)]
    fn times_plus(self, b: Self, c: Self) -> Self {
        self * b + c
    }
    #[inline(always)]
    fn times_from(self, b: Self, c: Self) -> Self {
        c - self * b
    }
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        f64::sin_cos(self)
    }
    #[inline(always)]
    fn sin_cos_of_spring(self) -> (Self, Self) {
        f64::sin_cos(self)
    }
    fn angle_per_sine(self) -> Self {
        self.angle_per_sine_and_rate()[0]
    }
    fn logarithm_factor(self) -> [Self; 2] {
        let [value, rate, _] = self.logarithm_factor_and_rates();
        [value, rate]
    }
    #[inline(always)]
    fn clamped(self, most: f64) -> Self {
        self.clamp(-most, most)
    }
    #[inline(always)]
    fn is_negative(self) -> bool {
        self < 0.0
    }
}

impl Real for f64 {
    fn angle_per_sine_and_rate(self) -> [Self; 2] {
        let s = self;
        if s < 0.1 {
            let (mut sum, mut first) = (0.0, 0.0);
            for c in ASIN.iter() {
                first = first * s + sum;
                sum = sum * s + c;
            }
            return [sum, first];
        }
        // Half a turn has no unique logarithm; it is kept finite.
        let left = (1.0 - s).max(1e-12);
        let f = s.min(1.0).sqrt().asin() / s.sqrt();
        [f, (1.0 / left.sqrt() - f) / (2.0 * s)]
    }

    fn logarithm_factor_and_rates(self) -> [Self; 3] {
        let t = self;
        if t < 1.0 {
            let mut sum = [0.0; 3];
            for c in &LOGARITHM {
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

    #[inline(always)]
    fn is_within(self, most: f64) -> Self {
        f64::from(u8::from(self.abs() < most))
    }
}

/// `asin(s) / s` in powers of `s^2`, highest first: `(2k)! / (4^k k!^2 (2k + 1))`. Kernels, whose springs turn
/// little, begin at a later one.
pub(crate) const ASIN: [f64; 24] = {
    let mut out = [0.0; 24];
    let (mut factor, mut k) = (1.0, 0);
    while k < 24 {
        let twice = 2.0 * k as f64;
        out[23 - k] = factor / (twice + 1.0);
        factor *= (twice + 1.0) / (twice + 2.0);
        k += 1;
    }
    out
};

/// `(1 - t/2 cot(t/2)) / t^2` in powers of `t^2`, highest first: `|B_2k| / (2k)!`.
pub(crate) const LOGARITHM: [f64; 10] = [
    174_611.0 / 802_857_662_698_291_200_000.0,
    43_867.0 / 5_109_094_217_170_944_000.0,
    3_617.0 / 10_670_622_842_880_000.0,
    1.0 / 74_724_249_600.0,
    691.0 / 1_307_674_368_000.0,
    1.0 / 47_900_160.0,
    1.0 / 1_209_600.0,
    1.0 / 30_240.0,
    1.0 / 720.0,
    1.0 / 12.0,
];

/// `a . b`.
#[inline(always)]
pub(crate) fn inner<N: Number>(a: &[N; 3], b: &[N; 3]) -> N {
    a[0].times_plus(b[0], a[1].times_plus(b[1], a[2] * b[2]))
}

/// `a x b`.
#[inline(always)]
pub(crate) fn outer<N: Number>(a: &[N; 3], b: &[N; 3]) -> [N; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}
