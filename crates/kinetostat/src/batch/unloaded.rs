//! Stiffness of one unloaded limb: its springs' compliance by the recursion of [`super::symmetric`],
//! then its passive joints taken out [R 3.10-3.11].
//!
//! A limb passes on no wrench that would move a passive joint: with `N` an orthonormal basis of
//! the wrenches `w` with `J_q^T w = 0`, the stiffness is `N (N^T C N)^-1 N^T`. That is the report's rule
//! without an inverse of `C`, so it holds for limbs with rigid links too.

use pulp::Simd;

use super::eliminate::Eliminated;
use super::lanes::{
    Lanes, Mat3, Vec3, carried, column, constant, cross, identity, minus, product, turn_columns,
};
use super::law;
use super::plan::{Amount, Held, Joint, Law, Plan, Step};
use super::symmetric::Symmetric;
use crate::chain::MotionKind;

/// Axis and place of a motion that a coordinate or a command drives, base axes.
#[derive(Clone, Copy)]
pub(super) struct Place<S: Simd> {
    pub axis: Vec3<S>,
    pub origin: Vec3<S>,
}

/// Where a limb is and what its springs yield: buffers of one walk.
pub(super) struct Walk<S: Simd> {
    /// Of the frame reached, base axes.
    pub rotation: Mat3<S>,
    pub point: Vec3<S>,
    /// Of the springs so far, in the axes and about the origin of the frame reached.
    compliance: Symmetric<S>,
    /// Nothing yields yet: the frame's motion does not matter.
    rigid: bool,
    places: Vec<Place<S>>,
    simd: S,
}

/// Stiffness of a limb in base axes about the platform's point.
pub(super) struct LimbStiffness<S: Simd> {
    pub matrix: Symmetric<S>,
    /// Smallest relative pivot on the way: near zero where a joint or a spring is redundant here.
    pub regular: Lanes<S>,
}

impl<S: Simd> Walk<S> {
    pub fn new(simd: S, plan: &Plan) -> Self {
        let zero = Lanes::new(simd, 0.0);
        let place = Place {
            axis: [zero; 3],
            origin: [zero; 3],
        };
        Self {
            rotation: identity(simd),
            point: [zero; 3],
            compliance: Symmetric::zero(simd),
            rigid: true,
            places: vec![place; plan.screws.len()],
            simd,
        }
    }

    /// Walks along the unloaded limb with the given commands and passive joints, up to step `end`.
    /// With `yields` the compliance comes along.
    #[inline(always)]
    pub fn along(
        &mut self,
        plan: &Plan,
        yields: bool,
        end: usize,
        commands: &[Lanes<S>],
        passive: &[Lanes<S>],
    ) {
        let simd = self.simd;
        self.rotation = identity(simd);
        self.point = [Lanes::new(simd, 0.0); 3];
        self.compliance = Symmetric::zero(simd);
        self.rigid = true;
        for step in &plan.steps[..end] {
            match step {
                Step::Shift(l) => self.shift(&constant(simd, l)),
                Step::Rotate(r) => {
                    let r = r.map(|x| Lanes::new(simd, x));
                    self.rotation = product(&self.rotation, &r);
                    if !self.rigid {
                        let back = [r[0], r[3], r[6], r[1], r[4], r[7], r[2], r[5], r[8]];
                        self.compliance = self.compliance.in_base_axes(&back);
                    }
                }
                Step::Joint(joint) => {
                    let amount = amount(simd, &joint.amount, commands, || match joint.held {
                        Held::Passive(slot) => Some(passive[slot]),
                        _ => None,
                    });
                    match joint.axis {
                        0 => self.joint::<0>(joint, amount, yields),
                        1 => self.joint::<1>(joint, amount, yields),
                        _ => self.joint::<2>(joint, amount, yields),
                    }
                }
                Step::Spring(spring) if yields => {
                    match &spring.law {
                        Law::Constant | Law::Bowing(_) => {
                            self.compliance.add_constant(&spring.compliance);
                        }
                        Law::Parallelogram(bars, slot) => {
                            let own = law::parallelogram(simd, bars, passive[*slot]);
                            self.compliance.add(&own);
                        }
                    }
                    self.rigid = false;
                    let moving = (0..6).filter(|d| spring.coordinates[*d].is_some());
                    for (place, d) in self.places[spring.screw..].iter_mut().zip(moving) {
                        place.axis = column(&self.rotation, d % 3);
                        place.origin = self.point;
                    }
                }
                Step::Spring(_) | Step::Mass { .. } => {}
            }
        }
    }

    #[inline(always)]
    fn shift(&mut self, l: &Vec3<S>) {
        self.point = carried(&self.rotation, l, &self.point);
        if !self.rigid {
            self.compliance.shift(l);
        }
    }

    #[inline(always)]
    fn joint<const AXIS: usize>(&mut self, joint: &Joint, amount: Lanes<S>, yields: bool) {
        let axis = column(&self.rotation, AXIS);
        self.places[joint.screw] = Place {
            axis,
            origin: self.point,
        };
        let revolute = joint.kind == MotionKind::Revolute;
        if let (Held::Spring(c), true) = (joint.held, yields) {
            let row = if revolute { AXIS + 3 } else { AXIS };
            let sum = self.compliance.get(row, row) + c;
            self.compliance.set(row, row, sum);
            self.rigid = false;
        }
        if revolute {
            let (s, c) = amount.sin_cos();
            turn_columns::<S, AXIS>(&mut self.rotation, s, c);
            if !self.rigid {
                self.compliance.turn::<AXIS>(s, c);
            }
        } else {
            for k in 0..3 {
                self.point[k] = axis[k].times_plus(amount, self.point[k]);
            }
            if !self.rigid {
                let mut l = [amount.same(0.0); 3];
                l[AXIS] = amount;
                self.compliance.shift(&l);
            }
        }
    }

    /// Twist of the frame reached per unit of a motion, base axes.
    #[inline(always)]
    pub fn twist(&self, plan: &Plan, screw: usize) -> [Lanes<S>; 6] {
        let Place { axis, origin } = &self.places[screw];
        match plan.screws[screw].kind {
            MotionKind::Revolute => {
                let v = cross(axis, &minus(&self.point, origin));
                [v[0], v[1], v[2], axis[0], axis[1], axis[2]]
            }
            MotionKind::Prismatic => {
                let zero = axis[0].same(0.0);
                [axis[0], axis[1], axis[2], zero, zero, zero]
            }
        }
    }

    /// Adds the twists of a limb's motions before `screws` to the columns that `place` names:
    /// a passive joint or a command.
    #[inline(always)]
    pub fn columns(
        &self,
        plan: &Plan,
        screws: usize,
        columns: &mut [[Lanes<S>; 6]; 6],
        place: impl Fn(&super::plan::Screw) -> Option<(usize, f64)>,
    ) {
        for (k, screw) in plan.screws[..screws].iter().enumerate() {
            let Some((slot, ratio)) = place(screw) else {
                continue;
            };
            let twist = self.twist(plan, k);
            for (sum, x) in columns[slot].iter_mut().zip(twist) {
                *sum = x.times_plus(x.same(ratio), *sum);
            }
        }
    }

    /// Stiffness of the limb where [`Self::along`] has led it.
    #[inline(always)]
    pub fn stiffness(&mut self, plan: &Plan) -> LimbStiffness<S> {
        let simd = self.simd;
        if plan.passive.is_empty() {
            let (inverse, regular) = self.compliance.inverse(simd);
            return LimbStiffness {
                matrix: inverse.in_base_axes(&self.rotation),
                regular,
            };
        }
        let factors = self.eliminated(plan);
        let found = factors.stiffness(simd);
        let length = plan.length;
        LimbStiffness {
            matrix: found.matrix.scaled(1.0 / (length * length), 1.0 / length),
            regular: found.regular,
        }
    }

    /// The limb's compliance with its passive joints taken out, in units in which rotations count as
    /// motions at the natural length: linear motions as shares of it.
    #[inline(always)]
    pub fn eliminated(&mut self, plan: &Plan) -> Eliminated<S> {
        let simd = self.simd;
        let compliance = self.compliance.in_base_axes(&self.rotation);
        let mut columns = [[Lanes::new(simd, 0.0); 6]; 6];
        self.columns(plan, plan.screws.len(), &mut columns, |s| {
            let (own, ratio) = s.coordinate?;
            plan.slot(own).map(|slot| (slot, ratio))
        });
        let length = plan.length;
        for column in &mut columns {
            for x in &mut column[..3] {
                *x = *x * (1.0 / length);
            }
        }
        let balanced = compliance.scaled(1.0 / (length * length), 1.0 / length);
        Eliminated::new(simd, 6, plan.passive.len(), &balanced, &columns)
    }

    /// The same where a spherical joint ends the limb and [`Self::along`] has led to its centre: only a
    /// force through the centre is passed on. `arm` leads from the platform's point to the centre, base
    /// axes.
    #[inline(always)]
    pub fn stiffness_at_sphere(&mut self, plan: &Plan, arm: &Vec3<S>) -> LimbStiffness<S> {
        let simd = self.simd;
        let compliance = self.compliance.in_base_axes(&self.rotation);
        let mut columns = [[Lanes::new(simd, 0.0); 6]; 6];
        let (_, screws) = plan.before_sphere();
        self.columns(plan, screws, &mut columns, |s| {
            let (own, ratio) = s.coordinate?;
            plan.slot(own).map(|slot| (slot, ratio))
        });
        // The three of the sphere come last.
        let others = plan.passive.len() - 3;
        let mut found = Eliminated::new(simd, 3, others, &compliance, &columns).stiffness(simd);
        found.matrix.move_force_line(arm);
        found
    }
}

/// `fixed + ratio * command + ratio * coordinate`.
#[inline(always)]
pub(super) fn amount<S: Simd>(
    simd: S,
    amount: &Amount,
    commands: &[Lanes<S>],
    coordinate: impl Fn() -> Option<Lanes<S>>,
) -> Lanes<S> {
    let mut sum = Lanes::new(simd, amount.fixed);
    if let Some((index, ratio)) = amount.command {
        sum = commands[index].times_plus(sum.same(ratio), sum);
    }
    if let (Some((_, ratio)), Some(value)) = (amount.coordinate, coordinate()) {
        sum = value.times_plus(sum.same(ratio), sum);
    }
    sum
}
