//! Stiffness of one unloaded limb: its springs' compliance by the recursion of [`crate::batch::numbers::symmetric`],
//! then its passive joints taken out [R 3.10-3.11].
//!
//! A limb passes on no wrench that would move a passive joint: with `N` an orthonormal basis of
//! the wrenches `w` with `J_q^T w = 0`, the stiffness is `N (N^T C N)^-1 N^T`. That is the report's rule
//! without an inverse of `C`, so it holds for limbs with rigid links too.

use pulp::Simd;

use crate::batch::limb::law;
use crate::batch::numbers::eliminate::{Eliminated, LimbStiffness};
use crate::batch::numbers::instruction_set::apart;
use crate::batch::numbers::lanes::Lanes;
use crate::batch::numbers::symmetric::Symmetric;
use crate::batch::numbers::vectors::{
    Mat3, Vec3, carried, column, constant, cross, dot, identity, matrix, minus, product,
    turn_columns,
};
use crate::batch::plan::steps::{Amount, Drive, Joint, Law, Plan, Step, Support};
use crate::spatial::MotionKind;

type SineCosine<S> = (Lanes<S>, Lanes<S>);

/// Pose and compliance of a limb: buffers of one forward pass.
pub(crate) struct ForwardPass<S: Simd> {
    /// Rotation and origin of the frame reached, base axes.
    pub rotation: Mat3<S>,
    pub point: Vec3<S>,
    /// Compliance of the springs so far, in the axes and about the origin of the frame reached.
    compliance: Symmetric<S>,
    /// True while nothing yields: the frame's motion does not matter.
    rigid: bool,
    places: Vec<MotionAxis<S>>,
    /// Sines and cosines of two joints that are known already, and the step of the first.
    pub known: Option<(usize, [SineCosine<S>; 2])>,
    simd: S,
}

impl<S: Simd> ForwardPass<S> {
    pub fn new(simd: S, plan: &Plan) -> Self {
        let zero = Lanes::new(simd, 0.0);
        let place = MotionAxis {
            axis: [zero; 3],
            origin: [zero; 3],
        };
        Self {
            rotation: identity(simd),
            point: [zero; 3],
            compliance: Symmetric::zero(simd),
            rigid: true,
            places: vec![place; plan.screws.len()],
            known: None,
            simd,
        }
    }

    /// Goes along the unloaded limb with the given commands and passive joints, up to step `end`.
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
        apart!(self.simd, {
            let simd = self.simd;
            self.rotation = identity(simd);
            self.point = [Lanes::new(simd, 0.0); 3];
            self.compliance = Symmetric::zero(simd);
            self.rigid = true;
            for (i, step) in plan.steps[..end].iter().enumerate() {
                match step {
                    Step::Shift(l) => self.shift(&constant(simd, l)),
                    Step::Rotate(r) => {
                        let r = matrix(simd, r);
                        self.rotation = product(&self.rotation, &r);
                        if !self.rigid {
                            let back = [r[0], r[3], r[6], r[1], r[4], r[7], r[2], r[5], r[8]];
                            self.compliance = self.compliance.in_base_axes(&back);
                        }
                    }
                    Step::Joint(joint) => {
                        let coordinate = match joint.support {
                            Support::Passive(slot) => Some(passive[slot]),
                            _ => None,
                        };
                        let amount = amount(simd, &joint.amount, commands, coordinate);
                        let (s, c) = match &self.known {
                            Some((first, known)) if i.wrapping_sub(*first) < 2 => known[i - first],
                            _ if joint.kind == MotionKind::Revolute => amount.sin_cos(),
                            _ => (amount, amount),
                        };
                        match joint.axis {
                            0 => self.joint::<0>(joint, amount, s, c, yields),
                            1 => self.joint::<1>(joint, amount, s, c, yields),
                            _ => self.joint::<2>(joint, amount, s, c, yields),
                        }
                    }
                    Step::Spring(spring) if yields => {
                        match &spring.law {
                            Law::Constant | Law::Curved(..) => {
                                self.compliance.add_constant(&spring.compliance);
                            }
                            Law::Parallelogram(bars, slot) => {
                                let own = law::parallelogram(simd, bars, passive[*slot]);
                                self.compliance.add(&own);
                            }
                        }
                        self.rigid = false;
                        let mut screw = spring.screw;
                        for d in 0..6 {
                            if spring.coordinates[d].is_some() {
                                self.places[screw] = MotionAxis {
                                    axis: column(&self.rotation, d % 3),
                                    origin: self.point,
                                };
                                screw += 1;
                            }
                        }
                    }
                    Step::Spring(_) | Step::Mass { .. } => {}
                }
            }
        })
    }

    #[inline(always)]
    fn shift(&mut self, l: &Vec3<S>) {
        self.point = carried(&self.rotation, l, &self.point);
        if !self.rigid {
            self.compliance.shift(l);
        }
    }

    #[inline(always)]
    fn joint<const AXIS: usize>(
        &mut self,
        joint: &Joint,
        amount: Lanes<S>,
        s: Lanes<S>,
        c: Lanes<S>,
        yields: bool,
    ) {
        let axis = column(&self.rotation, AXIS);
        self.places[joint.screw] = MotionAxis {
            axis,
            origin: self.point,
        };
        let revolute = joint.kind == MotionKind::Revolute;
        if let (Support::Spring(c), true) = (joint.support, yields) {
            let row = if revolute { AXIS + 3 } else { AXIS };
            let sum = self.compliance.get(row, row) + c;
            self.compliance.set(row, row, sum);
            self.rigid = false;
        }
        if revolute {
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
        self.places[screw].twist(plan.screws[screw].kind, &self.point)
    }

    /// Sum of the twists of the motions that each of the unknowns drives.
    #[inline(always)]
    pub fn columns(&self, plan: &Plan, drives: &[Drive], columns: &mut [[Lanes<S>; 6]; 6]) {
        for drive in drives {
            let twist = self.twist(plan, drive.screw);
            let column = &mut columns[drive.unknown];
            for k in 0..6 {
                column[k] = twist[k].times_plus(twist[k].same(drive.ratio), column[k]);
            }
        }
    }

    /// Stiffness of the limb in the posture that [`Self::along`] has evaluated last.
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
        apart!(self.simd, {
            let simd = self.simd;
            let compliance = self.compliance.in_base_axes(&self.rotation);
            let mut columns = [[Lanes::new(simd, 0.0); 6]; 6];
            self.columns(plan, &plan.passive_drives, &mut columns);
            let length = plan.length;
            for column in &mut columns {
                for x in &mut column[..3] {
                    *x = *x * (1.0 / length);
                }
            }
            let balanced = compliance.scaled(1.0 / (length * length), 1.0 / length);
            Eliminated::new(simd, 6, plan.passive.len(), &balanced, &columns)
        })
    }

    /// Stiffness of a limb that ends in a spherical joint, after [`Self::along`] has reached its centre: only a force
    /// through the centre is transmitted. `arm` leads from the platform's point to the centre, base axes.
    #[inline(always)]
    pub fn stiffness_at_sphere(&mut self, plan: &Plan, arm: &Vec3<S>) -> LimbStiffness<S> {
        let simd = self.simd;
        // The three of the sphere come last.
        let others = plan.passive.len() - 3;
        let drives = plan.passive_drives.len() - 3;
        let drives = &plan.passive_drives[..drives];
        if others == 2 && drives.len() == 2 {
            return self.force_along_one_line(plan, drives, arm);
        }
        let compliance = self.compliance.in_base_axes(&self.rotation);
        let mut columns = [[Lanes::new(simd, 0.0); 6]; 6];
        self.columns(plan, drives, &mut columns);
        let mut found = Eliminated::new(simd, 3, others, &compliance, &columns).stiffness(simd);
        found.matrix.move_force_line(arm);
        found
    }

    /// Two passive joints and a spherical one leave a single direction `n` in which the limb passes on a
    /// force: `n n^T / (n^T C n)`, the rule for one vector.
    #[inline(always)]
    fn force_along_one_line(
        &self,
        plan: &Plan,
        drives: &[Drive],
        arm: &Vec3<S>,
    ) -> LimbStiffness<S> {
        let [ux, uy, uz, ..] = self.twist(plan, drives[0].screw);
        let [vx, vy, vz, ..] = self.twist(plan, drives[1].screw);
        let (u, v) = ([ux, uy, uz], [vx, vy, vz]);
        let n = cross(&u, &v);
        let regular = dot(&n, &n) / (dot(&u, &u) * dot(&v, &v));
        // Expressed in the frame's axes, where the compliance is.
        let r = &self.rotation;
        let own = [
            dot(&column(r, 0), &n),
            dot(&column(r, 1), &n),
            dot(&column(r, 2), &n),
        ];
        let [xx, xy, xz, yy, yz, zz] = self.compliance.a;
        let yields = [
            dot(&[xx, xy, xz], &own),
            dot(&[xy, yy, yz], &own),
            dot(&[xz, yz, zz], &own),
        ];
        let k = n[0].same(1.0) / dot(&own, &yields);
        // The wrench of a unit force through the centre, about the platform's point.
        let m = cross(arm, &n);
        let w = [n[0], n[1], n[2], m[0], m[1], m[2]];
        let mut matrix = Symmetric::zero(self.simd);
        for i in 0..6 {
            let own = w[i] * k;
            for j in i..6 {
                matrix.set(i, j, own * w[j]);
            }
        }
        LimbStiffness { matrix, regular }
    }
}

/// Axis and place of a motion that a coordinate or a command drives, base axes.
#[derive(Clone, Copy)]
pub(crate) struct MotionAxis<S: Simd> {
    pub axis: Vec3<S>,
    pub origin: Vec3<S>,
}

impl<S: Simd> MotionAxis<S> {
    /// Twist of a body at `point` per unit of the motion, base axes.
    #[inline(always)]
    pub fn twist(&self, kind: MotionKind, point: &Vec3<S>) -> [Lanes<S>; 6] {
        let Self { axis, origin } = self;
        match kind {
            MotionKind::Revolute => {
                let v = cross(axis, &minus(point, origin));
                [v[0], v[1], v[2], axis[0], axis[1], axis[2]]
            }
            MotionKind::Prismatic => {
                let zero = axis[0].same(0.0);
                [axis[0], axis[1], axis[2], zero, zero, zero]
            }
        }
    }
}

/// `fixed + ratio * command + ratio * coordinate`.
#[inline(always)]
pub(crate) fn amount<S: Simd>(
    simd: S,
    amount: &Amount,
    commands: &[Lanes<S>],
    coordinate: Option<Lanes<S>>,
) -> Lanes<S> {
    let mut sum = Lanes::new(simd, amount.fixed);
    if let Some((index, ratio)) = amount.command {
        sum = commands[index].times_plus(sum.same(ratio), sum);
    }
    if let (Some((_, ratio)), Some(value)) = (amount.coordinate, coordinate) {
        sum = value.times_plus(sum.same(ratio), sum);
    }
    sum
}
