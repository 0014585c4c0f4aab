//! Newton's iteration for a serial limb under load, several postures at once: for loads under which
//! `theta <- K^-1 tau(theta)` does not contract.
//!
//! One pass back and one pass out per step, at a cost that grows with the number of springs and no
//! faster. In the axes and about the origin of every frame, with `t` its motion in the step and `w =
//! (f, m)` the wrench of what lies beyond, the pass back carries `dw = P t + y`. At the tip, a dead wrench
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
//! Steps are accepted by motion (Deuflhard's restricted natural monotonicity, as in
//! [`crate::chain::equilibrium`]): the step that the same matrices want where a step has led must be shorter.

use pulp::Simd;

use crate::batch::limb::law;
use crate::batch::limb::loaded::LoadedLimb;
use crate::batch::limb::newton_stage::{Single, Stage, axes, turns, weighs};
use crate::batch::numbers::instruction_set::apart;
use crate::batch::numbers::lanes::Lanes;
use crate::batch::numbers::vectors::{component, dot, select};
use crate::batch::numbers::wrenches::{
    back, lever, rotate, rotated_back, shift, slid, times, turn,
};
use crate::batch::plan::steps::{Plan, Step, Support};
use crate::spatial::MotionKind;

/// Steps, and shortenings of one, after which a lane is given up.
const MOST_STEPS: usize = 25;
const MOST_TRIALS: usize = 10;
/// A step shorter than this share of all deflections is the last one.
const LAST_STEP: f64 = 1e-10;

/// Buffers of the iteration.
pub(crate) struct Newton<S: Simd> {
    stages: Vec<Stage<S>>,
    singles: Vec<Single<S>>,
    /// Coordinates where the step begins, the step, and the next one that the same matrices want.
    at: Vec<Lanes<S>>,
    step: Vec<Lanes<S>>,
    next: Vec<Lanes<S>>,
    /// Residual torques of the springs: `tau - K theta`.
    residual: Vec<Lanes<S>>,
    /// Smallest pivot relative to the springs' own stiffness: above zero where the chain is stable.
    stable: Lanes<S>,
    simd: S,
}

impl<S: Simd> Newton<S> {
    /// Buffers.
    pub fn new(simd: S, plan: &Plan) -> Self {
        let zero = Lanes::new(simd, 0.0);
        let springs = plan.steps.iter().filter(|s| matches!(s, Step::Spring(_)));
        let singles = plan
            .steps
            .iter()
            .filter(|s| matches!(s, Step::Joint(j) if matches!(j.support, Support::Spring(_))));
        Self {
            stages: vec![Stage::new(simd); springs.count()],
            singles: vec![Single::new(simd); singles.count()],
            at: vec![zero; plan.coordinates],
            step: vec![zero; plan.coordinates],
            next: vec![zero; plan.coordinates],
            residual: vec![zero; plan.coordinates],
            stable: zero,
            simd,
        }
    }

    /// Equilibrium of the limb under its wrench, from the unloaded limb, in the lanes where `wanted`
    /// is one; the others stay. One in the lanes that are in stable equilibrium now.
    #[inline(always)]
    pub fn converge(
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
            self.update_residual(plan, limb);
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
                    self.update_residual(plan, limb);
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

    /// Residual torques of the springs where the limb is.
    #[inline(always)]
    fn update_residual(&mut self, plan: &Plan, limb: &LoadedLimb<S>) {
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
                        if let (Support::Spring(c), Some((own, ratio))) =
                            (joint.support, joint.amount.coordinate)
                        {
                            let x = limb.coordinates[own];
                            self.residual[own] = match &joint.law {
                                Some(law) => torque * ratio - law::single_torque(law, x),
                                None => x.times_from(x.same(1.0 / c), torque * ratio),
                            };
                        }
                    }
                    Step::Spring(spring) => {
                        let mut torque = limb.spring_bears(spring, &mut force, &mut moment);
                        limb.own_weight(spring, &mut torque, &mut moment);
                        let mut x = [torque[0].same(0.0); 6];
                        for d in 0..6 {
                            if let Some(own) = spring.coordinates[d] {
                                x[d] = limb.coordinates[own];
                            }
                        }
                        let borne = times(&spring.stiffness, &x);
                        for d in 0..6 {
                            if let Some(own) = spring.coordinates[d] {
                                self.residual[own] = torque[d] - borne[d];
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
                        if let Support::Spring(_) = joint.support {
                            single -= 1;
                            let own = &mut self.singles[single];
                            own.eliminate(joint, limb, &force, &moment, &mut p, &mut self.stable);
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
                        let own = &mut self.stages[stage];
                        own.eliminate(
                            spring,
                            limb,
                            &mut force,
                            &mut moment,
                            &mut p,
                            &mut self.stable,
                        );
                    }
                }
            }
        })
    }

    /// The step that removes the residual torques of the springs.
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
                        if let (Support::Spring(_), Some((own, ratio))) =
                            (joint.support, joint.amount.coordinate)
                        {
                            single -= 1;
                            let residual = self.residual[own];
                            let this = &mut self.singles[single];
                            moved = this.moved;
                            let y = match joint.kind {
                                MotionKind::Prismatic => component(&force, joint.axis),
                                MotionKind::Revolute => component(&moment, joint.axis),
                            };
                            this.free = y.times_plus(y.same(ratio), residual) * this.reciprocal;
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
                                Some(place) => x[d] + self.residual[place],
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

    /// The pass out: motions of all springs.
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
                        let spring = match (joint.support, joint.amount.coordinate) {
                            (Support::Spring(_), Some(own)) => Some(own),
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
