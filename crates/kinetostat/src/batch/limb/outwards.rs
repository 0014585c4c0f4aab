//! A limb swept from the base to the tip: positions of its parts, and forces of its actuators.

use pulp::Simd;

use crate::batch::limb::loaded::LoadedLimb;
use crate::batch::limb::unloaded::{MotionAxis, amount};
use crate::batch::numbers::instruction_set::apart;
use crate::batch::numbers::lanes::Lanes;
use crate::batch::numbers::vectors::{
    Mat3, Vec3, carried, column, column_of, constant, cross, dot, identity, matrix, minus, product,
    select, shifted, turn_columns,
};
use crate::batch::numbers::wrenches::{lever, rotated_back};
use crate::batch::plan::steps::{Joint, Law, Plan, Spring, Step, Support};
use crate::spatial::MotionKind;

impl<S: Simd> LoadedLimb<S> {
    /// Outward pass: the tip at the present coordinates, and the direction of gravity at the masses.
    #[inline(always)]
    pub fn outwards(&mut self, plan: &Plan, gravity: &[f64; 3]) {
        self.forward::<false, false>(plan, gravity);
    }

    /// Outward pass after the wrench has changed by `change`: springs follow by their compliance in the same pass, so
    /// that torques and tip are of one state. Torques in the geometry that the springs had under the wrench before
    /// would be late by a pass, and with late corrections the rate of contraction is only the root of what it could be.
    #[inline(always)]
    pub fn outwards_after(
        &mut self,
        plan: &Plan,
        gravity: &[f64; 3],
        change: &[Lanes<S>; 6],
        active: Lanes<S>,
    ) {
        (self.change, self.changed) = (*change, active);
        self.forward::<false, true>(plan, gravity);
    }

    /// Outward pass with the places of all motions and masses.
    #[inline(always)]
    pub fn frames(&mut self, plan: &Plan, gravity: &[f64; 3]) {
        self.forward::<true, false>(plan, gravity);
    }

    #[inline(always)]
    fn forward<const PLACES: bool, const FOLLOWS: bool>(
        &mut self,
        plan: &Plan,
        gravity: &[f64; 3],
    ) {
        apart!(self.simd, {
            let simd = self.simd;
            let mut r = identity(simd);
            let mut p = [Lanes::new(simd, 0.0); 3];
            let (mut mass, mut law) = (0, 0);
            for step in &plan.steps {
                match step {
                    Step::Shift(l) => shifted(&r, l, &mut p),
                    Step::Rotate(by) => r = product(&r, &matrix(simd, by)),
                    Step::Joint(joint) => {
                        if PLACES {
                            self.places[joint.screw] = MotionAxis {
                                axis: column_of(&r, joint.axis),
                                origin: p,
                            };
                        }
                        if FOLLOWS {
                            self.joint_goes_along(joint, &r, &p);
                        }
                        let coordinate = match joint.amount.coordinate {
                            Some((own, _)) => Some(self.coordinates[own]),
                            None => None,
                        };
                        let amount = amount(simd, &joint.amount, &self.commands, coordinate);
                        match joint.kind {
                            MotionKind::Revolute => {
                                let (s, c) = amount.sin_cos();
                                self.moved[joint.screw] = [s, c];
                                match joint.axis {
                                    0 => turn_columns::<S, 0>(&mut r, s, c),
                                    1 => turn_columns::<S, 1>(&mut r, s, c),
                                    _ => turn_columns::<S, 2>(&mut r, s, c),
                                }
                            }
                            MotionKind::Prismatic => {
                                self.moved[joint.screw][0] = amount;
                                let axis = column_of(&r, joint.axis);
                                for k in 0..3 {
                                    p[k] = axis[k].times_plus(amount, p[k]);
                                }
                            }
                        }
                    }
                    Step::Spring(spring) if self.bent || PLACES => {
                        if FOLLOWS {
                            self.spring_goes_along(spring, law, &r, &p);
                            law += usize::from(matches!(spring.law, Law::Parallelogram(..)));
                        }
                        self.spring::<PLACES>(spring, &mut r, &mut p);
                    }
                    Step::Spring(_) => {}
                    Step::Mass { at, .. } => {
                        let mut own = [Lanes::new(simd, 0.0); 3];
                        for k in 0..3 {
                            if gravity[k] != 0.0 {
                                let g = Lanes::new(simd, gravity[k]);
                                for i in 0..3 {
                                    own[i] = r[3 * k + i].times_plus(g, own[i]);
                                }
                            }
                        }
                        self.gravity[mass] = own;
                        if PLACES {
                            self.masses[mass] = carried(&r, &constant(simd, at), &p);
                        }
                        mass += 1;
                    }
                }
            }
            (self.rotation, self.point) = (r, p);
        })
    }

    /// Force and moment of the change of the wrench about the place `p`, base axes.
    #[inline(always)]
    fn change_at(&self, p: &Vec3<S>) -> (Vec3<S>, Vec3<S>) {
        let [fx, fy, fz, mx, my, mz] = self.change;
        // The tip is where it was: what it moves is of second order.
        let turning = cross(&minus(&self.point, p), &[fx, fy, fz]);
        let moment = [mx + turning[0], my + turning[1], mz + turning[2]];
        ([fx, fy, fz], moment)
    }

    #[inline(always)]
    fn joint_goes_along(&mut self, joint: &Joint, r: &Mat3<S>, p: &Vec3<S>) {
        let (Support::Spring(compliance), Some((own, ratio))) =
            (joint.support, joint.amount.coordinate)
        else {
            return;
        };
        let (force, moment) = self.change_at(p);
        let along = match joint.kind {
            MotionKind::Prismatic => force,
            MotionKind::Revolute => moment,
        };
        let torque = dot(&column_of(r, joint.axis), &along) * ratio;
        let step = match &joint.law {
            Some(_) => torque / self.joint_stiffness(joint, own, compliance),
            None => torque * compliance,
        };
        self.follows(own, self.coordinates[own] + step, self.changed);
    }

    #[inline(always)]
    fn spring_goes_along(&mut self, spring: &Spring, law: usize, r: &Mat3<S>, p: &Vec3<S>) {
        let (force, moment) = self.change_at(p);
        let mut torque = [force[0]; 6];
        for k in 0..3 {
            let axis = column(r, k);
            (torque[k], torque[3 + k]) = (dot(&axis, &force), dot(&axis, &moment));
        }
        let step = self.yields(spring, law, &torque);
        for d in 0..6 {
            if let Some(own) = spring.coordinates[d] {
                self.follows(own, self.coordinates[own] + step[d], self.changed);
            }
        }
    }

    #[inline(always)]
    fn spring<const PLACES: bool>(&mut self, spring: &Spring, r: &mut Mat3<S>, p: &mut Vec3<S>) {
        let before = *r;
        let mut screw = spring.screw;
        for k in 0..3 {
            if let Some(own) = spring.coordinates[k] {
                let l = self.coordinates[own];
                for i in 0..3 {
                    p[i] = before[3 * i + k].times_plus(l, p[i]);
                }
                if PLACES {
                    self.places[screw].axis = column(&before, k);
                }
                screw += 1;
            }
        }
        for k in 0..3 {
            if let Some(own) = spring.coordinates[3 + k] {
                if PLACES {
                    self.places[screw] = MotionAxis {
                        axis: column(r, k),
                        origin: *p,
                    };
                }
                let x = self.coordinates[own];
                let (mut s, mut c) = sin_cos_small(x);
                if let Some(far) = self.far {
                    let (sine, cosine) = x.sin_cos_near_zero();
                    (s, c) = (select(far, sine, s), select(far, cosine, c));
                }
                self.moved[screw] = [s, c];
                screw += 1;
                match k {
                    0 => turn_columns::<S, 0>(r, s, c),
                    1 => turn_columns::<S, 1>(r, s, c),
                    _ => turn_columns::<S, 2>(r, s, c),
                }
            }
        }
    }
}

/// Sine and cosine of |x| <= 0.1 rad to rounding: their series.
#[inline(always)]
fn sin_cos_small<S: Simd>(x: Lanes<S>) -> (Lanes<S>, Lanes<S>) {
    let z = x * x;
    let sine = z.polynomial(&[1.0 / 362_880.0, -1.0 / 5040.0, 1.0 / 120.0, -1.0 / 6.0]);
    let cosine = z.polynomial(&[1.0 / 40_320.0, -1.0 / 720.0, 1.0 / 24.0, -0.5, 1.0]);
    ((x * z).times_plus(sine, x), cosine)
}

/// Adds the force (N) or torque (N m) of the loads on every actuator of a limb where it lies: of the
/// wrench at its tip and of the weights beyond.
#[inline(always)]
pub(crate) fn actuator_forces<S: Simd>(
    simd: S,
    plan: &Plan,
    limb: &LoadedLimb<S>,
    out: &mut [Lanes<S>],
) {
    let (mut force, mut moment) = limb.at_tip();
    let mut mass = limb.gravity.len();
    for step in plan.steps.iter().rev() {
        match step {
            Step::Mass { at, mass: m } => {
                mass -= 1;
                limb.weight(mass, at, *m, &mut force, &mut moment);
            }
            Step::Shift(l) => lever(l, &force, &mut moment),
            Step::Rotate(by) => rotated_back(simd, by, &mut force, &mut moment),
            Step::Joint(joint) => {
                let along = limb.joint_bears(joint, &mut force, &mut moment);
                if let Some((own, ratio)) = joint.amount.command {
                    out[own] = along.times_plus(along.same(ratio), out[own]);
                }
            }
            Step::Spring(spring) => {
                let mut torque = limb.spring_bears(spring, &mut force, &mut moment);
                limb.own_weight(spring, &mut torque, &mut moment);
            }
        }
    }
}
