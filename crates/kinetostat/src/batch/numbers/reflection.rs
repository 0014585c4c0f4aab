//! Householder's reflections `H = 1 - v u^T` with `u = 2 v / v^T v`, of several postures at once.

use std::ops::Range;

use pulp::Simd;

use crate::batch::numbers::lanes::Lanes;

/// Image of the column for which a reflection was made.
pub(crate) struct Image<S: Simd> {
    /// The number at its place; those after it are zero, those before it as they were.
    pub number: Lanes<S>,
    /// Squared length of the reflected part by that of the whole column: near zero where the column depends on those
    /// before it.
    pub share: Lanes<S>,
}

/// The reflection that leads a column, from place `k` on, to axis `k`: `v` holds the column and becomes `v`, which is
/// zero before `k`; `u` likewise from there on. Nothing is reflected where the column is zero.
#[inline(always)]
pub(crate) fn reflection<S: Simd>(k: usize, v: &mut [Lanes<S>], u: &mut [Lanes<S>]) -> Image<S> {
    let (zero, one) = (v[k].same(0.0), v[k].same(1.0));
    let square = |numbers: &[Lanes<S>]| {
        let mut sum = zero;
        for x in numbers {
            sum = x.times_plus(*x, sum);
        }
        sum
    };
    let (before, own) = (square(&v[..k]), square(&v[k..]));
    v[..k].fill(zero);
    let norm = own.sqrt();
    // Away from cancellation.
    let signed = v[k].where_less(zero, -norm, norm);
    v[k] = v[k] + signed;
    let least = one * 1e-280;
    let scale = own.where_less(least, zero, one / (signed * v[k]).max(least));
    for (to, from) in u[k..].iter_mut().zip(&v[k..]) {
        *to = *from * scale;
    }
    Image {
        number: -signed,
        share: own / (before + own),
    }
}

/// `x - v u^T x`, at these places.
#[inline(always)]
pub(crate) fn reflect<S: Simd>(
    places: Range<usize>,
    v: &[Lanes<S>],
    u: &[Lanes<S>],
    x: &mut [Lanes<S>],
) {
    let mut along = x[0].same(0.0);
    for i in places.clone() {
        along = u[i].times_plus(x[i], along);
    }
    for i in places {
        x[i] = along.times_from(v[i], x[i]);
    }
}

/// Reflects numbers that lie `stride` apart, from `first` on: a column of a row-major matrix. A copy for the
/// reflection, one register after the other, would wait for what was written last.
#[inline(always)]
pub(crate) fn reflect_apart<S: Simd>(
    places: Range<usize>,
    v: &[Lanes<S>],
    u: &[Lanes<S>],
    x: &mut [Lanes<S>],
    first: usize,
    stride: usize,
) {
    let mut along = v[0].same(0.0);
    for i in places.clone() {
        along = u[i].times_plus(x[first + i * stride], along);
    }
    for i in places {
        let x = &mut x[first + i * stride];
        *x = along.times_from(v[i], *x);
    }
}
