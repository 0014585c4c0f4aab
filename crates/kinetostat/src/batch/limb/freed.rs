//! Passive joints taken out of a tangent: the leading block of the inverse of `[D E; G H]`.
//!
//! Reflections turn `E` into `[R; 0]`, as in [`crate::batch::numbers::eliminate`]. Then `G` is about `[R^T, 0]` and `H` about
//! zero, by as much as the load matters, so that in the order motions of the joints, wrenches that they
//! would bear, wrenches that are passed on, all pivots are those of the unloaded limb, nearly.

use pulp::Simd;

use crate::batch::numbers::instruction_set::apart;
use crate::batch::numbers::lanes::Lanes;
use crate::batch::numbers::reflection::{reflect, reflect_apart, reflection};
use crate::batch::numbers::wrenches::Mat6;
use crate::batch::plan::steps::Plan;

type Mat12<S> = [[Lanes<S>; 12]; 12];

/// Stiffness from `[D E; G H]` (column by column, spoilt), and the smallest relative pivot.
#[inline(always)]
pub(crate) fn freed<S: Simd>(simd: S, plan: &Plan, z: &mut Mat12<S>) -> (Mat6<S>, Lanes<S>) {
    apart!(simd, {
        let zero = Lanes::new(simd, 0.0);
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
        let (v, u, regular) = without_joints(simd, joints, width, z);
        let mut k = [[zero; 6]; 6];
        let regular = regular.least_of(solve(simd, joints, z, &mut k));
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
            reflect_apart(k..6, v, u, z.as_flattened_mut(), r, 12);
        }
    }
    (v, u, regular)
}

/// The stiffness in the axes before the reflections.
#[inline(always)]
fn reflect_back<S: Simd>(joints: usize, v: &Mat6<S>, u: &Mat6<S>, k: &mut Mat6<S>) {
    for j in (0..joints).rev() {
        for c in 0..6 {
            reflect_apart(j..6, &v[j], &u[j], k.as_flattened_mut(), c, 6);
        }
        for row in k.iter_mut() {
            reflect(j..6, &v[j], &u[j], row);
        }
    }
}

/// Solves for the wrenches that are passed on where the end moves by one in each direction, in place and without pivoting, `K` to
/// be zero before; the smallest relative pivot: of the joints' torques compared with the joints' motions, of the rest with its
/// diagonal entry.
///
/// Unknowns are motions of the joints, then wrenches along them, then the other wrenches; rows the motions along the
/// joints, their torques, the other motions. `R` is triangular with zeros below it, so that motions of the joints are taken
/// out of the torques alone, and are not found.
#[inline(always)]
fn solve<S: Simd>(simd: S, joints: usize, z: &mut Mat12<S>, x: &mut Mat6<S>) -> Lanes<S> {
    let (zero, one) = (Lanes::new(simd, 0.0), Lanes::new(simd, 1.0));
    // Row of wrench `i` among those of torques and other motions.
    let row = |i: usize| if i < joints { 6 + i } else { i };
    let mut size = [one; 6];
    for i in 0..6 {
        size[i] = if i < joints {
            z[6 + i][i].abs()
        } else {
            z[i][i].abs()
        };
        if i >= joints {
            x[i][i] = one;
        }
    }
    for k in 0..joints {
        let reciprocal = one / z[6 + k][k];
        for i in 0..joints {
            let l = z[6 + k][6 + i] * reciprocal;
            for j in k + 1..joints {
                z[6 + j][6 + i] = l.times_from(z[6 + j][k], z[6 + j][6 + i]);
            }
            for j in 0..6 {
                z[j][6 + i] = l.times_from(z[j][k], z[j][6 + i]);
            }
            x[i][k] = zero - l;
        }
    }
    let mut regular = one;
    for k in 0..6 {
        regular = regular.least_of(z[k][row(k)].abs() / size[k]);
        let reciprocal = one / z[k][row(k)];
        for i in k + 1..6 {
            let l = z[k][row(i)] * reciprocal;
            for j in k + 1..6 {
                z[j][row(i)] = l.times_from(z[j][row(k)], z[j][row(i)]);
            }
            for c in 0..6 {
                x[i][c] = l.times_from(x[k][c], x[i][c]);
            }
        }
        z[k][row(k)] = reciprocal;
    }
    for i in (0..6).rev() {
        for c in 0..6 {
            let mut y = x[i][c];
            for k in i + 1..6 {
                y = z[k][row(i)].times_from(x[k][c], y);
            }
            x[i][c] = y * z[i][row(i)];
        }
    }
    regular
}
