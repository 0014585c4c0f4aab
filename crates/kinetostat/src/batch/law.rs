//! Springs that are more than a constant matrix: bars in parallel, and beams that shorten as they
//! bend. The formulas are those of [`crate::ParallelogramLaw`] and [`crate::BowingLaw`].

use pulp::Simd;

use super::lanes::{Lanes, Vec3, cross, dot};
use super::symmetric::Symmetric;
use crate::parallelogram::ParallelogramLaw;

/// Rotations beyond this (squared, rad^2) leave the range of the series.
pub(super) const MOST_SQUARE: f64 = 0.27;

/// Compliance of a parallelogram at its inclination (rad) in the six directions, the missing one
/// rigid.
#[inline(always)]
pub(super) fn parallelogram<S: Simd>(
    simd: S,
    law: &ParallelogramLaw,
    inclination: Lanes<S>,
) -> Symmetric<S> {
    let k = &law.bar;
    let square = law.width * law.width;
    let (s, c) = inclination.sin_cos();
    let one = Lanes::new(simd, 1.0);
    // Stiffnesses of the pair: y with rz, rx with rz; the others alone.
    let yy = one * (2.0 * k[(1, 1)]);
    let y_rz = one * (2.0 * k[(1, 5)]);
    let rx = (c * c).times_plus(one * (square * k[(1, 1)] / 2.0), one * (2.0 * k[(3, 3)]));
    let rx_rz = s * c * (square * k[(1, 1)] / 2.0);
    let rz = (s * s).times_plus(one * (square * k[(1, 1)] / 2.0), one * (2.0 * k[(5, 5)]));
    // Inverse of [yy, 0, y_rz; 0, rx, rx_rz; y_rz, rx_rz, rz] by elimination of y and rx.
    let (a, b) = (y_rz / yy, rx_rz / rx);
    let last = one / rx_rz.times_from(b, y_rz.times_from(a, rz));
    let mut out = Symmetric::zero(simd);
    out.set(0, 0, one / (2.0 * k[(0, 0)]));
    out.set(4, 4, one / (c * c * (square * k[(0, 0)] / 2.0)));
    out.set(5, 5, last);
    out.set(1, 5, -(a * last));
    out.set(3, 5, -(b * last));
    out.set(1, 3, a * b * last);
    out.set(1, 1, (a * a).times_plus(last, one / yy));
    out.set(3, 3, (b * b).times_plus(last, one / rx));
    out
}

/// Torques of a beam segment of the given length at a deflection (m, rad; translations before
/// rotations), and the square of its rotation.
#[inline(always)]
pub(super) fn bowing<S: Simd>(
    simd: S,
    stiffness: &[f64; 36],
    length: f64,
    at: &[Lanes<S>; 6],
) -> ([Lanes<S>; 6], Lanes<S>) {
    let zero = Lanes::new(simd, 0.0);
    let h = length;
    // Rotation vector of Rx Ry Rz from half angles.
    let half = [3, 4, 5].map(|k: usize| (at[k] * 0.5).sin_cos_near_zero());
    let [(sa, ca), (sb, cb), (sc, cc)] = half;
    let v = [
        (sa * cb).times_plus(cc, ca * sb * sc),
        (ca * sb).times_plus(cc, -(sa * cb * sc)),
        (ca * cb).times_plus(sc, sa * sb * cc),
    ];
    // 2 asin(s) / s.
    let ratio = dot(&v, &v).polynomial(&ASIN) * 2.0;
    let f = v.map(|x| x * ratio);
    let (y, z, fy, fz) = (at[1], at[2], f[1], f[2]);
    let bow = |w: Lanes<S>, p: Lanes<S>, sign: f64| {
        (w * w) * (0.6 / h) + (p * p) * (h / 15.0) - (w * p) * (0.1 * sign)
    };
    let strain = [
        at[0] + bow(y, fz, 1.0) + bow(z, fy, -1.0),
        y,
        z,
        f[0],
        fy,
        fz,
    ];
    let mut g = [zero; 6];
    for i in 0..6 {
        for j in 0..6 {
            g[i] = strain[j].times_plus(strain[j].same(stiffness[6 * i + j]), g[i]);
        }
    }
    let n = g[0];
    let m: Vec3<S> = [
        g[3],
        g[4] + n * (fy * (2.0 * h / 15.0) + z * 0.1),
        g[5] + n * (fz * (2.0 * h / 15.0) - y * 0.1),
    ];
    // From the rotation vector to the three turns: the transposed rate of the logarithm.
    let square = dot(&f, &f);
    let c = square.polynomial(&LOGARITHM);
    let once = cross(&f, &m);
    let twice = cross(&f, &once);
    let about = [0, 1, 2].map(|k| c.times_plus(twice[k], once[k].times_plus(n.same(0.5), m[k])));
    let (sx, cx) = at[3].sin_cos_near_zero();
    let (sy, cy) = at[4].sin_cos_near_zero();
    let second = [zero, cx, sx];
    let third = [sy, -(sx * cy), cx * cy];
    (
        [
            n,
            g[1] + n * (y * (1.2 / h) - fz * 0.1),
            g[2] + n * (z * (1.2 / h) + fy * 0.1),
            about[0],
            dot(&second, &about),
            dot(&third, &about),
        ],
        square,
    )
}

/// `asin(s) / s` in powers of `s^2`, highest first: `(2k)! / (4^k k!^2 (2k + 1))`.
const ASIN: [f64; 14] = {
    let mut out = [0.0; 14];
    let (mut factor, mut k) = (1.0, 0);
    while k < 14 {
        let twice = 2.0 * k as f64;
        out[13 - k] = factor / (twice + 1.0);
        factor *= (twice + 1.0) / (twice + 2.0);
        k += 1;
    }
    out
};

/// `(1 - t/2 cot(t/2)) / t^2` in powers of `t^2`, highest first.
const LOGARITHM: [f64; 8] = [
    3_617.0 / 10_670_622_842_880_000.0,
    1.0 / 74_724_249_600.0,
    691.0 / 1_307_674_368_000.0,
    1.0 / 47_900_160.0,
    1.0 / 1_209_600.0,
    1.0 / 30_240.0,
    1.0 / 720.0,
    1.0 / 12.0,
];
