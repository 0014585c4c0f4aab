//! Equilibrium of a platform that several limbs hold: wrenches, passive joints and the platform are
//! corrected in each pass by the unloaded machine's own compliance ([`crate::batch::machine::corrector`]).
//!
//! A pass is one step of Newton's iteration with the tangent of the unloaded machine, so that it contracts by the
//! share of the way to buckling with the limbs' ends attached. That holds only if tip, torques and springs are of one
//! state: springs go along with a change of their wrench in the outward half ([`crate::batch::limb::outwards`]), and what they
//! follow in the inward half moves the tip at once ([`crate::batch::limb::inwards`]). Springs that follow a pass later, and with
//! their end free, make it the root of that share, or the share of a free end: on the orthoglide under 215 N a third
//! per pass instead of a twelfth.

use pulp::Simd;

use crate::batch::limb::loaded::{MOST_PASSES, MOST_TURN};
use crate::batch::limb::tangent;
use crate::batch::machine::group::REGULAR;
use crate::batch::machine::loaded::{Machine, PlatformMass};
use crate::batch::numbers::instruction_set::apart;
use crate::batch::numbers::lanes::Lanes;
use crate::batch::numbers::symmetric::{AT, Symmetric};
use crate::batch::numbers::vectors::{
    carried, constant, cross, dot, minus, select, turn_between, turned,
};
use crate::batch::numbers::wrenches::Mat6;
use crate::spatial::Directions;

impl<S: Simd> Machine<S> {
    /// Equilibrium under a dead wrench at the platform's point, with the tool at its place in these directions, if there are any: one in the
    /// lanes that are done.
    #[inline(always)]
    pub fn converge_platform(
        &mut self,
        simd: S,
        wrench: &[Lanes<S>; 6],
        directions: Option<Directions>,
        good: Lanes<S>,
    ) -> Lanes<S> {
        let (zero, one) = (Lanes::new(simd, 0.0), Lanes::new(simd, 1.0));
        let mut active = (zero + REGULAR).where_less(good, one, zero);
        let mut away = zero;
        for pass in 0..MOST_PASSES {
            let mut moving = self.pass(simd, wrench, active, pass == 0);
            if let Some(directions) = directions {
                let on;
                (on, away) = self.correct_between_passes(simd, directions, active, away);
                moving = moving.max(on);
            }
            active = moving;
            if active.all_less(0.5) {
                break;
            }
        }
        let mut done = good * (one - active);
        for (limb, plan) in self.limbs.iter_mut().zip(self.actual.iter()) {
            // The last pass has moved the passive joints.
            limb.outwards(plan, &self.gravity);
            done = done * limb.sound(plan, MOST_TURN);
        }
        done
    }

    /// One pass in the lanes where `active` is one: one in those that go on.
    #[inline(always)]
    fn pass(&mut self, simd: S, wrench: &[Lanes<S>; 6], active: Lanes<S>, first: bool) -> Lanes<S> {
        apart!(simd, {
            let (zero, one) = (Lanes::new(simd, 0.0), Lanes::new(simd, 1.0));
            let mut moving = zero;
            let looks_ahead = self.precision.ahead > 1.0;
            // The unbalanced wrench, to first order, with the platform where it is.
            let mut unbalanced = self.borne(simd, wrench);
            let limbs = self.limbs.iter_mut().zip(self.actual.iter());
            for ((limb, plan), attached) in limbs.zip(&mut self.attached) {
                // Nothing has changed before the first pass, and the tip is still that of another posture.
                match first {
                    true => {
                        attached.last = [zero; 2];
                        limb.outwards(plan, &self.gravity);
                    }
                    false => {
                        limb.outwards_after(plan, &self.gravity, &attached.change.wrench, active);
                    }
                }
                limb.clear(plan);
                let gone = limb.inwards_moving(plan, active);
                let l = minus(&self.point, &limb.point);
                let a = turn_between(&self.rotation, &limb.rotation);
                let mut residual = [l[0], l[1], l[2], a[0], a[1], a[2]];
                for k in 0..6 {
                    residual[k] = residual[k] - gone[k];
                }
                if looks_ahead {
                    let mut off = zero;
                    for k in 0..6 {
                        let share = residual[k] * if k < 3 { 1.0 / plan.length } else { 1.0 };
                        off = share.times_plus(share, off);
                    }
                    let most = zero + self.precision.place * self.precision.place;
                    moving = moving.max(self.precision.goes_on(off, attached.last[0], most));
                    attached.last[0] = off;
                } else {
                    for k in 0..6 {
                        let unit = if k < 3 { plan.length } else { 1.0 };
                        let most = self.precision.place * unit;
                        moving = (one * most).where_less(residual[k].abs(), one, moving);
                    }
                }
                // Rounding of the torque on every coordinate, N or N m.
                let torques = attached.noise * attached.noise * (limb.coordinates.len() as f64);
                let rounding = torques * (1.0 + 1.0 / (plan.length * plan.length));
                moving = moving.max(limb.moving(rounding, &self.precision));
                attached.change = attached.corrector.of_motion(&residual);
                let mut torque = [zero; 6];
                for (x, own) in torque.iter_mut().zip(&plan.passive) {
                    *x = -limb.torque[*own];
                }
                attached
                    .corrector
                    .add_of_torque(&torque, &mut attached.change);
                for k in 0..6 {
                    unbalanced[k] = unbalanced[k] - limb.wrench[k] - attached.change.wrench[k];
                }
            }
            let motion = self.compliance.times(&unbalanced);
            let share = self.precision.torque;
            let limbs = self.limbs.iter_mut().zip(self.actual.iter());
            for ((limb, plan), attached) in limbs.zip(&mut self.attached) {
                let along = attached.corrector.of_motion(&motion);
                let (mut change, mut size) = (zero, zero);
                for k in 0..6 {
                    let unit = if k < 3 { plan.length } else { 1.0 };
                    let step = attached.change.wrench[k] + along.wrench[k];
                    let to = limb.wrench[k] + step;
                    let (x, w) = (step * unit, to * unit);
                    change = x.times_plus(x, change);
                    size = w.times_plus(w, size);
                    attached.change.wrench[k] = step;
                    limb.wrench[k] = select(active, to, limb.wrench[k]);
                }
                // Wrenches from a residual of rounding are rounding too: limbs that brace each other know their
                // internal forces no better.
                let allowed = (size * (share * share)).max(attached.noise * attached.noise);
                moving = match looks_ahead {
                    true => moving.max(self.precision.goes_on(change, attached.last[1], allowed)),
                    false => allowed.where_less(change, one, moving),
                };
                attached.last[1] = change;
                for (k, own) in plan.passive.iter().enumerate() {
                    let x = limb.coordinates[*own];
                    let to = x + attached.change.joints[k] + along.joints[k];
                    limb.coordinates[*own] = select(active, to, x);
                }
            }
            let turned = turned(&[motion[3], motion[4], motion[5]], &self.rotation);
            for k in 0..3 {
                self.point[k] = select(active, self.point[k] + motion[k], self.point[k]);
            }
            for k in 0..9 {
                self.rotation[k] = select(active, turned[k], self.rotation[k]);
            }
            active * moving
        })
    }

    /// The wrench at the platform's point and the platform's own weight.
    #[inline(always)]
    fn borne(&self, simd: S, wrench: &[Lanes<S>; 6]) -> [Lanes<S>; 6] {
        let mut weight = constant(simd, &self.gravity);
        for x in &mut weight {
            *x = *x * self.body.mass;
        }
        let nowhere = [Lanes::new(simd, 0.0); 3];
        let arm = carried(&self.rotation, &constant(simd, &self.body.centre), &nowhere);
        let lever = cross(&arm, &weight);
        let mut all = *wrench;
        for k in 0..3 {
            all[k] = all[k] + weight[k];
            all[3 + k] = all[3 + k] + lever[k];
        }
        all
    }
}

impl<S: Simd> Machine<S> {
    /// Tangent stiffness of the platform at its point, base axes, and the smallest relative pivot: of
    /// the limbs, less the change of the platform's own weight's moment.
    #[inline(always)]
    pub fn tangent(&self, simd: S) -> (Mat6<S>, Lanes<S>) {
        let zero = Lanes::new(simd, 0.0);
        let mut sum = [[zero; 6]; 6];
        let mut regular = Lanes::new(simd, 1.0);
        for (limb, plan) in self.limbs.iter().zip(self.actual.iter()) {
            let (own, pivot) = tangent::stiffness(simd, plan, limb, &self.gravity);
            regular = regular.least_of(pivot);
            for i in 0..6 {
                for j in 0..6 {
                    sum[i][j] = sum[i][j] + own[i][j];
                }
            }
        }
        let PlatformMass { centre, mass } = &self.body;
        if *mass != 0.0 {
            let [x, y, z] = &self.gravity;
            let weight = constant(simd, &[x * mass, y * mass, z * mass]);
            let arm = carried(&self.rotation, &constant(simd, centre), &[zero; 3]);
            let along = dot(&weight, &arm);
            for i in 0..3 {
                sum[3 + i][3 + i] = sum[3 + i][3 + i] + along;
                for j in 0..3 {
                    sum[3 + i][3 + j] = arm[i].times_from(weight[j], sum[3 + i][3 + j]);
                }
            }
        }
        (sum, regular)
    }

    /// Returns stability (one or zero), force per motion in the softest direction of the tool, load factor (NaN without
    /// internal motions), as in [`crate::batch::PostureStability`]; and the smallest relative pivot, by which the
    /// platform is left to the general engine where nothing holds it or it diverges.
    #[inline(always)]
    pub fn stability(&mut self, simd: S, k: &Mat6<S>) -> ([Lanes<S>; 3], Lanes<S>) {
        apart!(simd, {
            let (zero, one) = (Lanes::new(simd, 0.0), Lanes::new(simd, 1.0));
            let mut own = Symmetric::zero(simd);
            for i in 0..6 {
                for j in i..6 {
                    own.set(i, j, (k[i][j] + k[j][i]) * 0.5);
                }
            }
            let (compliance, mut regular) = own.inverse(simd);
            let softest = largest(compliance.a);
            let mut share_to_buckling = None;
            let limbs = self
                .shapes
                .iter_mut()
                .zip(self.actual.iter())
                .zip(&self.limbs);
            for ((shape, plan), limb) in limbs {
                if let Some((own, pivot)) = shape.share_to_buckling(plan, limb, &self.gravity) {
                    regular = regular.least_of(pivot);
                    share_to_buckling = Some(match share_to_buckling {
                        Some(other) => own.max(other),
                        None => own,
                    });
                }
            }
            let stable = match share_to_buckling {
                Some(share_to_buckling) => share_to_buckling.where_less(one, one, zero),
                None => one,
            };
            let share_to_buckling = match share_to_buckling {
                Some(share_to_buckling) => share_to_buckling,
                None => zero + f64::NAN,
            };
            ([stable, one / softest, share_to_buckling], regular)
        })
    }
}

/// Sweeps of Jacobi's rotations: each squares what is beside the diagonal.
const SWEEPS: usize = 6;

/// Largest eigenvalue of a symmetric 3 x 3 matrix in six numbers.
#[inline(always)]
fn largest<S: Simd>(mut m: [Lanes<S>; 6]) -> Lanes<S> {
    for _ in 0..SWEEPS {
        rotate::<S, 0, 1, 2>(&mut m);
        rotate::<S, 0, 2, 1>(&mut m);
        rotate::<S, 1, 2, 0>(&mut m);
    }
    m[AT[0][0]].max(m[AT[1][1]]).max(m[AT[2][2]])
}

/// Jacobi's rotation that takes entry (I, J) to zero; K is the third axis.
#[inline(always)]
fn rotate<S: Simd, const I: usize, const J: usize, const K: usize>(m: &mut [Lanes<S>; 6]) {
    let x = m[AT[I][J]];
    let (zero, one) = (x.same(0.0), x.same(1.0));
    // tan 2a = 2 x / d; t the smaller root, finite where both are zero.
    let d = m[AT[J][J]] - m[AT[I][I]];
    let root = d.times_plus(d, x * x * 4.0).sqrt();
    let under = d.abs() + root;
    let t = x * d.where_less(zero, -one, one) * 2.0 / under.max(one * f64::MIN_POSITIVE);
    let c = one / t.times_plus(t, one).sqrt();
    let s = t * c;
    m[AT[I][I]] = t.times_from(x, m[AT[I][I]]);
    m[AT[J][J]] = t.times_plus(x, m[AT[J][J]]);
    m[AT[I][J]] = zero;
    let (a, b) = (m[AT[I][K]], m[AT[J][K]]);
    m[AT[I][K]] = s.times_from(b, c * a);
    m[AT[J][K]] = s.times_plus(a, c * b);
}
