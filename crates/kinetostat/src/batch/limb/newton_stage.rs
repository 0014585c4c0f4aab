//! Elimination of one spring in Newton's iteration along a limb ([`crate::batch::limb::newton`], whose names are used here).

use pulp::Simd;

use crate::batch::limb::loaded::LoadedLimb;
use crate::batch::limb::tangent_own_weight::couples;
use crate::batch::numbers::instruction_set::apart;
use crate::batch::numbers::lanes::Lanes;
use crate::batch::numbers::vectors::{Vec3, cross, dot};
use crate::batch::numbers::wrenches::{Mat6, back, lever, shift, slid, turn};
use crate::batch::plan::steps::{Joint, OwnWeight, Spring, Support};
use crate::spatial::MotionKind;

/// A spring of several directions, eliminated: names as above.
#[derive(Clone, Copy)]
pub(crate) struct Stage<S: Simd> {
    /// `K - S^T P S - N`, factored; reciprocals on the diagonal.
    pub pivots: Mat6<S>,
    /// `P S + U`.
    pub passed_on: Mat6<S>,
    /// `X` and `x_0`.
    pub follows: Mat6<S>,
    pub free: [Lanes<S>; 6],
    /// Sines and cosines of its rotations, and its translations.
    pub turned: [[Lanes<S>; 2]; 3],
    pub slid: [Lanes<S>; 3],
}

/// Elimination of a spring of one direction.
#[derive(Clone, Copy)]
pub(crate) struct Single<S: Simd> {
    pub reciprocal: Lanes<S>,
    pub passed_on: [Lanes<S>; 6],
    pub follows: [Lanes<S>; 6],
    pub free: Lanes<S>,
    /// Sine and cosine, or length.
    pub moved: [Lanes<S>; 2],
}

impl<S: Simd> Single<S> {
    pub fn new(simd: S) -> Self {
        let zero = Lanes::new(simd, 0.0);
        Self {
            reciprocal: zero,
            passed_on: [zero; 6],
            follows: [zero; 6],
            free: zero,
            moved: [zero; 2],
        }
    }

    /// Eliminates a joint's spring: `p` is that of the frame before its motion then. `stable` becomes the smallest
    /// pivot relative to the spring's own stiffness.
    #[inline(always)]
    pub fn eliminate(
        &mut self,
        joint: &Joint,
        limb: &LoadedLimb<S>,
        force: &Vec3<S>,
        moment: &Vec3<S>,
        p: &mut Mat6<S>,
        stable: &mut Lanes<S>,
    ) {
        let (Support::Spring(c), Some((own, ratio))) = (joint.support, joint.amount.coordinate)
        else {
            return;
        };
        let zero = force[0].same(0.0);
        let mut axis = [zero; 3];
        axis[joint.axis] = zero + ratio;
        self.moved = limb.moved[joint.screw];
        let lever = cross(&axis, force);
        let (row, more) = match joint.kind {
            MotionKind::Prismatic => (joint.axis, [zero, zero, zero, lever[0], lever[1], lever[2]]),
            MotionKind::Revolute => {
                let m = cross(&axis, moment);
                let more = [lever[0], lever[1], lever[2], m[0], m[1], m[2]];
                (3 + joint.axis, more)
            }
        };
        let pivot =
            p[row][row].times_from(zero + ratio * ratio, limb.joint_stiffness(joint, own, c));
        self.reciprocal = zero.same(1.0) / pivot;
        *stable = stable.least_of(pivot * c);
        for k in 0..6 {
            self.passed_on[k] = p[k][row].times_plus(zero + ratio, more[k]);
            self.follows[k] = p[row][k] * ratio * self.reciprocal;
        }
        for r in 0..6 {
            for k in 0..6 {
                p[r][k] = self.passed_on[r].times_plus(self.follows[k], p[r][k]);
            }
        }
    }
}

impl<S: Simd> Stage<S> {
    pub fn new(simd: S) -> Self {
        let zero = Lanes::new(simd, 0.0);
        let nothing = [[zero; 6]; 6];
        Self {
            pivots: nothing,
            passed_on: nothing,
            follows: nothing,
            free: [zero; 6],
            turned: [[zero; 2]; 3],
            slid: [zero; 3],
        }
    }

    /// Eliminates a spring: wrench and `p` are those of the frame before it then. `stable` becomes the smallest
    /// pivot relative to the spring's own stiffness.
    #[inline(always)]
    pub fn eliminate(
        &mut self,
        spring: &Spring,
        limb: &LoadedLimb<S>,
        force: &mut Vec3<S>,
        moment: &mut Vec3<S>,
        p: &mut Mat6<S>,
        stable: &mut Lanes<S>,
    ) {
        self.look(spring, limb);
        for i in 0..3 {
            let k = 2 - i;
            if spring.coordinates[3 + k].is_some() {
                let [s, c] = self.turned[k];
                back(k, s, c, force, moment);
                turn(k, s, c, p);
            }
        }
        self.assemble(spring, force, moment, p);
        if let Some(own) = &spring.own_weight {
            self.bends(own, &limb.gravity[own.near]);
        }
        self.factor(spring, stable);
        for r in 0..6 {
            for i in 0..6 {
                for k in 0..6 {
                    p[r][k] = self.passed_on[r][i].times_plus(self.follows[i][k], p[r][k]);
                }
            }
        }
        for k in 0..3 {
            if spring.coordinates[k].is_some() {
                slid(k, self.slid[k], force, moment);
                shift(k, self.slid[k], p);
            }
        }
        if let Some(own) = &spring.own_weight {
            *moment = limb.leans(own, *moment, p);
        }
    }

    /// The weight of the segment turns with its near end, and bears on it by its bending.
    #[inline(always)]
    fn bends(&mut self, own: &OwnWeight, gravity: &Vec3<S>) {
        apart!(gravity[0].simd(), {
            let (zero, one) = (gravity[0].same(0.0), gravity[0].same(1.0));
            let couples = couples(own, &[[zero, one, zero], [zero, zero, one]], gravity);
            for d in 0..2 {
                for k in 0..3 {
                    let x = couples[d][k];
                    self.passed_on[3 + k][4 + d] = self.passed_on[3 + k][4 + d] + x;
                    self.follows[4 + d][3 + k] = self.follows[4 + d][3 + k] + x;
                }
            }
        });
    }

    /// Takes displacements, sines and cosines of the spring from its limb; coordinates that it does not have are zero.
    #[inline(always)]
    fn look(&mut self, spring: &Spring, limb: &LoadedLimb<S>) {
        let (zero, one) = (self.slid[0].same(0.0), self.slid[0].same(1.0));
        (self.turned, self.slid) = ([[zero, one]; 3], [zero; 3]);
        let mut screw = spring.screw;
        for d in 0..6 {
            if let Some(place) = spring.coordinates[d] {
                if d < 3 {
                    self.slid[d] = limb.coordinates[place];
                } else {
                    self.turned[d - 3] = limb.moved[screw];
                }
                screw += 1;
            }
        }
    }

    /// `K - S^T P S - N` as pivots, `P S + U` as what is passed on, `S^T P` as what follows.
    #[inline(always)]
    fn assemble(&mut self, spring: &Spring, force: &Vec3<S>, moment: &Vec3<S>, p: &Mat6<S>) {
        let (zero, one) = (force[0].same(0.0), force[0].same(1.0));
        let [second, third] = axes(&self.turned);
        // U, P S, and S^T P; then S^T (P S).
        let mut q = *p;
        for k in 0..3 {
            let mut a = [zero; 3];
            a[k] = one;
            let e = match k {
                0 => a,
                1 => second,
                _ => third,
            };
            let (lever, ef, em) = (cross(&a, force), cross(&e, force), cross(&e, moment));
            for r in 0..3 {
                self.passed_on[r][k] = zero;
                self.passed_on[3 + r][k] = lever[r];
                self.passed_on[r][3 + k] = ef[r];
                self.passed_on[3 + r][3 + k] = em[r];
            }
        }
        for r in 0..6 {
            let own = [p[r][3], p[r][4], p[r][5]];
            q[r][4] = dot(&second, &own);
            q[r][5] = dot(&third, &own);
        }
        let (mut sp, mut g) = (*p, q);
        let mut n = self.passed_on;
        for k in 0..6 {
            let (a, b, c) = (
                [p[3][k], p[4][k], p[5][k]],
                [q[3][k], q[4][k], q[5][k]],
                [n[3][k], n[4][k], n[5][k]],
            );
            (sp[4][k], sp[5][k]) = (dot(&second, &a), dot(&third, &a));
            (g[4][k], g[5][k]) = (dot(&second, &b), dot(&third, &b));
            n[4][k] = dot(&second, &c);
        }
        for i in 0..6 {
            for j in 0..6 {
                let mut x = zero.same(spring.stiffness[6 * i + j]) - g[i][j];
                if i < j && j > 2 {
                    x = x - n[i][j];
                }
                self.pivots[i][j] = x;
                self.passed_on[i][j] = self.passed_on[i][j] + q[i][j];
            }
        }
        for d in 0..6 {
            // A direction that does not move.
            if spring.coordinates[d].is_none() {
                self.pivots[d] = [zero; 6];
                self.pivots[d][d] = one;
                sp[d] = [zero; 6];
            }
        }
        self.follows = sp;
    }

    /// Factors the pivots in place and solves for what follows.
    #[inline(always)]
    fn factor(&mut self, spring: &Spring, stable: &mut Lanes<S>) {
        let one = self.slid[0].same(1.0);
        let (pivots, x) = (&mut self.pivots, &mut self.follows);
        for k in 0..6 {
            let reciprocal = one / pivots[k][k];
            let size = spring.stiffness[7 * k];
            if size > 0.0 {
                *stable = stable.least_of(pivots[k][k] * (1.0 / size));
            }
            pivots[k][k] = reciprocal;
            for i in k + 1..6 {
                let l = pivots[i][k] * reciprocal;
                pivots[i][k] = l;
                for j in k + 1..6 {
                    pivots[i][j] = l.times_from(pivots[k][j], pivots[i][j]);
                }
                for j in 0..6 {
                    x[i][j] = l.times_from(x[k][j], x[i][j]);
                }
            }
        }
        for i in (0..6).rev() {
            for k in i + 1..6 {
                for j in 0..6 {
                    x[i][j] = pivots[i][k].times_from(x[k][j], x[i][j]);
                }
            }
            for j in 0..6 {
                x[i][j] = x[i][j] * pivots[i][i];
            }
        }
    }
}

/// Axes of the second and third rotation of a spring, in the axes before the first.
#[inline(always)]
pub(crate) fn axes<S: Simd>(turned: &[[Lanes<S>; 2]; 3]) -> [Vec3<S>; 2] {
    let [[s1, c1], [s2, c2], _] = *turned;
    let zero = s1.same(0.0);
    [[zero, c1, s1], [s2, -(s1 * c2), c1 * c2]]
}

/// A dead force at a point: `df = hat(f) w`, with its lever `at`.
#[inline(always)]
pub(crate) fn weighs<S: Simd>(at: &[f64; 3], f: &Vec3<S>, p: &mut Mat6<S>) {
    let zero = f[0].same(0.0);
    // Columns of hat(f): f x e.
    let columns = [
        [zero, f[2], -f[1]],
        [-f[2], zero, f[0]],
        [f[1], -f[0], zero],
    ];
    for k in 0..3 {
        let mut turned = [zero; 3];
        lever(at, &columns[k], &mut turned);
        for r in 0..3 {
            p[r][3 + k] = p[r][3 + k] + columns[k][r];
            p[3 + r][3 + k] = p[3 + r][3 + k] + turned[r];
        }
    }
}

/// A dead moment: `dm = hat(m) w`.
#[inline(always)]
pub(crate) fn turns<S: Simd>(m: &Vec3<S>, p: &mut Mat6<S>) {
    let zero = m[0].same(0.0);
    let columns = [
        [zero, m[2], -m[1]],
        [-m[2], zero, m[0]],
        [m[1], -m[0], zero],
    ];
    for k in 0..3 {
        for r in 0..3 {
            p[3 + r][3 + k] = p[3 + r][3 + k] + columns[k][r];
        }
    }
}
