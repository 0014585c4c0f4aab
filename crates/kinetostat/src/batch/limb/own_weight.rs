//! What the weight of a mass along a segment of a link bends it by [D 5].
//!
//! Half of the mass at either end of the segment are points ([`crate::batch::plan::segments`]). The rest of its weight
//! has the potential `V = -g . c` with gravity `g` and `c = k (0, -rz, ry)` in the axes of the near end:
//!
//! ```text
//! torques on ry and rz:       C_d . g,    C = (k e_z, -k e_y)
//! moment on the near end:     c x g       (no force)
//! where the near end turns by w, and the coordinates go by x:
//!     d(C_d . g) = (C_d x g) . w          d(c x g) = c x (g x w) + sum_d (C_d x g) x_d
//! ```

use pulp::Simd;

use crate::batch::limb::loaded::LoadedLimb;
use crate::batch::numbers::lanes::Lanes;
use crate::batch::numbers::vectors::{Mat3, Vec3, cross};
use crate::batch::numbers::wrenches::Mat6;
use crate::batch::plan::steps::{OwnWeight, Spring};

/// A constant vector of the base in the axes of a frame.
#[inline(always)]
pub(crate) fn seen_from<S: Simd>(r: &Mat3<S>, v: &[f64; 3]) -> Vec3<S> {
    let mut own = [r[0].same(0.0); 3];
    for k in 0..3 {
        if v[k] != 0.0 {
            let along = r[0].same(v[k]);
            for i in 0..3 {
                own[i] = r[3 * k + i].times_plus(along, own[i]);
            }
        }
    }
    own
}

/// `C_d x g` of `ry` and `rz`, from the axes `y` and `z` of the near end.
#[inline(always)]
pub(crate) fn couples<S: Simd>(
    own: &OwnWeight,
    [y, z]: &[Vec3<S>; 2],
    gravity: &Vec3<S>,
) -> [Vec3<S>; 2] {
    let mut both = [cross(z, gravity), cross(gravity, y)];
    for couple in &mut both {
        for x in couple {
            *x = *x * own.moment;
        }
    }
    both
}

/// `a u + b v`.
#[inline(always)]
pub(crate) fn sum_along<S: Simd>([a, b]: &[Lanes<S>; 2], [u, v]: &[Vec3<S>; 2]) -> Vec3<S> {
    let mut sum = *u;
    for k in 0..3 {
        sum[k] = a.times_plus(u[k], *b * v[k]);
    }
    sum
}

/// `d(c x g) = c x (g x w)` in the axes of the near end.
#[inline(always)]
pub(crate) fn leans<S: Simd>(c: &Vec3<S>, gravity: &Vec3<S>, p: &mut Mat6<S>) {
    let (zero, one) = (c[0].same(0.0), c[0].same(1.0));
    for k in 0..3 {
        let mut w = [zero; 3];
        w[k] = one;
        let moment = cross(c, &cross(gravity, &w));
        for r in 0..3 {
            p[3 + r][3 + k] = p[3 + r][3 + k] + moment[r];
        }
    }
}

impl<S: Simd> LoadedLimb<S> {
    /// `c`, near axes.
    #[inline(always)]
    pub fn lean(&self, own: &OwnWeight) -> Vec3<S> {
        let [ry, rz] = own.turns;
        let z = self.coordinates[ry] * own.moment;
        [z.same(0.0), -(self.coordinates[rz] * own.moment), z]
    }

    /// The same in base axes, from the axes `y` and `z` of the near end there.
    #[inline(always)]
    pub fn lean_along(&self, own: &OwnWeight, axes: &[Vec3<S>; 2]) -> Vec3<S> {
        let [_, y, z] = self.lean(own);
        sum_along(&[y, z], axes)
    }

    /// Adds what the spring of a segment bears of it, and what goes on to its near end.
    #[inline(always)]
    pub fn own_weight(&self, spring: &Spring, torque: &mut [Lanes<S>; 6], moment: &mut Vec3<S>) {
        let Some(own) = &spring.own_weight else {
            return;
        };
        let g = &self.bending[own.place];
        torque[4] = g[2].times_plus(g[2].same(own.moment), torque[4]);
        torque[5] = g[1].times_from(g[1].same(own.moment), torque[5]);
        let turning = cross(&self.lean(own), g);
        for k in 0..3 {
            moment[k] = moment[k] + turning[k];
        }
    }
}
