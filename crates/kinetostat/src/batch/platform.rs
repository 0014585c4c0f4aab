//! Equilibrium of a platform that several limbs hold: wrenches, passive joints and the platform are
//! corrected in each pass by the unloaded machine's own compliance, factored once ([`super::eliminate`]).

use pulp::Simd;

use super::apart::apart;
use super::eliminate::Eliminated;
use super::lanes::Lanes;
use super::loaded::{LoadedLimb, MOST_PASSES, MOST_TURN, TOLERANCE};
use super::plan::Plan;
use super::symmetric::Symmetric;
use super::vectors::{Mat3, Vec3, carried, constant, cross, minus, select, turn_between, turned};

/// Rounding of the residual between a limb and its platform, share of the natural length or rad: a few passes
/// over tens of motions.
const RESIDUAL_ROUNDING: f64 = 4e-15;

/// Limbs that hold one platform.
pub(super) struct Held6<'a, S: Simd> {
    pub plans: &'a [Plan],
    pub limbs: &'a mut [LoadedLimb<S>],
    /// Unloaded compliance of every limb.
    pub factors: &'a [Eliminated<S>],
    /// Largest entry of every limb's stiffness, N m.
    pub stiffest: &'a [Lanes<S>],
    /// Inverse of the unloaded stiffness of the platform.
    pub compliance: &'a Symmetric<S>,
    pub rotation: Mat3<S>,
    pub point: Vec3<S>,
    /// Centre of mass (m, platform axes) and mass of the platform.
    pub body: ([f64; 3], f64),
    pub gravity: [f64; 3],
}

impl<S: Simd> Held6<'_, S> {
    /// Equilibrium under a dead wrench at the platform's point: one in the lanes that are done.
    #[inline(always)]
    pub fn settle(&mut self, simd: S, wrench: &[Lanes<S>; 6]) -> Lanes<S> {
        let one = Lanes::new(simd, 1.0);
        let mut active = one;
        for limb in self.limbs.iter_mut().zip(self.plans) {
            limb.0.outwards(limb.1, &self.gravity);
        }
        for _ in 0..MOST_PASSES {
            active = self.pass(simd, wrench, active);
            if active.all_less(0.5) {
                break;
            }
        }
        let mut done = one - active;
        for (limb, plan) in self.limbs.iter_mut().zip(self.plans) {
            // The last pass has moved the passive joints.
            limb.outwards(plan, &self.gravity);
            done = done * limb.sound(plan, MOST_TURN);
        }
        done
    }

    #[inline(always)]
    fn pass(&mut self, simd: S, wrench: &[Lanes<S>; 6], active: Lanes<S>) -> Lanes<S> {
        apart!(simd, {
            let (zero, one) = (Lanes::new(simd, 0.0), Lanes::new(simd, 1.0));
            let mut moving = zero;
            // What the limbs lack, to first order, with the platform where it is.
            let mut weight = constant(simd, &self.gravity);
            for x in &mut weight {
                *x = *x * self.body.1;
            }
            let arm = carried(&self.rotation, &constant(simd, &self.body.0), &[zero; 3]);
            let lever = cross(&arm, &weight);
            let mut unbalanced = *wrench;
            for k in 0..3 {
                unbalanced[k] = unbalanced[k] + weight[k];
                unbalanced[3 + k] = unbalanced[3 + k] + lever[k];
            }
            for (i, (limb, plan)) in self.limbs.iter_mut().zip(self.plans).enumerate() {
                let (factors, noise) = (&self.factors[i], self.stiffest[i] * RESIDUAL_ROUNDING);
                limb.clear(plan);
                limb.inwards(plan, active);
                limb.outwards(plan, &self.gravity);
                let residual = residual(limb, plan, &self.rotation, &self.point);
                for x in residual {
                    // A share of the natural length, or rad.
                    moving = (one * TOLERANCE).where_less(x.abs(), one, moving);
                }
                // On every coordinate, N or N m.
                let torques = noise * noise * (limb.coordinates.len() as f64);
                let rounding = torques * (1.0 + 1.0 / (plan.length * plan.length));
                moving = moving.max(limb.moving(rounding));
                let (step, _) = correction(simd, limb, plan, factors, residual);
                for k in 0..6 {
                    unbalanced[k] = unbalanced[k] - limb.wrench[k] - step[k];
                }
            }
            let motion = self.compliance.times(&unbalanced);
            for (i, (limb, plan)) in self.limbs.iter_mut().zip(self.plans).enumerate() {
                let (factors, noise) = (&self.factors[i], self.stiffest[i] * RESIDUAL_ROUNDING);
                let mut residual = residual(limb, plan, &self.rotation, &self.point);
                for k in 0..3 {
                    residual[k] = motion[k].times_plus(one * (1.0 / plan.length), residual[k]);
                    residual[3 + k] = residual[3 + k] + motion[3 + k];
                }
                let (step, joints) = correction(simd, limb, plan, factors, residual);
                let (mut change, mut size) = (zero, zero);
                for k in 0..6 {
                    let unit = if k < 3 { plan.length } else { 1.0 };
                    let (x, w) = (step[k] * unit, (limb.wrench[k] + step[k]) * unit);
                    change = x.times_plus(x, change);
                    size = w.times_plus(w, size);
                }
                // What a residual of rounding makes of wrenches is rounding too: limbs that brace each other
                // know their inner forces no better.
                let allowed = (size * (TOLERANCE * TOLERANCE)).max(noise * noise);
                moving = allowed.where_less(change, one, moving);
                for k in 0..6 {
                    limb.wrench[k] = select(active, limb.wrench[k] + step[k], limb.wrench[k]);
                }
                for (own, dq) in plan.passive.iter().zip(joints) {
                    let x = limb.coordinates[*own];
                    limb.coordinates[*own] = select(active, x + dq, x);
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
}

/// From a limb's tip to the platform, balanced: share of the natural length, rad.
#[inline(always)]
fn residual<S: Simd>(
    limb: &LoadedLimb<S>,
    plan: &Plan,
    to: &Mat3<S>,
    point: &Vec3<S>,
) -> [Lanes<S>; 6] {
    let l = minus(point, &limb.point);
    let a = turn_between(to, &limb.rotation);
    let share = 1.0 / plan.length;
    [l[0] * share, l[1] * share, l[2] * share, a[0], a[1], a[2]]
}

/// Change of a limb's wrench (N, N m) and of its passive joints that closes a residual and frees the joints of torque.
#[inline(always)]
fn correction<S: Simd>(
    simd: S,
    limb: &LoadedLimb<S>,
    plan: &Plan,
    factors: &Eliminated<S>,
    residual: [Lanes<S>; 6],
) -> ([Lanes<S>; 6], [Lanes<S>; 6]) {
    let zero = Lanes::new(simd, 0.0);
    let mut torque = [zero; 6];
    for (x, own) in torque.iter_mut().zip(&plan.passive) {
        *x = -limb.torque[*own];
    }
    let mut joints = [zero; 6];
    let mut wrench = factors.answer(simd, residual, &torque, &mut joints);
    for x in &mut wrench[..3] {
        *x = *x * (1.0 / plan.length);
    }
    (wrench, joints)
}
