//! Bending by the weight of a mass along a segment of a link [D 5].
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
use crate::batch::numbers::apart::apart;
use crate::batch::numbers::lanes::Lanes;
use crate::batch::numbers::vectors::{Vec3, cross};
use crate::batch::numbers::wrenches::Mat6;
use crate::batch::plan::steps::{OwnWeight, Spring};

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

impl<S: Simd> LoadedLimb<S> {
    /// `c`, near axes.
    #[inline(always)]
    pub fn lean(&self, own: &OwnWeight) -> Vec3<S> {
        let [ry, rz] = own.turns;
        let z = self.coordinates[ry] * own.moment;
        [z.same(0.0), -(self.coordinates[rz] * own.moment), z]
    }

    /// Lean `c` in base axes, from the axes `y` and `z` of the near end there.
    #[inline(always)]
    pub fn lean_along(&self, own: &OwnWeight, axes: &[Vec3<S>; 2]) -> Vec3<S> {
        let [_, y, z] = self.lean(own);
        sum_along(&[y, z], axes)
    }

    /// Adds what the spring of a segment bears of it, and what goes on to its near end. Apart, and on copies: few limbs have
    /// such segments, and the sweeps of the others keep their numbers in registers.
    #[inline(always)]
    pub fn own_weight(&self, spring: &Spring, torque: &mut [Lanes<S>; 6], moment: &mut Vec3<S>) {
        if let Some(own) = &spring.own_weight {
            (*torque, *moment) = self.with_own_weight(own, *torque, *moment);
        }
    }

    #[inline(always)]
    fn with_own_weight(
        &self,
        own: &OwnWeight,
        mut torque: [Lanes<S>; 6],
        mut moment: Vec3<S>,
    ) -> ([Lanes<S>; 6], Vec3<S>) {
        apart!(self.simd, {
            let g = &self.gravity[own.near];
            torque[4] = g[2].times_plus(g[2].same(own.moment), torque[4]);
            torque[5] = g[1].times_from(g[1].same(own.moment), torque[5]);
            let turning = cross(&self.lean(own), g);
            for k in 0..3 {
                moment[k] = moment[k] + turning[k];
            }
            (torque, moment)
        })
    }

    /// Adds how the moment on the near end goes by its turn to `P` ([`crate::batch::limb::newton`]), near axes; the
    /// moment with it.
    #[inline(always)]
    pub fn leans(&self, own: &OwnWeight, mut moment: Vec3<S>, p: &mut Mat6<S>) -> Vec3<S> {
        apart!(self.simd, {
            let (c, g) = (self.lean(own), self.gravity[own.near]);
            let turning = cross(&c, &g);
            for k in 0..3 {
                moment[k] = moment[k] + turning[k];
                let mut w = [g[0].same(0.0); 3];
                w[k] = g[0].same(1.0);
                let turned = cross(&c, &cross(&g, &w));
                for r in 0..3 {
                    p[3 + r][3 + k] = p[3 + r][3 + k] + turned[r];
                }
            }
            moment
        })
    }
}
