//! Passive joints taken out of a tangent: the leading block of the inverse of `[D E; G H]`.
//!
//! Reflections turn `E` into `[R; 0]`, as in [`crate::batch::numbers::eliminate`]. Then `G` is about `[R^T, 0]` and `H` about
//! zero, by as much as the load matters, so that in the order motions of the joints, wrenches that they
//! would bear, wrenches that are passed on, all pivots are those of the unloaded limb, nearly.

use pulp::Simd;

use crate::batch::numbers::apart::apart;
use crate::batch::numbers::lanes::Lanes;
use crate::batch::numbers::wrenches::Mat6;
use crate::batch::plan::steps::Plan;

type Mat12<S> = [[Lanes<S>; 12]; 12];

/// Stiffness from `[D E; G H]` (column by column, spoilt), and the smallest relative pivot.
#[inline(always)]
pub(crate) fn freed<S: Simd>(simd: S, plan: &Plan, z: &mut Mat12<S>) -> (Mat6<S>, Lanes<S>) {
    apart!(simd, {
        let (zero, one) = (Lanes::new(simd, 0.0), Lanes::new(simd, 1.0));
        let joints = plan.passive.len().min(6);
        let width = 6 + joints;
        // Rotations count as motions at the natural length.
        let unit = 1.0 / plan.length;
        for c in 0..width {
            for k in 0..3 {
                z[c][k] = z[c][k] * unit;
            }
        }
        for c in 0..3 {
            for r in 0..width {
                z[c][r] = z[c][r] * unit;
            }
        }
        let (v, u, mut regular) = reflect(simd, joints, width, z);
        let mut m = [[zero; 12]; 12];
        let mut x = [[zero; 6]; 12];
        for p in 0..width {
            // Rows: motions along the joints, their torques, the other motions.
            let row = if p < joints {
                p
            } else if p < 2 * joints {
                6 + p - joints
            } else {
                p - joints
            };
            for q in 0..width {
                let column = if q < joints { 6 + q } else { q - joints };
                m[p][q] = z[column][row];
            }
            if row < 6 {
                x[p][row] = one;
            }
        }
        regular = regular.least_of(solve(simd, joints, width, &mut m, &mut x));
        let mut k = [[zero; 6]; 6];
        k.copy_from_slice(&x[joints..width]);
        reflect_back(joints, &v, &u, &mut k);
        for i in 0..6 {
            for j in 0..3 {
                k[i][j] = k[i][j] * unit;
                k[j][i] = k[j][i] * unit;
            }
        }
        (k, regular)
    })
}

/// Reflections `1 - v u^T` that turn `E` into `[R; 0]`, on both sides of `[D E; G H]` (column by column); `v`, `u` and
/// the smallest relative length of a reflected column.
#[inline(always)]
fn reflect<S: Simd>(
    simd: S,
    joints: usize,
    width: usize,
    z: &mut Mat12<S>,
) -> (Mat6<S>, Mat6<S>, Lanes<S>) {
    let (zero, one) = (Lanes::new(simd, 0.0), Lanes::new(simd, 1.0));
    let mut regular = one;
    let (mut v, mut u) = ([[zero; 6]; 6], [[zero; 6]; 6]);
    for k in 0..joints {
        let column = z[6 + k];
        let (mut whole, mut rest) = (zero, zero);
        for i in 0..6 {
            whole = column[i].times_plus(column[i], whole);
            if i >= k {
                rest = column[i].times_plus(column[i], rest);
            }
        }
        regular = regular.least_of(rest / whole);
        let norm = rest.sqrt();
        let signed = column[k].where_less(zero, -norm, norm);
        v[k][k..].copy_from_slice(&column[k..6]);
        v[k][k] = column[k] + signed;
        let scale = one / (signed * v[k][k]);
        for i in k..6 {
            u[k][i] = v[k][i] * scale;
        }
        for c in 0..width {
            let mut along = zero;
            for i in k..6 {
                along = u[k][i].times_plus(z[c][i], along);
            }
            for i in k..6 {
                z[c][i] = along.times_from(v[k][i], z[c][i]);
            }
        }
        for r in 0..width {
            let mut along = zero;
            for i in k..6 {
                along = u[k][i].times_plus(z[i][r], along);
            }
            for i in k..6 {
                z[i][r] = along.times_from(v[k][i], z[i][r]);
            }
        }
    }
    (v, u, regular)
}

/// The stiffness in the axes before the reflections.
#[inline(always)]
fn reflect_back<S: Simd>(joints: usize, v: &Mat6<S>, u: &Mat6<S>, k: &mut Mat6<S>) {
    let zero = k[0][0].same(0.0);
    for j in (0..joints).rev() {
        for c in 0..6 {
            let mut column = zero;
            for i in j..6 {
                column = u[j][i].times_plus(k[i][c], column);
            }
            for i in j..6 {
                k[i][c] = column.times_from(v[j][i], k[i][c]);
            }
        }
        for r in 0..6 {
            let mut row = zero;
            for i in j..6 {
                row = u[j][i].times_plus(k[r][i], row);
            }
            for i in j..6 {
                k[r][i] = row.times_from(v[j][i], k[r][i]);
            }
        }
    }
}

/// `M X = B` in place without pivoting, `X` from row `joints` on; the smallest relative pivot: of the
/// joints' torques compared with the joints' motions, of the rest with its diagonal entry.
#[inline(always)]
fn solve<S: Simd>(
    simd: S,
    joints: usize,
    width: usize,
    m: &mut Mat12<S>,
    x: &mut [[Lanes<S>; 6]; 12],
) -> Lanes<S> {
    let one = Lanes::new(simd, 1.0);
    let mut regular = one;
    let mut size = [one; 12];
    for i in 0..width {
        let like = if i < 2 * joints && i >= joints {
            i - joints
        } else {
            i
        };
        size[i] = m[like][like].abs();
    }
    for k in 0..width {
        regular = regular.least_of(m[k][k].abs() / size[k]);
        let reciprocal = one / m[k][k];
        for i in k + 1..width {
            let l = m[i][k] * reciprocal;
            for j in k + 1..width {
                m[i][j] = l.times_from(m[k][j], m[i][j]);
            }
            for c in 0..6 {
                x[i][c] = l.times_from(x[k][c], x[i][c]);
            }
        }
        m[k][k] = reciprocal;
    }
    for i in (joints..width).rev() {
        for c in 0..6 {
            let mut y = x[i][c];
            for k in i + 1..width {
                y = m[i][k].times_from(x[k][c], y);
            }
            x[i][c] = y * m[i][i];
        }
    }
    regular
}
