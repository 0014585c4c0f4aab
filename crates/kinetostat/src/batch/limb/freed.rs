//! Passive joints taken out of a tangent: the leading block of the inverse of `[D E; G H]`.
//!
//! Reflections turn `E` into `[R; 0]`, as in [`crate::batch::numbers::eliminate`]. Then `G` is about `[R^T, 0]` and `H` about
//! zero, by as much as the load matters, so that in the order motions of the joints, wrenches that they
//! would bear, wrenches that are passed on, all pivots are those of the unloaded limb, nearly.

use pulp::Simd;

use crate::batch::numbers::apart::apart;
use crate::batch::numbers::lanes::Lanes;
use crate::batch::numbers::reflection::{reflect, reflection};
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
        let (v, u, mut regular) = without_joints(simd, joints, width, z);
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
fn without_joints<S: Simd>(
    simd: S,
    joints: usize,
    width: usize,
    z: &mut Mat12<S>,
) -> (Mat6<S>, Mat6<S>, Lanes<S>) {
    let (zero, one) = (Lanes::new(simd, 0.0), Lanes::new(simd, 1.0));
    let mut regular = one;
    let (mut v, mut u) = ([[zero; 6]; 6], [[zero; 6]; 6]);
    for k in 0..joints {
        let (v, u) = (&mut v[k], &mut u[k]);
        v.copy_from_slice(&z[6 + k][..6]);
        regular = regular.least_of(reflection(k, v, u).share);
        for column in &mut z[..width] {
            reflect(k..6, v, u, column);
        }
        for r in 0..width {
            let mut row = [z[0][r], z[1][r], z[2][r], z[3][r], z[4][r], z[5][r]];
            reflect(k..6, v, u, &mut row);
            for i in k..6 {
                z[i][r] = row[i];
            }
        }
    }
    (v, u, regular)
}

/// The stiffness in the axes before the reflections.
#[inline(always)]
fn reflect_back<S: Simd>(joints: usize, v: &Mat6<S>, u: &Mat6<S>, k: &mut Mat6<S>) {
    for j in (0..joints).rev() {
        for c in 0..6 {
            let mut column = k.map(|row| row[c]);
            reflect(j..6, &v[j], &u[j], &mut column);
            for i in j..6 {
                k[i][c] = column[i];
            }
        }
        for row in k.iter_mut() {
            reflect(j..6, &v[j], &u[j], row);
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
