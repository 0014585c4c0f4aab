//! Springs that are more than a constant matrix: bars in parallel, and beams that shorten as they
//! bend. The formulas are those of [`crate::ParallelogramLaw`] and [`crate::BowingLaw`].

use pulp::Simd;

use super::apart::apart;
use super::dual::{Dual, Number, inner, outer};
use super::lanes::Lanes;
use super::symmetric::Symmetric;
use super::wrenches::Mat6;
use crate::model::springs::parallelogram::ParallelogramLaw;

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
    apart!(simd, {
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
    })
}

/// Torques of a beam segment of the given length at a deflection (m, rad; translations before
/// rotations), and the square of its rotation.
#[inline(always)]
pub(super) fn bowing<S: Simd>(
    _: S,
    stiffness: &[f64; 36],
    length: f64,
    at: &[Lanes<S>; 6],
) -> ([Lanes<S>; 6], Lanes<S>) {
    let bent = Bent::at(length, at);
    (bent.torque(&bent.force(stiffness)), bent.square)
}

/// A beam segment bent.
struct Bent<'a, N> {
    length: f64,
    at: &'a [N; 6],
    /// Sines and cosines of its first two turns.
    turned: [(N, N); 2],
    /// Rotation vector in place of the turns, stretch of the axis in place of the motion along it.
    strain: [N; 6],
    /// Square of its rotation.
    square: N,
}

impl<'a, N: Number> Bent<'a, N> {
    #[inline(always)]
    fn at(length: f64, at: &'a [N; 6]) -> Self {
        // Rotation vector of Rx Ry Rz from half angles.
        let (sa, ca) = (at[3] * 0.5).sin_cos_near_zero();
        let (sb, cb) = (at[4] * 0.5).sin_cos_near_zero();
        let (sc, cc) = (at[5] * 0.5).sin_cos_near_zero();
        let v = [
            (sa * cb).times_plus(cc, ca * sb * sc),
            (ca * sb).times_plus(cc, -(sa * cb * sc)),
            (ca * cb).times_plus(sc, sa * sb * cc),
        ];
        // 2 asin(s) / s.
        let ratio = inner(&v, &v).polynomial(&ASIN) * 2.0;
        let f = [v[0] * ratio, v[1] * ratio, v[2] * ratio];
        let stretch = at[0] + bow(length, at[1], f[2], 1.0) + bow(length, at[2], f[1], -1.0);
        Self {
            length,
            at,
            turned: [at[3].sin_cos_near_zero(), at[4].sin_cos_near_zero()],
            strain: [stretch, at[1], at[2], f[0], f[1], f[2]],
            square: inner(&f, &f),
        }
    }

    /// What the strains ask of the segment: `K e`.
    #[inline(always)]
    fn force(&self, stiffness: &[f64; 36]) -> [N; 6] {
        let mut g = [self.strain[0] * 0.0; 6];
        for i in 0..6 {
            for j in 0..6 {
                g[i] = g[i] + self.strain[j] * stiffness[6 * i + j];
            }
        }
        g
    }

    /// Rates of the axis' stretch by the motions across it and by the rotation vector.
    #[inline(always)]
    fn stretches(&self) -> ([N; 2], [N; 2]) {
        let (y, z, fy, fz) = (self.at[1], self.at[2], self.strain[4], self.strain[5]);
        let (h, slope) = (self.length, 1.2 / self.length);
        let across = [y * slope - fz * 0.1, z * slope + fy * 0.1];
        (
            across,
            [
                fy * (2.0 * h / 15.0) + z * 0.1,
                fz * (2.0 * h / 15.0) - y * 0.1,
            ],
        )
    }

    /// Torques in the six motions, from those of the strains.
    #[inline(always)]
    fn torque(&self, force: &[N; 6]) -> [N; 6] {
        let n = force[0];
        let (across, turning) = self.stretches();
        let f = [self.strain[3], self.strain[4], self.strain[5]];
        let m = [
            force[3],
            n.times_plus(turning[0], force[4]),
            n.times_plus(turning[1], force[5]),
        ];
        // From the rotation vector to the three turns: the transposed rate of the logarithm.
        let c = self.square.polynomial(&LOGARITHM);
        let once = outer(&f, &m);
        let twice = outer(&f, &once);
        let mut about = m;
        for k in 0..3 {
            about[k] = c.times_plus(twice[k], m[k] + once[k] * 0.5);
        }
        let [(sx, cx), (sy, cy)] = self.turned;
        let third = [sy, -(sx * cy), cx * cy];
        [
            n,
            n.times_plus(across[0], force[1]),
            n.times_plus(across[1], force[2]),
            about[0],
            cx.times_plus(about[1], sx * about[2]),
            inner(&third, &about),
        ]
    }
}

/// How much a plane of bending shortens the axis.
#[inline(always)]
fn bow<N: Number>(h: f64, w: N, p: N, sign: f64) -> N {
    (w * w) * (0.6 / h) + (p * p) * (h / 15.0) - (w * p) * (0.1 * sign)
}

/// A deflection with its rates by the three turns.
#[inline(always)]
fn by_turns<S: Simd>(at: &[Lanes<S>; 6]) -> [Dual<S>; 6] {
    let (zero, one) = (at[0].same(0.0), at[0].same(1.0));
    let mut along = at.map(|value| Dual {
        value,
        rate: [zero; 3],
    });
    for k in 0..3 {
        along[3 + k].rate[k] = one;
    }
    along
}

/// A symmetric matrix from torques with their rates by the three turns; entries among translations are
/// left zero.
#[inline(always)]
fn symmetric<S: Simd>(torque: &[Dual<S>; 6]) -> Mat6<S> {
    let mut out = [[torque[0].value.same(0.0); 6]; 6];
    for i in 0..6 {
        for j in 0..3 {
            out[i][3 + j] = torque[i].rate[j];
            if i < 3 {
                out[3 + j][i] = torque[i].rate[j];
            }
        }
    }
    out
}

/// Tangent stiffness of a beam segment at a deflection. Derivatives by the turns are carried along;
/// those by the translations are written out, and the rest follows since a potential has a symmetric
/// tangent.
#[inline(always)]
pub(super) fn bowing_tangent<S: Simd>(
    stiffness: &[f64; 36],
    length: f64,
    at: &[Lanes<S>; 6],
) -> Mat6<S> {
    apart!(at[0].simd(), {
        let along = by_turns(at);
        let bent = Bent::at(length, &along);
        let force = bent.force(stiffness);
        let mut out = symmetric(&bent.torque(&force));
        // Of the axis' strain by x, y and z.
        let ([y, z], _) = bent.stretches();
        let first = [at[0].same(1.0), y.value, z.value];
        for i in 0..3 {
            for j in 0..3 {
                let mut sum = first[i] * first[j] * stiffness[0];
                if j > 0 {
                    sum = sum + first[i] * stiffness[j];
                }
                if i > 0 {
                    sum = sum + first[j] * stiffness[6 * i];
                }
                if i > 0 && j > 0 {
                    sum = sum + stiffness[6 * i + j];
                }
                if i > 0 && i == j {
                    sum = sum + force[0].value * (1.2 / length);
                }
                out[i][j] = sum;
            }
        }
        out
    })
}

/// Geometric stiffness of a beam segment at a deflection, which its forces add to the tangent, and the
/// inverse of the rates of its strains by the six motions.
#[inline(always)]
pub(super) fn bowing_geometric<S: Simd>(
    stiffness: &[f64; 36],
    length: f64,
    at: &[Lanes<S>; 6],
) -> (Mat6<S>, Mat6<S>) {
    apart!(at[0].simd(), {
        let (zero, one) = (at[0].same(0.0), at[0].same(1.0));
        let along = by_turns(at);
        let bent = Bent::at(length, &along);
        let held = bent.force(stiffness).map(|force| Dual {
            value: force.value,
            rate: [zero; 3],
        });
        let mut geometric = symmetric(&bent.torque(&held));
        for i in 1..3 {
            geometric[i][i] = held[0].value * (1.2 / length);
        }
        let (across, turning) = bent.stretches();
        let r: [[Lanes<S>; 3]; 3] = std::array::from_fn(|i| bent.strain[3 + i].rate);
        let minor = |i: usize, j: usize| {
            let (a, b, c, d) = ((i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3);
            r[a][c] * r[b][d] - r[a][d] * r[b][c]
        };
        let whole = r[0][0] * minor(0, 0) + r[0][1] * minor(0, 1) + r[0][2] * minor(0, 2);
        let per = one / whole;
        let mut inverse = [[zero; 6]; 6];
        for i in 0..3 {
            inverse[i][i] = one;
            for j in 0..3 {
                inverse[3 + i][3 + j] = minor(j, i) * per;
            }
        }
        for k in 0..2 {
            inverse[0][1 + k] = -across[k].value;
            inverse[0][4 + k] = -turning[k].value;
        }
        (geometric, inverse)
    })
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
