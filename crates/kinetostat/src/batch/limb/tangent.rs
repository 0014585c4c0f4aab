//! Tangent stiffness of a loaded limb, by one pass from its base to its end.
//!
//! With `t` the motion of the place reached and `y` the change of the wrench passed on there (both at the
//! tip's place), `x` the motions of the passive joints so far and rows as in [`crate::chain::sweep::stages`], the pass
//! carries
//!
//! ```text
//! t = D y + E x        0 = G y + H x        (torques of the passive joints do not change)
//! ```
//!
//! Nothing moves at the base. Along a stage of coordinates `q` with twists `S`, `t' = t + S q` and
//! `K q = S^T (y + A t) + L q`, `L` the part of `S^T A S` below the diagonal; a passive joint adds a
//! column and a row instead. At a dead force `y = y' + g t`. At the end `t = K_C y^-1`: `K_C` is the
//! leading block of the inverse of `[D E; G H]`. Exact under dead moments too, where it is not symmetric.

use pulp::Simd;

use crate::batch::limb::freed::freed;
use crate::batch::limb::law;
use crate::batch::limb::loaded::{LoadedLimb, deflection, twist, twists};
use crate::batch::numbers::instruction_set::apart;
use crate::batch::numbers::lanes::Lanes;
use crate::batch::numbers::vectors::{Vec3, cross, dot, minus};
use crate::batch::numbers::wrenches::{Mat6, dot6, outer, solve_small, weight};
use crate::batch::plan::steps::{Law, Plan, Spring, Step, Support};

pub(super) struct Pass<S: Simd> {
    /// `[D E; G H]`, column by column.
    pub(super) z: [[Lanes<S>; 12]; 12],
    /// Six and the passive joints.
    pub(super) width: usize,
    /// Force and moment beyond, about the tip's place.
    pub(super) force: Vec3<S>,
    pub(super) moment: Vec3<S>,
    pub(super) regular: Lanes<S>,
    pub(super) simd: S,
}

/// Tangent stiffness at the tip, 6 x 6 by rows, and its smallest relative pivot.
#[inline(always)]
pub(crate) fn stiffness<S: Simd>(
    simd: S,
    plan: &Plan,
    limb: &LoadedLimb<S>,
    gravity: &[f64; 3],
) -> (Mat6<S>, Lanes<S>) {
    apart!(simd, {
        let (zero, one) = (Lanes::new(simd, 0.0), Lanes::new(simd, 1.0));
        let [fx, fy, fz, mx, my, mz] = limb.wrench;
        let mut pass = Pass {
            z: [[zero; 12]; 12],
            width: 6 + plan.passive.len(),
            force: [fx, fy, fz],
            moment: [mx, my, mz],
            regular: one,
            simd,
        };
        let mut mass = 0;
        for step in &plan.steps {
            match step {
                Step::Mass { mass: m, .. } => {
                    let arm = minus(&limb.masses[mass], &limb.point);
                    pass.load(&weight(simd, gravity, *m), &arm);
                    mass += 1;
                }
                Step::Spring(spring) => {
                    if let Some(own) = &spring.own_weight {
                        pass.load_of_segment(limb, spring, own, gravity);
                    }
                }
                Step::Joint(_) | Step::Shift(_) | Step::Rotate(_) => {}
            }
        }
        let (mut mass, mut law) = (0, 0);
        for step in &plan.steps {
            match step {
                Step::Mass { mass: m, .. } => {
                    let weight = weight(simd, gravity, *m);
                    let arm = minus(&limb.masses[mass], &limb.point);
                    pass.node(&weight, &arm);
                    let [x, y, z] = weight;
                    pass.load(&[-x, -y, -z], &arm);
                    mass += 1;
                }
                Step::Joint(joint) => {
                    let Some((own, ratio)) = joint.amount.coordinate else {
                        continue;
                    };
                    let mut s = twist(limb, plan, joint.screw);
                    for x in &mut s {
                        *x = *x * ratio;
                    }
                    match joint.support {
                        Support::Spring(_) if joint.law.is_some() => {
                            pass.stage(&s, one / limb.joint_stiffness(joint, own, 1.0));
                        }
                        Support::Spring(c) => pass.stage(&s, zero + c),
                        Support::Passive(slot) => pass.passive(&s, slot),
                        Support::Fixed => {}
                    }
                }
                Step::Spring(spring) => {
                    let c = compliance(simd, limb, spring, &mut law, &mut pass.regular);
                    match &spring.own_weight {
                        None => pass.spring(plan, limb, spring, &c),
                        Some(own) => pass.segment(plan, limb, spring, own, &c, gravity),
                    }
                }
                Step::Shift(_) | Step::Rotate(_) => {}
            }
        }
        pass.node(&[fx, fy, fz], &[zero; 3]);
        pass.inverse(plan)
    })
}

/// Tangent compliance of a spring where it is.
#[inline(always)]
fn compliance<S: Simd>(
    simd: S,
    limb: &LoadedLimb<S>,
    spring: &Spring,
    law: &mut usize,
    regular: &mut Lanes<S>,
) -> Mat6<S> {
    let mut c = [[Lanes::new(simd, 0.0); 6]; 6];
    match &spring.law {
        Law::Constant => {
            for i in 0..6 {
                for j in 0..6 {
                    c[i][j] = Lanes::new(simd, spring.compliance[6 * i + j]);
                }
            }
        }
        Law::Parallelogram(..) => {
            for i in 0..6 {
                for j in 0..6 {
                    c[i][j] = limb.laws[*law].get(i, j);
                }
            }
            *law += 1;
        }
        Law::Curved(law, _) => {
            let mut k = law::tangent(law, &deflection(limb, spring));
            for i in 0..6 {
                c[i][i] = Lanes::new(simd, 1.0);
            }
            *regular = regular.least_of(solve_small::<S, 6, 6>(simd, &mut k, &mut c));
        }
    }
    c
}

impl<S: Simd> Pass<S> {
    /// Adds a force at a point, to which `arm` leads from the tip's place, to those beyond.
    #[inline(always)]
    fn load(&mut self, force: &Vec3<S>, arm: &Vec3<S>) {
        let own = cross(arm, force);
        for k in 0..3 {
            self.force[k] = self.force[k] + force[k];
            self.moment[k] = self.moment[k] + own[k];
        }
    }

    /// `S^T (y + A t)` for one column: `A` is skew.
    #[inline(always)]
    pub(super) fn row(
        s: &[Lanes<S>; 6],
        minus: &[Lanes<S>; 6],
        c: usize,
        t: &[Lanes<S>; 12],
    ) -> Lanes<S> {
        let turned = dot6(minus, t);
        if c < 6 { s[c] - turned } else { -turned }
    }

    /// One coordinate of compliance `c`.
    #[inline(always)]
    fn stage(&mut self, s: &[Lanes<S>; 6], compliance: Lanes<S>) {
        let turned = outer(&self.force, &self.moment, s);
        for c in 0..self.width {
            let t = &mut self.z[c];
            let q = Self::row(s, &turned, c, t) * compliance;
            for k in 0..6 {
                t[k] = q.times_plus(s[k], t[k]);
            }
        }
    }

    /// One motion of a passive joint.
    #[inline(always)]
    fn passive(&mut self, s: &[Lanes<S>; 6], slot: usize) {
        let turned = outer(&self.force, &self.moment, s);
        for c in 0..self.width {
            let torque = Self::row(s, &turned, c, &self.z[c]);
            self.z[c][6 + slot] = self.z[c][6 + slot] + torque;
        }
        for k in 0..6 {
            self.z[6 + slot][k] = self.z[6 + slot][k] + s[k];
        }
    }

    /// Effect of the load beyond on the twists of a spring: `A s` of each, and the rows of `L` of its rotations.
    #[inline(always)]
    pub(super) fn turning(&self, s: &Mat6<S>) -> (Mat6<S>, [[Lanes<S>; 6]; 3]) {
        let zero = Lanes::new(self.simd, 0.0);
        let mut turned = [[zero; 6]; 6];
        for d in 0..6 {
            turned[d] = outer(&self.force, &self.moment, &s[d]);
        }
        let mut l = [[zero; 6]; 3];
        for i in 0..3 {
            for j in 0..3 + i {
                let mut sum = s[3 + i][0] * turned[j][0];
                for k in 1..6 {
                    sum = s[3 + i][k].times_plus(turned[j][k], sum);
                }
                l[i][j] = sum;
            }
        }
        (turned, l)
    }

    /// A spring of six directions: `q = C (r + L q)`, and only the rows of the rotations of `L` are not
    /// zero, so that three numbers `L q` are found first.
    #[inline(always)]
    fn spring(&mut self, plan: &Plan, limb: &LoadedLimb<S>, spring: &Spring, c: &Mat6<S>) {
        apart!(self.simd, {
            let (zero, one) = (Lanes::new(self.simd, 0.0), Lanes::new(self.simd, 1.0));
            let s = twists(self.simd, plan, limb, spring);
            let (turned, l) = self.turning(&s);
            let mut n = [[zero; 3]; 3];
            for i in 0..3 {
                for k in 0..3 {
                    let mut sum = if i == k { one } else { zero };
                    for j in 0..3 + i {
                        sum = l[i][j].times_from(c[j][3 + k], sum);
                    }
                    n[i][k] = sum;
                }
            }
            let n = self.inverse3(&n);
            for column in 0..self.width {
                let t = &mut self.z[column];
                let mut r = [zero; 6];
                for d in 0..6 {
                    r[d] = Self::row(&s[d], &turned[d], column, t);
                }
                let mut q = [zero; 6];
                for d in 0..6 {
                    for k in 0..6 {
                        q[d] = c[d][k].times_plus(r[k], q[d]);
                    }
                }
                let mut lq = [zero; 3];
                for i in 0..3 {
                    for j in 0..3 + i {
                        lq[i] = l[i][j].times_plus(q[j], lq[i]);
                    }
                }
                let mut found = [zero; 3];
                for i in 0..3 {
                    for j in 0..3 {
                        found[i] = n[i][j].times_plus(lq[j], found[i]);
                    }
                }
                for d in 0..6 {
                    for k in 0..3 {
                        q[d] = c[d][3 + k].times_plus(found[k], q[d]);
                    }
                }
                for d in 0..3 {
                    for k in 0..3 {
                        t[k] = s[d][k].times_plus(q[d], t[k]);
                    }
                }
                for d in 3..6 {
                    for k in 0..6 {
                        t[k] = s[d][k].times_plus(q[d], t[k]);
                    }
                }
            }
        })
    }

    /// A dead force at a point, to which `arm` leads from the tip's place: where the point moves by `v`, the
    /// moment about the tip's place changes by `v x f`. `y = y' + [0; p]` with `p` from three equations.
    #[inline(always)]
    fn node(&mut self, force: &Vec3<S>, arm: &Vec3<S>) {
        let (zero, one) = (Lanes::new(self.simd, 0.0), Lanes::new(self.simd, 1.0));
        let mut p = [[zero; 3]; 12];
        for c in 0..self.width {
            let t = &self.z[c];
            let lever = cross(&[t[3], t[4], t[5]], arm);
            let v = [t[0] + lever[0], t[1] + lever[1], t[2] + lever[2]];
            p[c] = cross(&v, force);
        }
        let mut n = [[zero; 3]; 3];
        for i in 0..3 {
            for k in 0..3 {
                n[i][k] = (if i == k { one } else { zero }) - p[3 + k][i];
            }
        }
        let n = self.inverse3(&n);
        let about = [self.z[3], self.z[4], self.z[5]];
        for c in 0..self.width {
            let own = p[c];
            for i in 0..3 {
                let x = dot(&n[i], &own);
                for r in 0..self.width {
                    self.z[c][r] = about[i][r].times_plus(x, self.z[c][r]);
                }
            }
        }
    }

    /// Inverse of a 3 x 3 matrix near the identity.
    #[inline(always)]
    fn inverse3(&mut self, m: &[[Lanes<S>; 3]; 3]) -> [[Lanes<S>; 3]; 3] {
        let (a, b, c) = (
            cross(&m[1], &m[2]),
            cross(&m[2], &m[0]),
            cross(&m[0], &m[1]),
        );
        let determinant = dot(&m[0], &a);
        self.regular = self.regular.least_of(determinant.abs());
        let r = determinant.same(1.0) / determinant;
        [
            [a[0] * r, b[0] * r, c[0] * r],
            [a[1] * r, b[1] * r, c[1] * r],
            [a[2] * r, b[2] * r, c[2] * r],
        ]
    }

    /// The leading block of the inverse, and the smallest relative pivot.
    #[inline(always)]
    fn inverse(&mut self, plan: &Plan) -> (Mat6<S>, Lanes<S>) {
        apart!(self.simd, {
            let (zero, one) = (Lanes::new(self.simd, 0.0), Lanes::new(self.simd, 1.0));
            if self.width > 6 {
                let found = freed(self.simd, plan, &mut self.z);
                return (found.0, self.regular.least_of(found.1));
            }
            let (mut matrix, mut inverse) = ([[zero; 6]; 6], [[zero; 6]; 6]);
            for i in 0..6 {
                inverse[i][i] = one;
                for j in 0..6 {
                    matrix[i][j] = self.z[j][i];
                }
            }
            let regular = solve_small::<S, 6, 6>(self.simd, &mut matrix, &mut inverse);
            (inverse, self.regular.least_of(regular))
        })
    }
}
