//! Numbers that carry derivatives: a law is written once for both.

use std::ops::{Add, Mul, Neg, Sub};

use pulp::Simd;

use super::lanes::Lanes;

/// What a law does with numbers.
pub(super) trait Number:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Mul<f64, Output = Self>
    + Neg<Output = Self>
{
    /// `self * b + c`.
    fn times_plus(self, b: Self, c: Self) -> Self;
    /// Sine and cosine of |x| <= pi / 4.
    fn sin_cos_near_zero(self) -> (Self, Self);
    /// Value of a polynomial, highest coefficient first.
    fn polynomial<const N: usize>(self, coefficients: &[f64; N]) -> Self;
}

impl<S: Simd> Number for Lanes<S> {
    #[inline(always)]
    fn times_plus(self, b: Self, c: Self) -> Self {
        Lanes::times_plus(self, b, c)
    }
    #[inline(always)]
    fn sin_cos_near_zero(self) -> (Self, Self) {
        Lanes::sin_cos_near_zero(self)
    }
    #[inline(always)]
    fn polynomial<const N: usize>(self, coefficients: &[f64; N]) -> Self {
        Lanes::polynomial(self, coefficients)
    }
}

/// A number with its derivatives by three others.
pub(super) struct Dual<S: Simd> {
    pub value: Lanes<S>,
    pub rate: [Lanes<S>; 3],
}

impl<S: Simd> Clone for Dual<S> {
    #[inline(always)]
    fn clone(&self) -> Self {
        *self
    }
}

impl<S: Simd> Copy for Dual<S> {}

impl<S: Simd> Add for Dual<S> {
    type Output = Self;
    #[inline(always)]
    fn add(mut self, other: Self) -> Self {
        self.value = self.value + other.value;
        for k in 0..3 {
            self.rate[k] = self.rate[k] + other.rate[k];
        }
        self
    }
}

impl<S: Simd> Sub for Dual<S> {
    type Output = Self;
    #[inline(always)]
    fn sub(mut self, other: Self) -> Self {
        self.value = self.value - other.value;
        for k in 0..3 {
            self.rate[k] = self.rate[k] - other.rate[k];
        }
        self
    }
}

impl<S: Simd> Mul for Dual<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(mut self, other: Self) -> Self {
        for k in 0..3 {
            let own = self.rate[k] * other.value;
            self.rate[k] = self.value.times_plus(other.rate[k], own);
        }
        self.value = self.value * other.value;
        self
    }
}

impl<S: Simd> Mul<f64> for Dual<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(mut self, factor: f64) -> Self {
        self.value = self.value * factor;
        for k in 0..3 {
            self.rate[k] = self.rate[k] * factor;
        }
        self
    }
}

impl<S: Simd> Neg for Dual<S> {
    type Output = Self;
    #[inline(always)]
    fn neg(mut self) -> Self {
        self.value = -self.value;
        for k in 0..3 {
            self.rate[k] = -self.rate[k];
        }
        self
    }
}

impl<S: Simd> Dual<S> {
    /// A function of this number from its value and its derivative.
    #[inline(always)]
    fn map(mut self, value: Lanes<S>, derivative: Lanes<S>) -> Self {
        self.value = value;
        for k in 0..3 {
            self.rate[k] = self.rate[k] * derivative;
        }
        self
    }
}

impl<S: Simd> Number for Dual<S> {
    #[inline(always)]
    fn times_plus(self, b: Self, c: Self) -> Self {
        self * b + c
    }
    #[inline(always)]
    fn sin_cos_near_zero(self) -> (Self, Self) {
        let (s, c) = self.value.sin_cos_near_zero();
        (self.map(s, c), self.map(c, -s))
    }
    #[inline(always)]
    fn polynomial<const N: usize>(self, coefficients: &[f64; N]) -> Self {
        let x = self.value;
        let (mut sum, mut first) = (x.same(coefficients[0]), x.same(0.0));
        for k in 1..N {
            first = first.times_plus(x, sum);
            sum = sum.times_plus(x, x.same(coefficients[k]));
        }
        self.map(sum, first)
    }
}

/// `a . b`.
#[inline(always)]
pub(super) fn inner<N: Number>(a: &[N; 3], b: &[N; 3]) -> N {
    a[0].times_plus(b[0], a[1].times_plus(b[1], a[2] * b[2]))
}

/// `a x b`.
#[inline(always)]
pub(super) fn outer<N: Number>(a: &[N; 3], b: &[N; 3]) -> [N; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}
