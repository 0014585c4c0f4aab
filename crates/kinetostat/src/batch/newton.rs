//! Newton's iteration for a serial limb under load, several postures at once: for loads under which
//! `theta <- K^-1 tau(theta)` does not contract.
//!
//! One walk back and one walk out per step, at a cost that grows with the number of springs and no
//! faster. In the axes and about the origin of every frame, with `t` its motion in the step and `w =
//! (f, m)` the wrench of what lies beyond, the walk back carries `dw = P t + y`. At the tip, a dead wrench
//! turns against the frame: `df = hat(f) w`, `dm = hat(m) w`; so do weights. Along a spring of
//! coordinates `x` with twists `S` (axes of the frame before, about the point after its translations)
//!
//! ```text
//! t = t' + S x,    dw = P t + y + U x,    U = [0, e x f; a x f, e x m]    (a, e: axes of the columns of S)
//! (K - S^T P S - N) x = S^T (P t' + y) + r        N: S^T U above the diagonal,   r = tau - K theta
//! P' = P + (P S + U) X,    y' = y + (P S + U) x_0        where x = X t' + x_0
//! ```
//!
//! `U` is how the wrench turns with the spring, and how its lever grows. A later rotation turns about an axis that the earlier
//! ones have turned, which takes away the part of `S^T U` below the diagonal.
//!
//! Steps are judged by motion (Deuflhard's restricted natural monotonicity, as in
//! [`crate::chain::equilibrium`]): the step that the same matrices want where a step has led must be shorter.

use pulp::Simd;

use super::apart::apart;
use super::lanes::{Lanes, Vec3, cross, dot};
use super::loaded::{LoadedLimb, back, component, lever, rotated_back, select, slid, times};
use super::plan::{Held, Joint, Plan, Spring, Step};
use super::unloaded::matrix;
use crate::spatial::MotionKind;

/// Steps, and shortenings of one, after which a lane is given up.
const MOST_STEPS: usize = 25;
const MOST_TRIALS: usize = 10;
/// A step shorter than this share of all deflections is the last one.
const LAST_STEP: f64 = 1e-10;

type Mat6<S> = [[Lanes<S>; 6]; 6];

/// A spring of several directions, eliminated: names as above.
#[derive(Clone, Copy)]
struct Stage<S: Simd> {
    /// `K - S^T P S - N`, factored; reciprocals on the diagonal.
    pivots: Mat6<S>,
    /// `P S + U`.
    passed_on: Mat6<S>,
    /// `X` and `x_0`.
    follows: Mat6<S>,
    free: [Lanes<S>; 6],
    /// Sines and cosines of its rotations, and its translations.
    turned: [[Lanes<S>; 2]; 3],
    slid: [Lanes<S>; 3],
}

/// The same for a spring of one direction.
#[derive(Clone, Copy)]
struct Single<S: Simd> {
    reciprocal: Lanes<S>,
    passed_on: [Lanes<S>; 6],
    follows: [Lanes<S>; 6],
    free: Lanes<S>,
    /// Sine and cosine, or length.
    moved: [Lanes<S>; 2],
}

/// Buffers of the iteration.
pub(super) struct Newton<S: Simd> {
    stages: Vec<Stage<S>>,
    singles: Vec<Single<S>>,
    /// Coordinates where the step begins, the step, and the next one that the same matrices want.
    at: Vec<Lanes<S>>,
    step: Vec<Lanes<S>>,
    next: Vec<Lanes<S>>,
    /// What the springs lack: `tau - K theta`.
    lacks: Vec<Lanes<S>>,
    /// Smallest pivot relative to the springs' own stiffness: above zero where the chain is stable.
    stable: Lanes<S>,
    simd: S,
}

impl<S: Simd> Newton<S> {
    /// Buffers.
    pub fn new(simd: S, plan: &Plan) -> Self {
        let zero = Lanes::new(simd, 0.0);
        let nothing = [[zero; 6]; 6];
        let stage = Stage {
            pivots: nothing,
            passed_on: nothing,
            follows: nothing,
            free: [zero; 6],
            turned: [[zero; 2]; 3],
            slid: [zero; 3],
        };
        let single = Single {
            reciprocal: zero,
            passed_on: [zero; 6],
            follows: [zero; 6],
            free: zero,
            moved: [zero; 2],
        };
        let springs = plan.steps.iter().filter(|s| matches!(s, Step::Spring(_)));
        let singles = plan
            .steps
            .iter()
            .filter(|s| matches!(s, Step::Joint(j) if matches!(j.held, Held::Spring(_))));
        Self {
            stages: vec![stage; springs.count()],
            singles: vec![single; singles.count()],
            at: vec![zero; plan.coordinates],
            step: vec![zero; plan.coordinates],
            next: vec![zero; plan.coordinates],
            lacks: vec![zero; plan.coordinates],
            stable: zero,
            simd,
        }
    }

    /// Equilibrium of the limb under its wrench, from the unloaded limb, in the lanes where `wanted`
    /// is one; the others stay. One in the lanes that are in stable equilibrium now.
    #[inline(always)]
    pub fn settle(
        &mut self,
        plan: &Plan,
        limb: &mut LoadedLimb<S>,
        gravity: &[f64; 3],
        wanted: Lanes<S>,
    ) -> Lanes<S> {
        apart!(self.simd, {
            let zero = Lanes::new(self.simd, 0.0);
            let one = Lanes::new(self.simd, 1.0);
            for k in 0..plan.coordinates {
                self.at[k] = select(wanted, zero, limb.coordinates[k]);
                limb.coordinates[k] = self.at[k];
            }
            (limb.bent, limb.far) = (true, Some(wanted));
            limb.outwards(plan, gravity);
            self.miss(plan, limb);
            let (mut active, mut done, mut share) = (wanted, zero, one);
            for _ in 0..MOST_STEPS {
                self.factor(plan, limb);
                self.answer(plan, limb);
                std::mem::swap(&mut self.step, &mut self.next);
                let whole = self.square(plan, one, zero);
                // Lanes whose step is good.
                let mut good = one - active;
                for _ in 0..MOST_TRIALS {
                    for k in 0..plan.coordinates {
                        let to = self.step[k].times_plus(share, self.at[k]);
                        limb.coordinates[k] = select(active, to, self.at[k]);
                    }
                    limb.outwards(plan, gravity);
                    self.miss(plan, limb);
                    self.answer(plan, limb);
                    let left = self.square(plan, zero, one);
                    let most = share.times_from(one * 0.25, one);
                    good = (most * most * whole).where_less(left, good, one);
                    if (one - good).all_less(0.5) {
                        break;
                    }
                    // Second order: `next = (1 - share) step + share^2 curvature`.
                    let bent = self.square(plan, share - 1.0, one).sqrt();
                    let shorter = share * share * whole.sqrt() / (bent * 2.0);
                    let shorter = shorter.max(share * 0.1);
                    let most = share * 0.7;
                    let shorter = shorter.where_less(most, shorter, most);
                    share = select(good, share, shorter);
                }
                active = active * good;
                let left = self.square(plan, zero, one);
                let mut size = zero;
                for k in 0..plan.coordinates {
                    self.at[k] = select(active, limb.coordinates[k], self.at[k]);
                    let x = self.at[k] * plan.units[k];
                    size = x.times_plus(x, size);
                }
                let near = size * (LAST_STEP * LAST_STEP);
                let last = active * near.where_less(left, zero, one);
                for k in 0..plan.coordinates {
                    let to = self.at[k] + self.next[k];
                    self.at[k] = select(last, to, self.at[k]);
                }
                let stable = zero.where_less(self.stable, one, zero);
                done = done + last * stable;
                active = active * (one - last);
                if active.all_less(0.5) {
                    break;
                }
                let longer = share * 2.5;
                share = longer.where_less(one, longer, one);
            }
            limb.coordinates.copy_from_slice(&self.at);
            limb.outwards(plan, gravity);
            done
        })
    }

    /// Square of `a * step + b * next`, translations as shares of the natural length.
    #[inline(always)]
    fn square(&self, plan: &Plan, a: Lanes<S>, b: Lanes<S>) -> Lanes<S> {
        let mut sum = Lanes::new(self.simd, 0.0);
        for k in 0..plan.coordinates {
            let x = a.times_plus(self.step[k], b * self.next[k]) * plan.units[k];
            sum = x.times_plus(x, sum);
        }
        sum
    }

    /// What the springs lack where the limb is.
    #[inline(always)]
    fn miss(&mut self, plan: &Plan, limb: &LoadedLimb<S>) {
        apart!(self.simd, {
            let (mut force, mut moment) = limb.at_tip();
            let mut mass = limb.gravity.len();
            for step in plan.steps.iter().rev() {
                match step {
                    Step::Mass { at, mass: m } => {
                        mass -= 1;
                        limb.weight(mass, at, *m, &mut force, &mut moment);
                    }
                    Step::Shift(l) => lever(l, &force, &mut moment),
                    Step::Rotate(by) => rotated_back(self.simd, by, &mut force, &mut moment),
                    Step::Joint(joint) => {
                        let torque = limb.joint_bears(joint, &mut force, &mut moment);
                        if let (Held::Spring(c), Some((own, ratio))) =
                            (joint.held, joint.amount.coordinate)
                        {
                            let x = limb.coordinates[own];
                            self.lacks[own] = x.times_from(x.same(1.0 / c), torque * ratio);
                        }
                    }
                    Step::Spring(spring) => {
                        let torque = limb.spring_bears(spring, &mut force, &mut moment);
                        let mut x = [torque[0].same(0.0); 6];
                        for d in 0..6 {
                            if let Some(own) = spring.coordinates[d] {
                                x[d] = limb.coordinates[own];
                            }
                        }
                        let borne = times(&spring.stiffness, &x);
                        for d in 0..6 {
                            if let Some(own) = spring.coordinates[d] {
                                self.lacks[own] = torque[d] - borne[d];
                            }
                        }
                    }
                }
            }
        })
    }

    /// Eliminates the springs where the limb is.
    #[inline(always)]
    fn factor(&mut self, plan: &Plan, limb: &LoadedLimb<S>) {
        apart!(self.simd, {
            self.stable = Lanes::new(self.simd, 1.0);
            let zero = Lanes::new(self.simd, 0.0);
            let (mut force, mut moment) = limb.at_tip();
            let mut p = [[zero; 6]; 6];
            let none = [0.0; 3];
            weighs(&none, &force, &mut p);
            turns(&moment, &mut p);
            let (mut mass, mut stage) = (limb.gravity.len(), self.stages.len());
            let mut single = self.singles.len();
            for step in plan.steps.iter().rev() {
                match step {
                    Step::Mass { at, mass: m } => {
                        mass -= 1;
                        let weight = limb.weight(mass, at, *m, &mut force, &mut moment);
                        weighs(at, &weight, &mut p);
                    }
                    Step::Shift(l) => {
                        lever(l, &force, &mut moment);
                        for k in 0..3 {
                            if l[k] != 0.0 {
                                shift(k, zero.same(l[k]), &mut p);
                            }
                        }
                    }
                    Step::Rotate(by) => {
                        rotated_back(self.simd, by, &mut force, &mut moment);
                        rotate(self.simd, by, &mut p);
                    }
                    Step::Joint(joint) => {
                        if let Held::Spring(_) = joint.held {
                            single -= 1;
                            self.single(single, joint, limb, &force, &moment, &mut p);
                        }
                        limb.joint_bears(joint, &mut force, &mut moment);
                        let [s, c] = limb.moved[joint.screw];
                        match joint.kind {
                            MotionKind::Revolute => turn(joint.axis, s, c, &mut p),
                            MotionKind::Prismatic => shift(joint.axis, s, &mut p),
                        }
                    }
                    Step::Spring(spring) => {
                        stage -= 1;
                        self.stage(stage, spring, limb, &mut force, &mut moment, &mut p);
                    }
                }
            }
        })
    }

    #[inline(always)]
    fn single(
        &mut self,
        single: usize,
        joint: &Joint,
        limb: &LoadedLimb<S>,
        force: &Vec3<S>,
        moment: &Vec3<S>,
        p: &mut Mat6<S>,
    ) {
        let (Held::Spring(c), Some((_, ratio))) = (joint.held, joint.amount.coordinate) else {
            return;
        };
        let zero = Lanes::new(self.simd, 0.0);
        let mut axis = [zero; 3];
        axis[joint.axis] = zero + ratio;
        let own = &mut self.singles[single];
        own.moved = limb.moved[joint.screw];
        let lever = cross(&axis, force);
        let (row, more) = match joint.kind {
            MotionKind::Prismatic => (joint.axis, [zero, zero, zero, lever[0], lever[1], lever[2]]),
            MotionKind::Revolute => {
                let m = cross(&axis, moment);
                let more = [lever[0], lever[1], lever[2], m[0], m[1], m[2]];
                (3 + joint.axis, more)
            }
        };
        let pivot = p[row][row].times_from(zero + ratio * ratio, zero + 1.0 / c);
        own.reciprocal = zero.same(1.0) / pivot;
        self.stable = self.stable.least_of(pivot * c);
        for k in 0..6 {
            own.passed_on[k] = p[k][row].times_plus(zero + ratio, more[k]);
            own.follows[k] = p[row][k] * ratio * own.reciprocal;
        }
        for r in 0..6 {
            for k in 0..6 {
                p[r][k] = own.passed_on[r].times_plus(own.follows[k], p[r][k]);
            }
        }
    }

    #[inline(always)]
    fn stage(
        &mut self,
        stage: usize,
        spring: &Spring,
        limb: &LoadedLimb<S>,
        force: &mut Vec3<S>,
        moment: &mut Vec3<S>,
        p: &mut Mat6<S>,
    ) {
        let (zero, one) = (Lanes::new(self.simd, 0.0), Lanes::new(self.simd, 1.0));
        let own = &mut self.stages[stage];
        (own.turned, own.slid) = ([[zero, one]; 3], [zero; 3]);
        let mut screw = spring.screw;
        for d in 0..6 {
            if let Some(place) = spring.coordinates[d] {
                if d < 3 {
                    own.slid[d] = limb.coordinates[place];
                } else {
                    own.turned[d - 3] = limb.moved[screw];
                }
                screw += 1;
            }
        }
        for i in 0..3 {
            let k = 2 - i;
            if spring.coordinates[3 + k].is_some() {
                let [s, c] = own.turned[k];
                back(k, s, c, force, moment);
                turn(k, s, c, p);
            }
        }
        let [second, third] = axes(&own.turned);
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
                own.passed_on[r][k] = zero;
                own.passed_on[3 + r][k] = lever[r];
                own.passed_on[r][3 + k] = ef[r];
                own.passed_on[3 + r][3 + k] = em[r];
            }
        }
        for r in 0..6 {
            let own = [p[r][3], p[r][4], p[r][5]];
            q[r][4] = dot(&second, &own);
            q[r][5] = dot(&third, &own);
        }
        let (mut sp, mut g) = (*p, q);
        let mut n = own.passed_on;
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
                own.pivots[i][j] = x;
                own.passed_on[i][j] = own.passed_on[i][j] + q[i][j];
            }
        }
        for d in 0..6 {
            // A direction that does not move.
            if spring.coordinates[d].is_none() {
                own.pivots[d] = [zero; 6];
                own.pivots[d][d] = one;
                sp[d] = [zero; 6];
            }
        }
        for k in 0..6 {
            let reciprocal = one / own.pivots[k][k];
            let size = spring.stiffness[7 * k];
            if size > 0.0 {
                self.stable = self.stable.least_of(own.pivots[k][k] * (1.0 / size));
            }
            own.pivots[k][k] = reciprocal;
            for i in k + 1..6 {
                let l = own.pivots[i][k] * reciprocal;
                own.pivots[i][k] = l;
                for j in k + 1..6 {
                    own.pivots[i][j] = l.times_from(own.pivots[k][j], own.pivots[i][j]);
                }
                for j in 0..6 {
                    sp[i][j] = l.times_from(sp[k][j], sp[i][j]);
                }
            }
        }
        for i in (0..6).rev() {
            for k in i + 1..6 {
                for j in 0..6 {
                    sp[i][j] = own.pivots[i][k].times_from(sp[k][j], sp[i][j]);
                }
            }
            for j in 0..6 {
                sp[i][j] = sp[i][j] * own.pivots[i][i];
            }
        }
        own.follows = sp;
        for r in 0..6 {
            for i in 0..6 {
                for k in 0..6 {
                    p[r][k] = own.passed_on[r][i].times_plus(sp[i][k], p[r][k]);
                }
            }
        }
        for k in 0..3 {
            if spring.coordinates[k].is_some() {
                slid(k, own.slid[k], force, moment);
                shift(k, own.slid[k], p);
            }
        }
    }

    /// The step that takes away what the springs lack.
    #[inline(always)]
    fn answer(&mut self, plan: &Plan, limb: &LoadedLimb<S>) {
        apart!(self.simd, {
            let zero = Lanes::new(self.simd, 0.0);
            let (mut force, mut moment) = ([zero; 3], [zero; 3]);
            let (mut stage, mut single) = (self.stages.len(), self.singles.len());
            for step in plan.steps.iter().rev() {
                match step {
                    Step::Mass { .. } => {}
                    Step::Shift(l) => lever(l, &force, &mut moment),
                    Step::Rotate(by) => rotated_back(self.simd, by, &mut force, &mut moment),
                    Step::Joint(joint) => {
                        let mut moved = limb.moved[joint.screw];
                        if let (Held::Spring(_), Some((own, ratio))) =
                            (joint.held, joint.amount.coordinate)
                        {
                            single -= 1;
                            let lacks = self.lacks[own];
                            let this = &mut self.singles[single];
                            moved = this.moved;
                            let y = match joint.kind {
                                MotionKind::Prismatic => component(&force, joint.axis),
                                MotionKind::Revolute => component(&moment, joint.axis),
                            };
                            this.free = y.times_plus(y.same(ratio), lacks) * this.reciprocal;
                            for k in 0..3 {
                                force[k] = this.passed_on[k].times_plus(this.free, force[k]);
                                moment[k] = this.passed_on[3 + k].times_plus(this.free, moment[k]);
                            }
                        }
                        let [s, c] = moved;
                        match joint.kind {
                            MotionKind::Revolute => back(joint.axis, s, c, &mut force, &mut moment),
                            MotionKind::Prismatic => slid(joint.axis, s, &force, &mut moment),
                        }
                    }
                    Step::Spring(spring) => {
                        stage -= 1;
                        let own = &mut self.stages[stage];
                        for i in 0..3 {
                            let k = 2 - i;
                            let [s, c] = own.turned[k];
                            back(k, s, c, &mut force, &mut moment);
                        }
                        let [second, third] = axes(&own.turned);
                        let mut x = [
                            force[0],
                            force[1],
                            force[2],
                            moment[0],
                            dot(&second, &moment),
                            dot(&third, &moment),
                        ];
                        for d in 0..6 {
                            x[d] = match spring.coordinates[d] {
                                Some(place) => x[d] + self.lacks[place],
                                None => zero,
                            };
                        }
                        for i in 1..6 {
                            for k in 0..i {
                                x[i] = own.pivots[i][k].times_from(x[k], x[i]);
                            }
                        }
                        for i in (0..6).rev() {
                            for k in i + 1..6 {
                                x[i] = own.pivots[i][k].times_from(x[k], x[i]);
                            }
                            x[i] = x[i] * own.pivots[i][i];
                        }
                        own.free = x;
                        for i in 0..6 {
                            for k in 0..3 {
                                force[k] = own.passed_on[k][i].times_plus(x[i], force[k]);
                                moment[k] = own.passed_on[3 + k][i].times_plus(x[i], moment[k]);
                            }
                        }
                        for k in 0..3 {
                            slid(k, own.slid[k], &force, &mut moment);
                        }
                    }
                }
            }
            self.motions(plan, limb);
        })
    }

    /// The walk out: motions of all springs.
    #[inline(always)]
    fn motions(&mut self, plan: &Plan, limb: &LoadedLimb<S>) {
        apart!(self.simd, {
            let zero = Lanes::new(self.simd, 0.0);
            let (mut v, mut w) = ([zero; 3], [zero; 3]);
            let (mut stage, mut single) = (0, 0);
            for step in &plan.steps {
                match step {
                    Step::Mass { .. } => {}
                    // `v + w x l`.
                    Step::Shift(l) => lever(&[-l[0], -l[1], -l[2]], &w, &mut v),
                    Step::Rotate(by) => {
                        let transposed = [
                            by[0], by[3], by[6], by[1], by[4], by[7], by[2], by[5], by[8],
                        ];
                        rotated_back(self.simd, &transposed, &mut v, &mut w);
                    }
                    Step::Joint(joint) => {
                        let spring = match (joint.held, joint.amount.coordinate) {
                            (Held::Spring(_), Some(own)) => Some(own),
                            _ => None,
                        };
                        let [s, c] = match spring {
                            Some(_) => self.singles[single].moved,
                            None => limb.moved[joint.screw],
                        };
                        match joint.kind {
                            MotionKind::Revolute => back(joint.axis, -s, c, &mut v, &mut w),
                            MotionKind::Prismatic => slid(joint.axis, -s, &w, &mut v),
                        }
                        if let Some((own, ratio)) = spring {
                            let this = &self.singles[single];
                            single += 1;
                            let mut x = this.free;
                            for k in 0..3 {
                                x = this.follows[k].times_plus(v[k], x);
                                x = this.follows[3 + k].times_plus(w[k], x);
                            }
                            self.next[own] = x;
                            let along = match joint.kind {
                                MotionKind::Prismatic => &mut v,
                                MotionKind::Revolute => &mut w,
                            };
                            for k in 0..3 {
                                if k == joint.axis {
                                    along[k] = x.times_plus(x.same(ratio), along[k]);
                                }
                            }
                        }
                    }
                    Step::Spring(spring) => {
                        let own = &self.stages[stage];
                        stage += 1;
                        for k in 0..3 {
                            slid(k, -own.slid[k], &w, &mut v);
                        }
                        let mut x = own.free;
                        for i in 0..6 {
                            for k in 0..3 {
                                x[i] = own.follows[i][k].times_plus(v[k], x[i]);
                                x[i] = own.follows[i][3 + k].times_plus(w[k], x[i]);
                            }
                        }
                        for d in 0..6 {
                            if let Some(place) = spring.coordinates[d] {
                                self.next[place] = x[d];
                            }
                        }
                        let [second, third] = axes(&own.turned);
                        w[0] = w[0] + x[3];
                        for k in 0..3 {
                            v[k] = v[k] + x[k];
                            w[k] = third[k].times_plus(x[5], second[k].times_plus(x[4], w[k]));
                        }
                        for k in 0..3 {
                            let [s, c] = own.turned[k];
                            back(k, -s, c, &mut v, &mut w);
                        }
                    }
                }
            }
        })
    }
}

/// Axes of the second and third rotation of a spring, in the axes before the first.
#[inline(always)]
fn axes<S: Simd>(turned: &[[Lanes<S>; 2]; 3]) -> [Vec3<S>; 2] {
    let [[s1, c1], [s2, c2], _] = *turned;
    let zero = s1.same(0.0);
    [[zero, c1, s1], [s2, -(s1 * c2), c1 * c2]]
}

/// A dead force at a point: `df = hat(f) w`, with its lever `at`.
#[inline(always)]
fn weighs<S: Simd>(at: &[f64; 3], f: &Vec3<S>, p: &mut Mat6<S>) {
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
fn turns<S: Simd>(m: &Vec3<S>, p: &mut Mat6<S>) {
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

/// `P` in the axes before a rotation about one of them: `Q P Q^T`.
#[inline(always)]
fn turn<S: Simd>(axis: usize, s: Lanes<S>, c: Lanes<S>, p: &mut Mat6<S>) {
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
fn shift<S: Simd>(axis: usize, l: Lanes<S>, p: &mut Mat6<S>) {
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
fn rotate<S: Simd>(simd: S, by: &[f64; 9], p: &mut Mat6<S>) {
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
