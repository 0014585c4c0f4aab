//! Equilibrium under load, several postures at once.
//!
//! The torques of a chain depend on its deflections weakly: `theta <- K^-1 tau(theta)` [R 4.16] contracts by
//! about the share of the geometric stiffness in the springs', and needs no matrix. One pass walks
//! out (frames) and back (torques). Where limbs hold a platform together, wrenches, passive joints
//! and the platform are corrected in each pass by the unloaded machine's own compliance, factored
//! once ([`super::eliminate`]). Contraction is watched: a lane that is not done after
//! [`MOST_PASSES`] is left to Newton's iteration of the general engine.

use pulp::Simd;

use super::eliminate::Eliminated;
use super::lanes::{
    Lanes, Mat3, Vec3, carried, column, constant, cross, dot, identity, minus, product,
    turn_columns,
};
use super::law;
use super::plan::{Held, Joint, Law, Plan, Spring, Step};
use super::reach::turn_between;
use super::symmetric::Symmetric;
use super::unloaded::{Place, amount};
use crate::chain::MotionKind;

/// Passes after which a lane is given up. A contraction of 0.4 reaches [`TOLERANCE`] in thirty.
pub(super) const MOST_PASSES: usize = 30;
/// Relative change of the torques at which a lane is done: the next pass would change rounding.
const TOLERANCE: f64 = 1e-12;
/// Springs turn less than this, rad: their sines are short polynomials.
const MOST_TURN: f64 = 0.7;

/// A limb on its way to equilibrium.
pub(super) struct LoadedLimb<S: Simd> {
    /// Springs' deflections and passive joints, by coordinate.
    pub coordinates: Vec<Lanes<S>>,
    pub commands: Vec<Lanes<S>>,
    /// Torque on every coordinate.
    pub torque: Vec<Lanes<S>>,
    /// Of the platform on the limb's tip, about the tip, base axes.
    pub wrench: [Lanes<S>; 6],
    pub places: Vec<Place<S>>,
    /// Centres of the masses.
    pub masses: Vec<Vec3<S>>,
    pub rotation: Mat3<S>,
    pub point: Vec3<S>,
    /// Of the springs that depend on the commanded posture, in the order of the steps.
    laws: Vec<Symmetric<S>>,
    /// Largest square of a rotation of a spring whose law is a series.
    largest: Lanes<S>,
    /// Squares of the torques and of what the springs lacked in the last pass.
    change: Lanes<S>,
    size: Lanes<S>,
    simd: S,
}

impl<S: Simd> LoadedLimb<S> {
    pub fn new(simd: S, plan: &Plan) -> Self {
        let zero = Lanes::new(simd, 0.0);
        let place = Place {
            axis: [zero; 3],
            origin: [zero; 3],
        };
        let masses = plan.steps.iter().filter(|s| matches!(s, Step::Mass { .. }));
        Self {
            coordinates: vec![zero; plan.coordinates],
            commands: vec![zero; plan.commands],
            torque: vec![zero; plan.coordinates],
            wrench: [zero; 6],
            places: vec![place; plan.screws.len()],
            masses: vec![[zero; 3]; masses.count()],
            rotation: identity(simd),
            point: [zero; 3],
            laws: Vec::new(),
            largest: zero,
            change: zero,
            size: zero,
            simd,
        }
    }

    /// Unloaded, with these joints.
    #[inline(always)]
    pub fn start(&mut self, plan: &Plan, commands: &[Lanes<S>], passive: &[Lanes<S>]) {
        let zero = Lanes::new(self.simd, 0.0);
        self.commands.copy_from_slice(commands);
        self.coordinates.fill(zero);
        self.torque.fill(zero);
        self.wrench = [zero; 6];
        for (own, x) in plan.passive.iter().zip(passive) {
            self.coordinates[*own] = *x;
        }
        self.laws.clear();
        for step in &plan.steps {
            if let Step::Spring(spring) = step
                && let Law::Parallelogram(bars, slot) = &spring.law
            {
                let own = law::parallelogram(self.simd, bars, passive[*slot]);
                self.laws.push(own);
            }
        }
    }

    /// Frames at the present coordinates.
    #[inline(always)]
    pub fn outwards(&mut self, plan: &Plan) {
        let simd = self.simd;
        {
            self.rotation = identity(simd);
            self.point = [Lanes::new(simd, 0.0); 3];
            let mut mass = 0;
            for step in &plan.steps {
                match step {
                    Step::Shift(l) => {
                        self.point = carried(&self.rotation, &constant(simd, l), &self.point);
                    }
                    Step::Rotate(r) => {
                        let r = r.map(|x| Lanes::new(simd, x));
                        self.rotation = product(&self.rotation, &r);
                    }
                    Step::Joint(joint) => match joint.axis {
                        0 => self.joint::<0>(joint),
                        1 => self.joint::<1>(joint),
                        _ => self.joint::<2>(joint),
                    },
                    Step::Spring(spring) => self.spring(spring),
                    Step::Mass { at, .. } => {
                        self.masses[mass] =
                            carried(&self.rotation, &constant(simd, at), &self.point);
                        mass += 1;
                    }
                }
            }
        }
    }

    #[inline(always)]
    fn joint<const AXIS: usize>(&mut self, joint: &Joint) {
        let coordinate = match joint.amount.coordinate {
            Some((own, _)) => Some(self.coordinates[own]),
            None => None,
        };
        let amount = amount(self.simd, &joint.amount, &self.commands, coordinate);
        let axis = column(&self.rotation, AXIS);
        self.places[joint.screw] = Place {
            axis,
            origin: self.point,
        };
        match joint.kind {
            MotionKind::Revolute => {
                let (s, c) = amount.sin_cos();
                turn_columns::<S, AXIS>(&mut self.rotation, s, c);
            }
            MotionKind::Prismatic => {
                for k in 0..3 {
                    self.point[k] = axis[k].times_plus(amount, self.point[k]);
                }
            }
        }
    }

    #[inline(always)]
    fn spring(&mut self, spring: &Spring) {
        let zero = Lanes::new(self.simd, 0.0);
        let value = |d: usize| spring.coordinates[d].map_or(zero, |own| self.coordinates[own]);
        let l = [value(0), value(1), value(2)];
        let turns = [value(3), value(4), value(5)];
        let mut screw = spring.screw;
        for k in 0..3 {
            if spring.coordinates[k].is_some() {
                self.places[screw].axis = column(&self.rotation, k);
                screw += 1;
            }
        }
        self.point = carried(&self.rotation, &l, &self.point);
        for k in 0..3 {
            if spring.coordinates[3 + k].is_none() {
                continue;
            }
            self.places[screw] = Place {
                axis: column(&self.rotation, k),
                origin: self.point,
            };
            screw += 1;
            let (s, c) = turns[k].sin_cos_near_zero();
            match k {
                0 => turn_columns::<S, 0>(&mut self.rotation, s, c),
                1 => turn_columns::<S, 1>(&mut self.rotation, s, c),
                _ => turn_columns::<S, 2>(&mut self.rotation, s, c),
            }
        }
    }

    /// Torques of the wrench at the tip and of the weights, where the limb lies; then the springs
    /// follow in the lanes where `active` is one.
    #[inline(always)]
    pub fn inwards(&mut self, plan: &Plan, gravity: &[f64; 3], active: Lanes<S>) {
        let simd = self.simd;
        {
            let zero = Lanes::new(simd, 0.0);
            let gravity = constant(simd, gravity);
            let [fx, fy, fz, mx, my, mz] = self.wrench;
            let mut force = [fx, fy, fz];
            // About the base's origin.
            let lever = cross(&self.point, &force);
            let mut moment = [mx + lever[0], my + lever[1], mz + lever[2]];
            (self.change, self.size, self.largest) = (zero, zero, zero);
            let (mut mass, mut law) = (self.masses.len(), self.laws.len());
            for step in plan.steps.iter().rev() {
                match step {
                    Step::Mass { mass: m, .. } => {
                        mass -= 1;
                        let weight = gravity.map(|g| g * *m);
                        let own = cross(&self.masses[mass], &weight);
                        for k in 0..3 {
                            force[k] = force[k] + weight[k];
                            moment[k] = moment[k] + own[k];
                        }
                    }
                    Step::Joint(joint) => {
                        let Some((own, ratio)) = joint.amount.coordinate else {
                            continue;
                        };
                        let Place { axis, origin } = &self.places[joint.screw];
                        let torque = match joint.kind {
                            MotionKind::Prismatic => dot(axis, &force),
                            MotionKind::Revolute => {
                                dot(axis, &minus(&moment, &cross(origin, &force)))
                            }
                        } * ratio;
                        match joint.held {
                            Held::Spring(compliance) => {
                                self.bears(own, torque, self.torque[own], active);
                                self.follows(own, torque * compliance, active);
                            }
                            // Several motions may belong to one passive joint: see `clear`.
                            _ => self.torque[own] = self.torque[own] + torque,
                        }
                    }
                    Step::Spring(spring) => {
                        if matches!(spring.law, Law::Parallelogram(..)) {
                            law -= 1;
                        }
                        self.spring_follows(spring, law, &force, &moment, active);
                    }
                    Step::Shift(_) | Step::Rotate(_) => {}
                }
            }
        }
    }

    /// Forgets the torques of the passive joints, which are summed up.
    #[inline(always)]
    pub fn clear(&mut self, plan: &Plan) {
        for own in &plan.passive {
            self.torque[*own] = Lanes::new(self.simd, 0.0);
        }
    }

    /// The torque on a coordinate is `torque` now; its spring bears `borne`.
    #[inline(always)]
    fn bears(&mut self, own: usize, torque: Lanes<S>, borne: Lanes<S>, active: Lanes<S>) {
        let change = torque - borne;
        self.change = change.times_plus(change, self.change);
        self.size = torque.times_plus(torque, self.size);
        self.torque[own] = select(active, torque, self.torque[own]);
    }

    #[inline(always)]
    fn follows(&mut self, own: usize, to: Lanes<S>, active: Lanes<S>) {
        self.coordinates[own] = select(active, to, self.coordinates[own]);
    }

    #[inline(always)]
    fn spring_follows(
        &mut self,
        spring: &Spring,
        law: usize,
        force: &Vec3<S>,
        moment: &Vec3<S>,
        active: Lanes<S>,
    ) {
        let zero = Lanes::new(self.simd, 0.0);
        let (mut torque, mut from) = ([zero; 6], [zero; 6]);
        let mut screw = spring.screw;
        let mut about = None;
        for d in 0..6 {
            let Some(own) = spring.coordinates[d] else {
                continue;
            };
            let Place { axis, origin } = &self.places[screw];
            screw += 1;
            torque[d] = if d < 3 {
                dot(axis, force)
            } else {
                let m = about.get_or_insert_with(|| minus(moment, &cross(origin, force)));
                dot(axis, m)
            };
            from[d] = self.coordinates[own];
        }
        // What the spring bears now, and the step or place that its compliance is multiplied with.
        let (mut borne, mut lacks) = ([zero; 6], torque);
        for d in 0..6 {
            borne[d] = spring.coordinates[d].map_or(zero, |own| self.torque[own]);
        }
        if let Law::Bowing(length) = spring.law {
            let square;
            (borne, square) = law::bowing(self.simd, &spring.stiffness, length, &from);
            self.largest = self.largest.max(square);
            for d in 0..6 {
                lacks[d] = torque[d] - borne[d];
            }
        } else {
            from = [zero; 6];
        }
        let own = match spring.law {
            Law::Parallelogram(..) => self.laws[law].times(&lacks),
            Law::Constant | Law::Bowing(_) => {
                let mut sums = [zero; 6];
                for d in 0..6 {
                    for k in 0..6 {
                        let c = lacks[k].same(spring.compliance[6 * d + k]);
                        sums[d] = lacks[k].times_plus(c, sums[d]);
                    }
                }
                sums
            }
        };
        for d in 0..6 {
            if let Some(place) = spring.coordinates[d] {
                self.bears(place, torque[d], borne[d], active);
                self.follows(place, from[d] + own[d], active);
            }
        }
    }

    /// One in the lanes where the torques still change.
    #[inline(always)]
    fn moving(&self) -> Lanes<S> {
        let one = Lanes::new(self.simd, 1.0);
        let allowed = self.size * (TOLERANCE * TOLERANCE);
        allowed.where_less(self.change, one, one.same(0.0))
    }

    /// One where every spring turns little enough and all numbers are numbers.
    #[inline(always)]
    pub fn sound(&self, plan: &Plan) -> Lanes<S> {
        let one = Lanes::new(self.simd, 1.0);
        let mut most = one.same(0.0);
        for step in &plan.steps {
            if let Step::Spring(spring) = step {
                for own in spring.coordinates[3..].iter().flatten() {
                    let x = self.coordinates[*own].abs();
                    most = x.where_less(one * MOST_TURN, most, one);
                }
            }
        }
        let within = self
            .largest
            .where_less(one * law::MOST_SQUARE, one, one.same(0.0));
        (one - most) * within
    }
}

/// Equilibrium of a serial limb under a dead wrench at its tip: one in the lanes that are done.
#[inline(always)]
pub(super) fn serial<S: Simd>(
    simd: S,
    plan: &Plan,
    limb: &mut LoadedLimb<S>,
    wrench: [Lanes<S>; 6],
    gravity: &[f64; 3],
) -> Lanes<S> {
    let one = Lanes::new(simd, 1.0);
    let mut active = one;
    limb.wrench = wrench;
    for pass in 0..=MOST_PASSES {
        limb.outwards(plan);
        if pass == MOST_PASSES || active.all_less(0.5) {
            break;
        }
        limb.inwards(plan, gravity, active);
        active = active * limb.moving();
    }
    (one - active) * limb.sound(plan)
}

/// Limbs that hold one platform.
pub(super) struct Held6<'a, S: Simd> {
    pub plans: &'a [Plan],
    pub limbs: &'a mut [LoadedLimb<S>],
    /// Unloaded compliance of every limb.
    pub factors: &'a [Eliminated<S>],
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
            limb.0.outwards(limb.1);
        }
        for _ in 0..MOST_PASSES {
            active = self.pass(simd, wrench, active);
            if active.all_less(0.5) {
                break;
            }
        }
        let mut done = one - active;
        for (limb, plan) in self.limbs.iter().zip(self.plans) {
            done = done * limb.sound(plan);
        }
        done
    }

    #[inline(always)]
    fn pass(&mut self, simd: S, wrench: &[Lanes<S>; 6], active: Lanes<S>) -> Lanes<S> {
        let (zero, one) = (Lanes::new(simd, 0.0), Lanes::new(simd, 1.0));
        let mut moving = zero;
        // What the limbs lack, to first order, with the platform where it is.
        let weight = self.gravity.map(|g| one * (g * self.body.1));
        let arm = carried(&self.rotation, &constant(simd, &self.body.0), &[zero; 3]);
        let lever = cross(&arm, &weight);
        let mut lacks = *wrench;
        for k in 0..3 {
            lacks[k] = lacks[k] + weight[k];
            lacks[3 + k] = lacks[3 + k] + lever[k];
        }
        for ((limb, plan), factors) in self.limbs.iter_mut().zip(self.plans).zip(self.factors) {
            limb.clear(plan);
            limb.inwards(plan, &self.gravity, active);
            limb.outwards(plan);
            let gap = gap(limb, plan, &self.rotation, &self.point);
            for x in gap {
                // A share of the natural length, or rad.
                moving = (one * TOLERANCE).where_less(x.abs(), one, moving);
            }
            moving = moving.max(limb.moving());
            let (step, _) = correction(simd, limb, plan, factors, gap);
            for k in 0..6 {
                lacks[k] = lacks[k] - limb.wrench[k] - step[k];
            }
        }
        let motion = self.compliance.times(&lacks);
        for ((limb, plan), factors) in self.limbs.iter_mut().zip(self.plans).zip(self.factors) {
            let mut gap = gap(limb, plan, &self.rotation, &self.point);
            for k in 0..3 {
                gap[k] = motion[k].times_plus(one * (1.0 / plan.length), gap[k]);
                gap[3 + k] = gap[3 + k] + motion[3 + k];
            }
            let (step, joints) = correction(simd, limb, plan, factors, gap);
            let (mut change, mut size) = (zero, zero);
            for k in 0..6 {
                let unit = if k < 3 { plan.length } else { 1.0 };
                let (x, w) = (step[k] * unit, (limb.wrench[k] + step[k]) * unit);
                change = x.times_plus(x, change);
                size = w.times_plus(w, size);
            }
            let allowed = size * (TOLERANCE * TOLERANCE);
            moving = allowed.where_less(change, one, moving);
            for k in 0..6 {
                limb.wrench[k] = select(active, limb.wrench[k] + step[k], limb.wrench[k]);
            }
            for (own, dq) in plan.passive.iter().zip(joints) {
                let x = limb.coordinates[*own];
                limb.coordinates[*own] = select(active, x + dq, x);
            }
        }
        let turned = turned(simd, &[motion[3], motion[4], motion[5]], &self.rotation);
        for k in 0..3 {
            self.point[k] = select(active, self.point[k] + motion[k], self.point[k]);
        }
        for k in 0..9 {
            self.rotation[k] = select(active, turned[k], self.rotation[k]);
        }
        active * moving
    }
}

#[inline(always)]
pub(super) fn select<S: Simd>(active: Lanes<S>, yes: Lanes<S>, no: Lanes<S>) -> Lanes<S> {
    active.where_less(active.same(0.5), no, yes)
}

/// From a limb's tip to the platform, balanced: share of the natural length, rad.
#[inline(always)]
fn gap<S: Simd>(limb: &LoadedLimb<S>, plan: &Plan, to: &Mat3<S>, point: &Vec3<S>) -> [Lanes<S>; 6] {
    let l = minus(point, &limb.point).map(|x| x * (1.0 / plan.length));
    let a = turn_between(to, &limb.rotation);
    [l[0], l[1], l[2], a[0], a[1], a[2]]
}

/// Change of a limb's wrench (N, N m) and of its passive joints that closes a gap and frees the joints of torque.
#[inline(always)]
fn correction<S: Simd>(
    simd: S,
    limb: &LoadedLimb<S>,
    plan: &Plan,
    factors: &Eliminated<S>,
    gap: [Lanes<S>; 6],
) -> ([Lanes<S>; 6], [Lanes<S>; 6]) {
    let zero = Lanes::new(simd, 0.0);
    let mut torque = [zero; 6];
    for (x, own) in torque.iter_mut().zip(&plan.passive) {
        *x = -limb.torque[*own];
    }
    let mut joints = [zero; 6];
    let mut wrench = factors.answer(simd, gap, &torque, &mut joints);
    for x in &mut wrench[..3] {
        *x = *x * (1.0 / plan.length);
    }
    (wrench, joints)
}

/// `exp(hat(v)) R` for a small rotation vector.
#[inline(always)]
pub(super) fn turned<S: Simd>(simd: S, v: &Vec3<S>, r: &Mat3<S>) -> Mat3<S> {
    let z = dot(v, v);
    let a = z.polynomial(&[1.0 / 362_880.0, -1.0 / 5040.0, 1.0 / 120.0, -1.0 / 6.0, 1.0]);
    let b = z.polynomial(&[
        1.0 / 3_628_800.0,
        -1.0 / 40_320.0,
        1.0 / 720.0,
        -1.0 / 24.0,
        0.5,
    ]);
    let mut out = *r;
    let _ = simd;
    for k in 0..3 {
        let own = column(r, k);
        let once = cross(v, &own);
        let twice = cross(v, &once);
        for i in 0..3 {
            out[3 * i + k] = b.times_plus(twice[i], a.times_plus(once[i], own[i]));
        }
    }
    out
}

/// Twist of a limb's tip per unit of a motion, base axes.
#[inline(always)]
pub(super) fn twist<S: Simd>(limb: &LoadedLimb<S>, plan: &Plan, screw: usize) -> [Lanes<S>; 6] {
    let Place { axis, origin } = &limb.places[screw];
    match plan.screws[screw].kind {
        MotionKind::Revolute => {
            let v = cross(axis, &minus(&limb.point, origin));
            [v[0], v[1], v[2], axis[0], axis[1], axis[2]]
        }
        MotionKind::Prismatic => {
            let zero = axis[0].same(0.0);
            [axis[0], axis[1], axis[2], zero, zero, zero]
        }
    }
}
