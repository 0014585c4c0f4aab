//! Several postures in one number: arithmetic on the lanes of a vector register.
//!
//! A kernel written with [`Lanes`] is compiled once for every instruction set that the machine may
//! have (`pulp` chooses at run time) and once for single numbers. Only additions, multiplications,
//! divisions, square roots and *fused* multiply-adds are used, all of which IEEE 754 rounds alike
//! everywhere: a lane's bits depend neither on its neighbours nor on the instruction set.

use std::ops::{Add, Div, Mul, Neg, Sub};

use pulp::Simd;

use crate::linalg::derivatives::{ASIN, LOGARITHM, Number, Real};

/// One number per lane.
pub(crate) struct Lanes<S: Simd> {
    simd: S,
    value: S::f64s,
}

impl<S: Simd> Clone for Lanes<S> {
    #[inline(always)]
    fn clone(&self) -> Self {
        *self
    }
}

impl<S: Simd> Copy for Lanes<S> {}

macro_rules! operator {
    ($trait:ident, $function:ident, $simd:ident) => {
        impl<S: Simd> $trait for Lanes<S> {
            type Output = Self;
            #[inline(always)]
            fn $function(self, other: Self) -> Self {
                self.with(self.simd.$simd(self.value, other.value))
            }
        }
        impl<S: Simd> $trait<f64> for Lanes<S> {
            type Output = Self;
            #[inline(always)]
            fn $function(self, other: f64) -> Self {
                self.with(self.simd.$simd(self.value, self.simd.splat_f64s(other)))
            }
        }
    };
}
operator!(Add, add, add_f64s);
operator!(Sub, sub, sub_f64s);
operator!(Mul, mul, mul_f64s);
operator!(Div, div, div_f64s);

impl<S: Simd> Neg for Lanes<S> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.with(self.simd.neg_f64s(self.value))
    }
}

impl<S: Simd> Lanes<S> {
    /// Fills all lanes with one number.
    #[inline(always)]
    pub fn new(simd: S, value: f64) -> Self {
        Self {
            simd,
            value: simd.splat_f64s(value),
        }
    }

    /// The instruction set.
    #[inline(always)]
    pub fn simd(self) -> S {
        self.simd
    }

    /// The first numbers of a slice, one per lane.
    #[inline(always)]
    pub fn load(simd: S, from: &[f64]) -> Self {
        let value = pulp::bytemuck::cast_slice::<f64, S::f64s>(&from[..S::F64_LANES])[0];
        Self { simd, value }
    }

    /// Stores into the first places of a slice.
    #[inline(always)]
    pub fn store(self, to: &mut [f64]) {
        pulp::bytemuck::cast_slice_mut::<f64, S::f64s>(&mut to[..S::F64_LANES])[0] = self.value;
    }

    /// The number in one lane.
    #[inline(always)]
    pub fn lane(&self, lane: usize) -> f64 {
        pulp::bytemuck::cast_slice::<S::f64s, f64>(std::slice::from_ref(&self.value))[lane]
    }

    #[inline(always)]
    fn with(self, value: S::f64s) -> Self {
        Self {
            simd: self.simd,
            value,
        }
    }

    /// A constant in all lanes.
    #[inline(always)]
    pub fn same(self, value: f64) -> Self {
        Self::new(self.simd, value)
    }

    /// `self * b + c`, rounded once.
    #[inline(always)]
    pub fn times_plus(self, b: Self, c: Self) -> Self {
        self.with(self.simd.mul_add_f64s(self.value, b.value, c.value))
    }

    /// `c - self * b`, rounded once.
    #[inline(always)]
    pub fn times_from(self, b: Self, c: Self) -> Self {
        self.with(self.simd.negate_mul_add_f64s(self.value, b.value, c.value))
    }

    /// Square root.
    #[inline(always)]
    pub fn sqrt(self) -> Self {
        self.with(self.simd.sqrt_f64s(self.value))
    }

    /// Absolute value.
    #[inline(always)]
    pub fn abs(self) -> Self {
        self.with(self.simd.abs_f64s(self.value))
    }

    /// The larger one.
    #[inline(always)]
    pub fn max(self, other: Self) -> Self {
        self.where_less(other, other, self)
    }

    /// The smaller one, or the lowest number of all where `other` is not a number.
    #[inline(always)]
    pub fn least_of(self, other: Self) -> Self {
        let larger = self.where_less(other, self, other);
        other.where_less(self.same(f64::INFINITY), larger, self.same(f64::MIN))
    }

    /// `then` in the lanes where this is less than `than`, `otherwise` elsewhere (where either is
    /// not a number too).
    #[inline(always)]
    pub fn where_less(self, than: Self, then: Self, otherwise: Self) -> Self {
        let mask = self.simd.less_than_f64s(self.value, than.value);
        self.with(self.simd.select_f64s(mask, then.value, otherwise.value))
    }

    /// True if this is less than `than` in every lane.
    #[inline(always)]
    pub fn all_less(self, than: f64) -> bool {
        let not = self.where_less(self.same(than), self.same(0.0), self.same(1.0));
        self.simd.reduce_max_f64s(not.value) == 0.0
    }

    /// Sine and cosine, |x| < 1e5 rad, to about one unit in the last place: reduction by multiples
    /// of a quarter turn in two parts, then the polynomials of Cephes on an eighth of a turn.
    #[inline(always)]
    pub fn sin_cos(self) -> (Self, Self) {
        // Adding 1.5 * 2^52 rounds to an integer and leaves it in the low bits.
        const ROUND: f64 = 6_755_399_441_055_744.0;
        let shifted = self.times_plus(self.same(std::f64::consts::FRAC_2_PI), self.same(ROUND));
        let quarters = shifted - ROUND;
        let r = quarters.times_from(self.same(std::f64::consts::FRAC_PI_2), self);
        let r = quarters.times_from(self.same(6.123_233_995_736_766e-17), r);
        let (sine, cosine) = r.sin_cos_near_zero();
        let simd = self.simd;
        let bits = simd.transmute_u64s_f64s(shifted.value);
        let (one, two) = (simd.splat_u64s(1), simd.splat_u64s(2));
        let has = |x, bit| simd.equal_u64s(simd.and_u64s(x, bit), bit);
        let odd = has(bits, one);
        let sine_negative = has(bits, two);
        let cosine_negative = has(simd.add_u64s(bits, one), two);
        let s = simd.select_f64s(odd, cosine.value, sine.value);
        let c = simd.select_f64s(odd, sine.value, cosine.value);
        let s = simd.select_f64s(sine_negative, simd.neg_f64s(s), s);
        let c = simd.select_f64s(cosine_negative, simd.neg_f64s(c), c);
        (self.with(s), self.with(c))
    }

    /// Sine and cosine of |x| <= pi / 4.
    #[inline(always)]
    pub fn sin_cos_near_zero(self) -> (Self, Self) {
        let z = self * self;
        let sine = z.polynomial(&[
            1.589_690_995_211_55e-10,
            -2.505_076_025_340_686_3e-8,
            2.755_731_370_707_006_8e-6,
            -1.984_126_982_985_795e-4,
            8.333_333_333_322_49e-3,
            -1.666_666_666_666_663_2e-1,
        ]);
        let cosine = z.polynomial(&[
            -1.135_964_755_778_819_5e-11,
            2.087_572_321_298_175e-9,
            -2.755_731_435_139_066_3e-7,
            2.480_158_728_947_673e-5,
            -1.388_888_888_887_411e-3,
            4.166_666_666_666_659_3e-2,
        ]);
        let half = z.times_from(self.same(0.5), self.same(1.0));
        (
            (self * z).times_plus(sine, self),
            (z * z).times_plus(cosine, half),
        )
    }

    /// Value of a polynomial, highest coefficient first.
    #[inline(always)]
    pub fn polynomial<const N: usize>(self, coefficients: &[f64; N]) -> Self {
        let mut sum = self.same(coefficients[0]);
        for c in &coefficients[1..] {
            sum = sum.times_plus(self, self.same(*c));
        }
        sum
    }
}

/// The series of [`crate::linalg::derivatives`] for springs that turn less than [`MOST_SQUARE`].
const SHORT_ASIN: [f64; 14] = last(&ASIN);
const SHORT_LOGARITHM: [f64; 8] = last(&LOGARITHM);

/// Rotations beyond this (squared, rad^2) leave the range of the series.
pub(crate) const MOST_SQUARE: f64 = 0.27;

const fn last<const N: usize, const M: usize>(all: &[f64; M]) -> [f64; N] {
    let (mut out, mut k) = ([0.0; N], 0);
    while k < N {
        out[k] = all[M - N + k];
        k += 1;
    }
    out
}

impl<S: Simd> Number for Lanes<S> {
    #[inline(always)]
    fn same(self, value: f64) -> Self {
        Lanes::same(self, value)
    }
    #[inline(always)]
    fn times_plus(self, b: Self, c: Self) -> Self {
        Lanes::times_plus(self, b, c)
    }
    #[inline(always)]
    fn times_from(self, b: Self, c: Self) -> Self {
        Lanes::times_from(self, b, c)
    }
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        Lanes::sin_cos(self)
    }
    #[inline(always)]
    fn sin_cos_of_spring(self) -> (Self, Self) {
        self.sin_cos_near_zero()
    }
    #[inline(always)]
    fn angle_per_sine(self) -> Self {
        self.polynomial(&SHORT_ASIN)
    }
    #[inline(always)]
    fn logarithm_factor(self) -> [Self; 2] {
        let [value, rate, _] = self.logarithm_factor_and_rates();
        [value, rate]
    }
    #[inline(always)]
    fn clamped(self, most: f64) -> Self {
        let (low, high) = (self.same(-most), self.same(most));
        let below = self.where_less(high, self, high);
        low.where_less(below, below, low)
    }
    #[inline(always)]
    fn is_negative(self) -> bool {
        false
    }
}

impl<S: Simd> Real for Lanes<S> {
    #[inline(always)]
    fn angle_per_sine_and_rate(self) -> [Self; 2] {
        let [value, rate, _] = self.series(&SHORT_ASIN);
        [value, rate]
    }
    #[inline(always)]
    fn logarithm_factor_and_rates(self) -> [Self; 3] {
        self.series(&SHORT_LOGARITHM)
    }
    #[inline(always)]
    fn is_within(self, most: f64) -> Self {
        let one = self.same(1.0);
        self.abs().where_less(one * most, one, self.same(0.0))
    }
}

impl<S: Simd> Lanes<S> {
    /// Value of a polynomial, highest coefficient first, and two derivatives.
    #[inline(always)]
    fn series<const N: usize>(self, coefficients: &[f64; N]) -> [Self; 3] {
        let zero = self.same(0.0);
        let (mut sum, mut first, mut second) = (self.same(coefficients[0]), zero, zero);
        for k in 1..N {
            second = second.times_plus(self, first * 2.0);
            first = first.times_plus(self, sum);
            sum = sum.times_plus(self, self.same(coefficients[k]));
        }
        [sum, first, second]
    }
}
