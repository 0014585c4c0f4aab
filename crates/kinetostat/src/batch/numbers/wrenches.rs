//! Wrenches, twists and 6 x 6 matrices as they are carried from frame to frame, several postures at once.

use pulp::Simd;

use crate::batch::numbers::lanes::Lanes;
use crate::batch::numbers::vectors::{Vec3, carried, cross, matrix};

/// A 6 x 6 matrix by rows; a set of six twists in some places.
pub(crate) type Mat6<S> = [[Lanes<S>; 6]; 6];

/// `m + l x f` for a constant `l`, often along an axis.
#[inline(always)]
pub(crate) fn lever<S: Simd>(l: &[f64; 3], f: &Vec3<S>, m: &mut Vec3<S>) {
    for k in 0..3 {
        if l[k] != 0.0 {
            slid(k, f[0].same(l[k]), f, m);
        }
    }
}

/// The moment of a force about a point that lies `l` back along an axis: `m + l e x f`.
#[inline(always)]
pub(crate) fn slid<S: Simd>(axis: usize, l: Lanes<S>, f: &Vec3<S>, m: &mut Vec3<S>) {
    match axis {
        0 => slid_along::<S, 0>(l, f, m),
        1 => slid_along::<S, 1>(l, f, m),
        _ => slid_along::<S, 2>(l, f, m),
    }
}

#[inline(always)]
fn slid_along<S: Simd, const AXIS: usize>(l: Lanes<S>, f: &Vec3<S>, m: &mut Vec3<S>) {
    let (j, k) = ((AXIS + 1) % 3, (AXIS + 2) % 3);
    m[j] = l.times_from(f[k], m[j]);
    m[k] = l.times_plus(f[j], m[k]);
}

/// Force and moment in the axes before a rotation about one of them: `Rot(axis) v`.
#[inline(always)]
pub(crate) fn back<S: Simd>(
    axis: usize,
    s: Lanes<S>,
    c: Lanes<S>,
    f: &mut Vec3<S>,
    m: &mut Vec3<S>,
) {
    match axis {
        0 => {
            back_about::<S, 0>(s, c, f);
            back_about::<S, 0>(s, c, m);
        }
        1 => {
            back_about::<S, 1>(s, c, f);
            back_about::<S, 1>(s, c, m);
        }
        _ => {
            back_about::<S, 2>(s, c, f);
            back_about::<S, 2>(s, c, m);
        }
    }
}

#[inline(always)]
fn back_about<S: Simd, const AXIS: usize>(s: Lanes<S>, c: Lanes<S>, v: &mut Vec3<S>) {
    let (j, k) = ((AXIS + 1) % 3, (AXIS + 2) % 3);
    let (a, b) = (v[j], v[k]);
    v[j] = s.times_from(b, c * a);
    v[k] = s.times_plus(a, c * b);
}

/// Force and moment in the axes before a constant rotation.
#[inline(always)]
pub(crate) fn rotated_back<S: Simd>(simd: S, by: &[f64; 9], f: &mut Vec3<S>, m: &mut Vec3<S>) {
    let (r, zero) = (matrix(simd, by), Lanes::new(simd, 0.0));
    *f = carried(&r, f, &[zero; 3]);
    *m = carried(&r, m, &[zero; 3]);
}

/// A constant 6 x 6 matrix times six numbers.
#[inline(always)]
pub(crate) fn times<S: Simd>(matrix: &[f64; 36], x: &[Lanes<S>; 6]) -> [Lanes<S>; 6] {
    let mut out = *x;
    for i in 0..6 {
        let mut sum = x[0] * matrix[6 * i];
        for j in 1..6 {
            sum = x[j].times_plus(x[j].same(matrix[6 * i + j]), sum);
        }
        out[i] = sum;
    }
    out
}

/// `A t = [0, hat(f); hat(f), hat(m)] t` for a twist.
#[inline(always)]
pub(crate) fn outer<S: Simd>(
    force: &Vec3<S>,
    moment: &Vec3<S>,
    t: &[Lanes<S>; 6],
) -> [Lanes<S>; 6] {
    let (v, w) = ([t[0], t[1], t[2]], [t[3], t[4], t[5]]);
    let top = cross(force, &w);
    let (a, b) = (cross(force, &v), cross(moment, &w));
    [
        top[0],
        top[1],
        top[2],
        a[0] + b[0],
        a[1] + b[1],
        a[2] + b[2],
    ]
}

#[inline(always)]
pub(crate) fn dot6<S: Simd>(a: &[Lanes<S>; 6], b: &[Lanes<S>; 12]) -> Lanes<S> {
    let mut sum = a[0] * b[0];
    for k in 1..6 {
        sum = a[k].times_plus(b[k], sum);
    }
    sum
}

/// `M X = B` in place without pivoting; the smallest pivot relative to its diagonal entry.
#[inline(always)]
pub(crate) fn solve_small<S: Simd, const N: usize, const C: usize>(
    simd: S,
    m: &mut [[Lanes<S>; N]; N],
    x: &mut [[Lanes<S>; C]; N],
) -> Lanes<S> {
    let one = Lanes::new(simd, 1.0);
    let mut regular = one;
    let mut diagonal = [one; N];
    for i in 0..N {
        diagonal[i] = m[i][i].abs();
    }
    for k in 0..N {
        regular = regular.least_of(m[k][k].abs() / diagonal[k]);
        let reciprocal = one / m[k][k];
        for i in k + 1..N {
            let l = m[i][k] * reciprocal;
            for j in k + 1..N {
                m[i][j] = l.times_from(m[k][j], m[i][j]);
            }
            for c in 0..C {
                x[i][c] = l.times_from(x[k][c], x[i][c]);
            }
        }
        m[k][k] = reciprocal;
    }
    for i in (0..N).rev() {
        for c in 0..C {
            let mut y = x[i][c];
            for k in i + 1..N {
                y = m[i][k].times_from(x[k][c], y);
            }
            x[i][c] = y * m[i][i];
        }
    }
    regular
}

#[inline(always)]
pub(crate) fn weight<S: Simd>(simd: S, gravity: &[f64; 3], mass: f64) -> Vec3<S> {
    let [x, y, z] = gravity;
    [
        Lanes::new(simd, x * mass),
        Lanes::new(simd, y * mass),
        Lanes::new(simd, z * mass),
    ]
}

/// `a . b`.
#[inline(always)]
pub(crate) fn inner6<S: Simd>(a: &[Lanes<S>; 6], b: &[Lanes<S>; 6]) -> Lanes<S> {
    let mut sum = a[0] * b[0];
    for k in 1..6 {
        sum = a[k].times_plus(b[k], sum);
    }
    sum
}

/// `P` in the axes before a rotation about one of them: `Q P Q^T`.
#[inline(always)]
pub(crate) fn turn<S: Simd>(axis: usize, s: Lanes<S>, c: Lanes<S>, p: &mut Mat6<S>) {
    match axis {
        0 => turn_about::<S, 0>(s, c, p),
        1 => turn_about::<S, 1>(s, c, p),
        _ => turn_about::<S, 2>(s, c, p),
    }
}

#[inline(always)]
fn turn_about<S: Simd, const AXIS: usize>(s: Lanes<S>, c: Lanes<S>, p: &mut Mat6<S>) {
    for from in [0, 3] {
        let (j, k) = (from + (AXIS + 1) % 3, from + (AXIS + 2) % 3);
        for i in 0..6 {
            let (a, b) = (p[j][i], p[k][i]);
            p[j][i] = s.times_from(b, c * a);
            p[k][i] = s.times_plus(a, c * b);
        }
    }
    for from in [0, 3] {
        let (j, k) = (from + (AXIS + 1) % 3, from + (AXIS + 2) % 3);
        for i in 0..6 {
            let (a, b) = (p[i][j], p[i][k]);
            p[i][j] = s.times_from(b, c * a);
            p[i][k] = s.times_plus(a, c * b);
        }
    }
}

/// `P` about a point that lies `l` back along an axis.
#[inline(always)]
pub(crate) fn shift<S: Simd>(axis: usize, l: Lanes<S>, p: &mut Mat6<S>) {
    match axis {
        0 => shift_along::<S, 0>(l, p),
        1 => shift_along::<S, 1>(l, p),
        _ => shift_along::<S, 2>(l, p),
    }
}

#[inline(always)]
fn shift_along<S: Simd, const AXIS: usize>(l: Lanes<S>, p: &mut Mat6<S>) {
    let (j, k) = ((AXIS + 1) % 3, (AXIS + 2) % 3);
    for i in 0..6 {
        p[i][3 + j] = l.times_from(p[i][k], p[i][3 + j]);
        p[i][3 + k] = l.times_plus(p[i][j], p[i][3 + k]);
    }
    for i in 0..6 {
        p[3 + j][i] = l.times_from(p[k][i], p[3 + j][i]);
        p[3 + k][i] = l.times_plus(p[j][i], p[3 + k][i]);
    }
}

/// `P` in the axes before a constant rotation.
#[inline(always)]
pub(crate) fn rotate<S: Simd>(simd: S, by: &[f64; 9], p: &mut Mat6<S>) {
    let r = matrix(simd, by);
    for _ in 0..2 {
        // Rows, then columns as rows of the transposed matrix.
        let before = *p;
        for from in [0, 3] {
            for i in 0..3 {
                for k in 0..6 {
                    let mut sum = r[3 * i] * before[from][k];
                    for j in 1..3 {
                        sum = r[3 * i + j].times_plus(before[from + j][k], sum);
                    }
                    p[k][from + i] = sum;
                }
            }
        }
    }
}
