//! Vectors of three numbers and 3 x 3 matrices, several postures at once: the bottom of all kernels.

use pulp::Simd;

use crate::batch::numbers::lanes::Lanes;

/// Three numbers: a vector in base axes.
pub(crate) type Vec3<S> = [Lanes<S>; 3];

/// A 3 x 3 matrix, row by row.
pub(crate) type Mat3<S> = [Lanes<S>; 9];

/// `a x b`.
#[inline(always)]
pub(crate) fn cross<S: Simd>(a: &Vec3<S>, b: &Vec3<S>) -> Vec3<S> {
    [
        a[2].times_from(b[1], a[1] * b[2]),
        a[0].times_from(b[2], a[2] * b[0]),
        a[1].times_from(b[0], a[0] * b[1]),
    ]
}

#[inline(always)]
pub(crate) fn dot<S: Simd>(a: &Vec3<S>, b: &Vec3<S>) -> Lanes<S> {
    a[0].times_plus(b[0], a[1].times_plus(b[1], a[2] * b[2]))
}

#[inline(always)]
pub(crate) fn minus<S: Simd>(a: &Vec3<S>, b: &Vec3<S>) -> Vec3<S> {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// `R v + p`.
#[inline(always)]
pub(crate) fn carried<S: Simd>(r: &Mat3<S>, v: &Vec3<S>, p: &Vec3<S>) -> Vec3<S> {
    let mut out = *p;
    for i in 0..3 {
        out[i] = r[3 * i].times_plus(
            v[0],
            r[3 * i + 1].times_plus(v[1], r[3 * i + 2].times_plus(v[2], p[i])),
        );
    }
    out
}

#[inline(always)]
pub(crate) fn product<S: Simd>(a: &Mat3<S>, b: &Mat3<S>) -> Mat3<S> {
    let mut out = *a;
    for i in 0..3 {
        for j in 0..3 {
            out[3 * i + j] = a[3 * i].times_plus(
                b[j],
                a[3 * i + 1].times_plus(b[3 + j], a[3 * i + 2] * b[6 + j]),
            );
        }
    }
    out
}

/// `A B^T`.
#[inline(always)]
pub(crate) fn product_transposed<S: Simd>(a: &Mat3<S>, b: &Mat3<S>) -> Mat3<S> {
    let mut out = *a;
    for i in 0..3 {
        for j in 0..3 {
            out[3 * i + j] = a[3 * i].times_plus(
                b[3 * j],
                a[3 * i + 1].times_plus(b[3 * j + 1], a[3 * i + 2] * b[3 * j + 2]),
            );
        }
    }
    out
}

/// `R <- R Rot(axis)` with the sine and cosine of the angle: two columns change.
#[inline(always)]
pub(crate) fn turn_columns<S: Simd, const AXIS: usize>(r: &mut Mat3<S>, s: Lanes<S>, c: Lanes<S>) {
    let (j, k) = ((AXIS + 1) % 3, (AXIS + 2) % 3);
    for i in 0..3 {
        let (a, b) = (r[3 * i + j], r[3 * i + k]);
        r[3 * i + j] = c.times_plus(a, s * b);
        r[3 * i + k] = s.times_from(a, c * b);
    }
}

/// Column of a matrix.
#[inline(always)]
pub(crate) fn column<S: Simd>(r: &Mat3<S>, k: usize) -> Vec3<S> {
    [r[k], r[3 + k], r[6 + k]]
}

/// A constant vector in all lanes.
#[inline(always)]
pub(crate) fn constant<S: Simd>(simd: S, v: &[f64; 3]) -> Vec3<S> {
    [
        Lanes::new(simd, v[0]),
        Lanes::new(simd, v[1]),
        Lanes::new(simd, v[2]),
    ]
}

#[inline(always)]
pub(crate) fn identity<S: Simd>(simd: S) -> Mat3<S> {
    let (o, z) = (Lanes::new(simd, 1.0), Lanes::new(simd, 0.0));
    [o, z, z, z, o, z, z, z, o]
}

/// A component. An index that is known at run time only would keep the vector out of registers.
#[inline(always)]
pub(crate) fn component<S: Simd>(v: &Vec3<S>, axis: usize) -> Lanes<S> {
    match axis {
        0 => v[0],
        1 => v[1],
        _ => v[2],
    }
}

/// A column, likewise.
#[inline(always)]
pub(crate) fn column_of<S: Simd>(r: &Mat3<S>, axis: usize) -> Vec3<S> {
    match axis {
        0 => column(r, 0),
        1 => column(r, 1),
        _ => column(r, 2),
    }
}

/// `p + R l` for a constant `l`, often along an axis.
#[inline(always)]
pub(crate) fn shifted<S: Simd>(r: &Mat3<S>, l: &[f64; 3], p: &mut Vec3<S>) {
    for k in 0..3 {
        if l[k] != 0.0 {
            for i in 0..3 {
                p[i] = r[3 * i + k].times_plus(p[i].same(l[k]), p[i]);
            }
        }
    }
}

/// `exp(hat(v)) R` for a small rotation vector.
#[inline(always)]
pub(crate) fn turned<S: Simd>(v: &Vec3<S>, r: &Mat3<S>) -> Mat3<S> {
    let z = dot(v, v);
    let a = z.polynomial(&[1.0 / 362_880.0, -1.0 / 5040.0, 1.0 / 120.0, -1.0 / 6.0, 1.0]);
    let b = z.polynomial(&[
        1.0 / 3_628_800.0,
        -1.0 / 40_320.0,
        1.0 / 720.0,
        -1.0 / 24.0,
        0.5,
    ]);
    let mut out = *r;
    for k in 0..3 {
        let own = column(r, k);
        let once = cross(v, &own);
        let twice = cross(v, &once);
        for i in 0..3 {
            out[3 * i + k] = b.times_plus(twice[i], a.times_plus(once[i], own[i]));
        }
    }
    out
}

#[inline(always)]
pub(crate) fn select<S: Simd>(active: Lanes<S>, yes: Lanes<S>, no: Lanes<S>) -> Lanes<S> {
    active.where_less(active.same(0.5), no, yes)
}

/// A constant matrix in all lanes.
#[inline(always)]
pub(crate) fn matrix<S: Simd>(simd: S, r: &[f64; 9]) -> Mat3<S> {
    let mut out = identity(simd);
    for k in 0..9 {
        out[k] = Lanes::new(simd, r[k]);
    }
    out
}

/// Rotation that leads from `from` to `to` as axis times twice the tangent of half the angle, base
/// axes: the rotation vector to third order, and finite up to half a turn.
#[inline(always)]
pub(crate) fn turn_between<S: Simd>(to: &Mat3<S>, from: &Mat3<S>) -> Vec3<S> {
    let r = product_transposed(to, from);
    let scale = r[0].same(2.0) / (r[0] + r[4] + r[8] + 1.0);
    [
        (r[7] - r[5]) * scale,
        (r[2] - r[6]) * scale,
        (r[3] - r[1]) * scale,
    ]
}
