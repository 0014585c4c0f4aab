//! A segment that its own weight bends, in the pass of a tangent ([`crate::batch::limb::tangent`], whose names are
//! used here) [D 5].
//!
//! Half of the mass at either end of the segment are points ([`crate::batch::plan::steps`]). The rest of its weight
//! has the potential `V = -g . c` with gravity `g` and `c = k (0, -rz, ry)` in the axes of the near end:
//!
//! ```text
//! torques on ry and rz:       C_d . g,    C = (k e_z, -k e_y)
//! moment on the near end:     c x g       (no force)
//! where the near end turns by w, and the coordinates go by x:
//!     d(C_d . g) = (C_d x g) . w          d(c x g) = c x (g x w) + sum_d (C_d x g) x_d
//! ```
//!
//! With `y` passed on before the segment, `y'` beyond it, `t` the motion of its near end (turn `w`), `Y` the columns of `D`
//! and `G` by moments:
//!
//! ```text
//! y = y' + [0; mu],    mu = (w x c) x g + W q,    W = C x g of ry and rz
//! t = t0 + Y mu,       K q = S^T (y' + A t) + lambda + W^T w,    lambda = L q
//! ```
//!
//! `t0` of `y'`. Six numbers `lambda`, `mu` are found first, from a matrix near the identity.

use pulp::Simd;

use crate::batch::limb::loaded::{LoadedLimb, twists};
use crate::batch::limb::tangent::Pass;
use crate::batch::numbers::instruction_set::apart;
use crate::batch::numbers::lanes::Lanes;
use crate::batch::numbers::vectors::{Vec3, constant, cross, dot};
use crate::batch::numbers::wrenches::{Mat6, dot6, inner6, solve_small};
use crate::batch::plan::steps::{OwnWeight, Plan, Spring};

/// Effect of a segment's weight, base axes.
#[derive(Clone, Copy)]
struct Bends<S: Simd> {
    gravity: Vec3<S>,
    /// `c`.
    lean: Vec3<S>,
    /// `W`.
    couples: [Vec3<S>; 2],
}

impl<S: Simd> Bends<S> {
    #[inline(always)]
    fn new(limb: &LoadedLimb<S>, spring: &Spring, own: &OwnWeight, gravity: &Vec3<S>) -> Self {
        // Axes of the slides along y and z.
        let y = limb.places[spring.screw + 1].axis;
        let z = limb.places[spring.screw + 2].axis;
        Self {
            gravity: *gravity,
            lean: limb.lean_along(own, &[y, z]),
            couples: couples(own, &[y, z], gravity),
        }
    }

    /// Moment on the near end.
    #[inline(always)]
    fn moment_on_near_end(&self) -> Vec3<S> {
        cross(&self.lean, &self.gravity)
    }

    /// `(w x c) x g`.
    #[inline(always)]
    fn turned(&self, w: &Vec3<S>) -> Vec3<S> {
        cross(&cross(w, &self.lean), &self.gravity)
    }

    /// `W q`.
    #[inline(always)]
    fn bears(&self, q: &[Lanes<S>; 6]) -> Vec3<S> {
        sum_along(&[q[4], q[5]], &self.couples)
    }

    /// Adds `W^T w`.
    #[inline(always)]
    fn follows(&self, w: &Vec3<S>, torque: &mut [Lanes<S>; 6]) {
        for d in 0..2 {
            torque[4 + d] = torque[4 + d] + dot(&self.couples[d], w);
        }
    }
}

/// The turn of a motion that a column holds.
#[inline(always)]
fn turn<S: Simd>(t: &[Lanes<S>; 12]) -> Vec3<S> {
    [t[3], t[4], t[5]]
}

/// `M q` for a matrix of six directions.
#[inline(always)]
fn product<S: Simd>(m: &Mat6<S>, q: &[Lanes<S>; 6]) -> [Lanes<S>; 6] {
    let mut out = *q;
    for i in 0..6 {
        out[i] = inner6(&m[i], q);
    }
    out
}

/// The six numbers by `q`, but for what of `mu` goes by the turn of the near end.
#[inline(always)]
fn six<S: Simd>(l: &[[Lanes<S>; 6]; 3], bends: &Bends<S>, q: &[Lanes<S>; 6]) -> [Lanes<S>; 6] {
    let [x, y, z] = bends.bears(q);
    [
        inner6(&l[0], q),
        inner6(&l[1], q),
        inner6(&l[2], q),
        x,
        y,
        z,
    ]
}

impl<S: Simd> Pass<S> {
    /// Adds the moment of a segment's weight to those beyond.
    #[inline(always)]
    pub fn load_of_segment(
        &mut self,
        limb: &LoadedLimb<S>,
        spring: &Spring,
        own: &OwnWeight,
        gravity: &[f64; 3],
    ) {
        apart!(self.simd, {
            let g = constant(self.simd, gravity);
            let moment = Bends::new(limb, spring, own, &g).moment_on_near_end();
            for k in 0..3 {
                self.moment[k] = self.moment[k] + moment[k];
            }
        });
    }

    /// A segment with a mass along it, its spring of compliance `c`.
    #[inline(always)]
    pub fn segment(
        &mut self,
        plan: &Plan,
        limb: &LoadedLimb<S>,
        spring: &Spring,
        own: &OwnWeight,
        c: &Mat6<S>,
        gravity: &[f64; 3],
    ) {
        apart!(self.simd, {
            let (zero, one) = (Lanes::new(self.simd, 0.0), Lanes::new(self.simd, 1.0));
            let bends = Bends::new(limb, spring, own, &constant(self.simd, gravity));
            let moment = bends.moment_on_near_end();
            for k in 0..3 {
                self.moment[k] = self.moment[k] - moment[k];
            }
            let s = twists(self.simd, plan, limb, spring);
            let (turned, l) = self.turning(&s);
            // `q` and the six numbers by each of them.
            let about = [self.z[3], self.z[4], self.z[5]];
            let (mut by, mut m, mut inverse) = ([[zero; 6]; 6], [[zero; 6]; 6], [[zero; 6]; 6]);
            for j in 0..6 {
                let mut torque = [zero; 6];
                if j < 3 {
                    torque[3 + j] = one;
                } else {
                    for d in 0..6 {
                        torque[d] = -dot6(&turned[d], &about[j - 3]);
                    }
                    bends.follows(&turn(&about[j - 3]), &mut torque);
                }
                by[j] = product(c, &torque);
                let mut column = six(&l, &bends, &by[j]);
                if j > 2 {
                    let own = bends.turned(&turn(&about[j - 3]));
                    for k in 0..3 {
                        column[3 + k] = column[3 + k] + own[k];
                    }
                }
                for i in 0..6 {
                    m[i][j] = (if i == j { one } else { zero }) - column[i];
                }
                inverse[j][j] = one;
            }
            let regular = solve_small::<S, 6, 6>(self.simd, &mut m, &mut inverse);
            self.regular = self.regular.least_of(regular);
            for column in 0..self.width {
                let t = &mut self.z[column];
                let mut torque = [zero; 6];
                for d in 0..6 {
                    torque[d] = Self::row(&s[d], &turned[d], column, t);
                }
                bends.follows(&turn(t), &mut torque);
                let mut q = product(c, &torque);
                let (mut right, own) = (six(&l, &bends, &q), bends.turned(&turn(t)));
                for k in 0..3 {
                    right[3 + k] = right[3 + k] + own[k];
                }
                let x = product(&inverse, &right);
                for j in 0..6 {
                    for d in 0..6 {
                        q[d] = by[j][d].times_plus(x[j], q[d]);
                    }
                }
                for j in 0..3 {
                    for r in 0..self.width {
                        t[r] = about[j][r].times_plus(x[3 + j], t[r]);
                    }
                }
                for d in 0..6 {
                    for k in 0..6 {
                        t[k] = s[d][k].times_plus(q[d], t[k]);
                    }
                }
            }
        })
    }
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
