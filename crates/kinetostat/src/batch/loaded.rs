//! Equilibrium under load, several postures at once.
//!
//! The torques of a chain depend on its deflections weakly: `theta <- K^-1 tau(theta)` [R 4.16] contracts by
//! about the share of the geometric stiffness in the springs', and needs no matrix. One pass walks
//! out (where the tip is, which way gravity points) and back (torques). On the way back force and moment
//! are kept in the axes and about the origin of the frame reached, so that the torque on a coordinate is
//! one of their components. Where limbs hold a platform together, wrenches, passive joints
//! and the platform are corrected in each pass by the unloaded machine's own compliance, factored
//! once ([`super::eliminate`]). Contraction is watched: a lane that is not done after
//! [`MOST_PASSES`] is left to Newton's ([`super::newton`]).

use pulp::Simd;

use super::apart::apart;
use super::lanes::{Lanes, MOST_SQUARE};
use super::law;
use super::place::{Place, amount};
use super::plan::{Held, Joint, Law, Plan, Spring, Step};
use super::symmetric::Symmetric;
use super::vectors::{
    Mat3, Vec3, carried, column, column_of, component, constant, identity, matrix, product, select,
    shifted, turn_columns,
};
use super::wrenches::{Mat6, back, lever, rotated_back, slid, times};
use crate::spatial::MotionKind;

/// Passes after which a lane is given up. One of [`MOST_CONTRACTION`] is done in thirty.
pub(super) const MOST_PASSES: usize = 30;
/// Relative change of the torques that the next pass would bring when a lane is done: rounding.
pub(super) const TOLERANCE: f64 = 1e-13;
/// And the most that the last pass has brought, however fast the passes contract.
const LAST_CHANGE: f64 = 1e-10;
/// Springs turn less than this, rad: see [`sin_cos_small`].
pub(super) const MOST_TURN: f64 = 0.1;

/// A limb on its way to equilibrium.
pub(super) struct LoadedLimb<S: Simd> {
    /// Springs' deflections and passive joints, by coordinate.
    pub coordinates: Vec<Lanes<S>>,
    pub commands: Vec<Lanes<S>>,
    /// Torque on every coordinate.
    pub torque: Vec<Lanes<S>>,
    /// Of the platform on the limb's tip, about the tip, base axes.
    pub wrench: [Lanes<S>; 6],
    /// Of every motion, where [`Self::frames`] has looked.
    pub places: Vec<Place<S>>,
    /// Centres of the masses, where [`Self::frames`] has looked.
    pub masses: Vec<Vec3<S>>,
    pub rotation: Mat3<S>,
    pub point: Vec3<S>,
    /// Sine and cosine of every rotation, length of every other motion of a joint.
    pub moved: Vec<[Lanes<S>; 2]>,
    /// Gravity at every mass, m/s^2, axes of the frame there.
    pub gravity: Vec<Vec3<S>>,
    /// Of the springs that depend on the commanded posture, in the order of the steps.
    pub laws: Vec<Symmetric<S>>,
    /// Springs are deflected. The first pass finds them as they are drawn.
    pub bent: bool,
    /// One in the lanes where springs may turn more than [`sin_cos_small`] knows, if there are any.
    pub far: Option<Lanes<S>>,
    /// Of the last pass.
    tally: Tally<S>,
    /// Square of the change in the one before.
    before: Lanes<S>,
    simd: S,
}

/// What a pass finds, summed up over the springs.
#[derive(Clone, Copy)]
struct Tally<S: Simd> {
    /// Squares of the torques and of their changes.
    size: Lanes<S>,
    change: Lanes<S>,
    /// Largest square of a rotation of a spring whose law is a series.
    largest: Lanes<S>,
}

impl<S: Simd> LoadedLimb<S> {
    pub fn new(simd: S, plan: &Plan) -> Self {
        let zero = Lanes::new(simd, 0.0);
        let place = Place {
            axis: [zero; 3],
            origin: [zero; 3],
        };
        let masses = plan.steps.iter().filter(|s| matches!(s, Step::Mass { .. }));
        let masses = vec![[zero; 3]; masses.count()];
        Self {
            coordinates: vec![zero; plan.coordinates],
            commands: vec![zero; plan.commands],
            torque: vec![zero; plan.coordinates],
            wrench: [zero; 6],
            places: vec![place; plan.screws.len()],
            gravity: masses.clone(),
            masses,
            rotation: identity(simd),
            point: [zero; 3],
            moved: vec![[zero; 2]; plan.screws.len()],
            laws: Vec::new(),
            bent: false,
            far: None,
            tally: Tally {
                size: zero,
                change: zero,
                largest: zero,
            },
            before: zero,
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
        (self.bent, self.far, self.tally.change) = (false, None, zero);
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

    /// Where the tip is at the present coordinates, and which way gravity points at the masses.
    #[inline(always)]
    pub fn outwards(&mut self, plan: &Plan, gravity: &[f64; 3]) {
        self.forward::<false>(plan, gravity);
    }

    /// The same, with the places of all motions and masses.
    #[inline(always)]
    pub fn frames(&mut self, plan: &Plan, gravity: &[f64; 3]) {
        self.forward::<true>(plan, gravity);
    }

    #[inline(always)]
    fn forward<const PLACES: bool>(&mut self, plan: &Plan, gravity: &[f64; 3]) {
        apart!(self.simd, {
            let simd = self.simd;
            let mut r = identity(simd);
            let mut p = [Lanes::new(simd, 0.0); 3];
            let mut mass = 0;
            for step in &plan.steps {
                match step {
                    Step::Shift(l) => shifted(&r, l, &mut p),
                    Step::Rotate(by) => r = product(&r, &matrix(simd, by)),
                    Step::Joint(joint) => {
                        if PLACES {
                            self.places[joint.screw] = Place {
                                axis: column_of(&r, joint.axis),
                                origin: p,
                            };
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
                    self.places[screw] = Place {
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

    /// Torques of the wrench at the tip and of the weights, where the limb lies; then the springs
    /// follow in the lanes where `active` is one.
    #[inline(always)]
    pub fn inwards(&mut self, plan: &Plan, active: Lanes<S>) {
        apart!(self.simd, {
            let zero = Lanes::new(self.simd, 0.0);
            let (mut force, mut moment) = self.at_tip();
            let mut tally = Tally {
                size: zero,
                change: zero,
                largest: zero,
            };
            let (mut mass, mut law) = (self.gravity.len(), self.laws.len());
            for step in plan.steps.iter().rev() {
                match step {
                    Step::Mass { at, mass: m } => {
                        mass -= 1;
                        self.weight(mass, at, *m, &mut force, &mut moment);
                    }
                    Step::Shift(l) => lever(l, &force, &mut moment),
                    Step::Rotate(by) => rotated_back(self.simd, by, &mut force, &mut moment),
                    Step::Joint(joint) => {
                        let torque = self.joint_bears(joint, &mut force, &mut moment);
                        self.joint_follows(joint, torque, active, &mut tally);
                    }
                    Step::Spring(spring) => {
                        if matches!(spring.law, Law::Parallelogram(..)) {
                            law -= 1;
                        }
                        let torque = self.spring_bears(spring, &mut force, &mut moment);
                        self.spring_follows(spring, law, torque, active, &mut tally);
                    }
                }
            }
            self.before = self.tally.change;
            self.tally = tally;
            self.bent = true;
        })
    }

    /// Force and moment of the platform on the tip, in the axes and about the origin of the frame there.
    /// The passes back keep what is beyond the place reached in the frame there.
    #[inline(always)]
    pub fn at_tip(&self) -> (Vec3<S>, Vec3<S>) {
        let zero = Lanes::new(self.simd, 0.0);
        let (mut force, mut moment) = ([zero; 3], [zero; 3]);
        for k in 0..3 {
            for i in 0..3 {
                force[k] = self.rotation[3 * i + k].times_plus(self.wrench[i], force[k]);
                moment[k] = self.rotation[3 * i + k].times_plus(self.wrench[3 + i], moment[k]);
            }
        }
        (force, moment)
    }

    /// Adds the weight of a mass with its centre at `at`.
    #[inline(always)]
    pub fn weight(
        &self,
        mass: usize,
        at: &[f64; 3],
        kilograms: f64,
        force: &mut Vec3<S>,
        moment: &mut Vec3<S>,
    ) -> Vec3<S> {
        let mut weight = self.gravity[mass];
        for k in 0..3 {
            weight[k] = weight[k] * kilograms;
            force[k] = force[k] + weight[k];
        }
        lever(at, &weight, moment);
        weight
    }

    /// What a joint bears along its motion; force and moment go on to where it begins.
    #[inline(always)]
    pub fn joint_bears(
        &self,
        joint: &Joint,
        force: &mut Vec3<S>,
        moment: &mut Vec3<S>,
    ) -> Lanes<S> {
        let [s, c] = self.moved[joint.screw];
        match joint.kind {
            MotionKind::Prismatic => {
                slid(joint.axis, s, force, moment);
                component(force, joint.axis)
            }
            MotionKind::Revolute => {
                back(joint.axis, s, c, force, moment);
                component(moment, joint.axis)
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

    #[inline(always)]
    fn joint_follows(
        &mut self,
        joint: &Joint,
        torque: Lanes<S>,
        active: Lanes<S>,
        tally: &mut Tally<S>,
    ) {
        let Some((own, ratio)) = joint.amount.coordinate else {
            return;
        };
        match joint.held {
            Held::Spring(compliance) => {
                let torque = torque * ratio;
                self.bears(own, torque, self.torque[own], tally);
                let to = match &joint.law {
                    Some(law) => law::single_deflection(law, torque),
                    None => torque * compliance,
                };
                self.follows(own, to, active);
            }
            // Several motions may belong to one passive joint: see `clear`.
            _ => self.torque[own] = torque.times_plus(torque.same(ratio), self.torque[own]),
        }
    }

    /// The torque on a coordinate is `torque` now; its spring bears `borne`.
    #[inline(always)]
    fn bears(&mut self, own: usize, torque: Lanes<S>, borne: Lanes<S>, tally: &mut Tally<S>) {
        let change = torque - borne;
        tally.change = change.times_plus(change, tally.change);
        tally.size = torque.times_plus(torque, tally.size);
        self.torque[own] = torque;
    }

    #[inline(always)]
    fn follows(&mut self, own: usize, to: Lanes<S>, active: Lanes<S>) {
        self.coordinates[own] = select(active, to, self.coordinates[own]);
    }

    /// Tangent stiffness of the spring of a joint, whose compliance at rest is `c`.
    #[inline(always)]
    pub fn joint_stiffness(&self, joint: &Joint, own: usize, c: f64) -> Lanes<S> {
        match &joint.law {
            Some(law) => law::single_tangent(law, self.coordinates[own]),
            None => Lanes::new(self.simd, 1.0 / c),
        }
    }

    /// Torques on a spring; force and moment go on to where it begins.
    #[inline(always)]
    pub fn spring_bears(
        &self,
        spring: &Spring,
        force: &mut Vec3<S>,
        moment: &mut Vec3<S>,
    ) -> [Lanes<S>; 6] {
        let zero = Lanes::new(self.simd, 0.0);
        let mut torque = [zero; 6];
        let mut screw = spring.screw + spring.moving;
        for i in 0..3 {
            let k = 2 - i;
            torque[3 + k] = moment[k];
            if spring.coordinates[3 + k].is_some() && self.bent {
                screw -= 1;
                let [s, c] = self.moved[screw];
                back(k, s, c, force, moment);
            }
        }
        torque[..3].copy_from_slice(force);
        if self.bent {
            for k in 0..3 {
                if let Some(own) = spring.coordinates[k] {
                    slid(k, self.coordinates[own], force, moment);
                }
            }
        }
        torque
    }

    #[inline(always)]
    fn spring_follows(
        &mut self,
        spring: &Spring,
        law: usize,
        torque: [Lanes<S>; 6],
        active: Lanes<S>,
        tally: &mut Tally<S>,
    ) {
        let zero = Lanes::new(self.simd, 0.0);
        // Where the spring is, what it bears there, and what its compliance is multiplied with.
        let (mut from, mut borne, mut residual) = ([zero; 6], [zero; 6], torque);
        if let Law::Curved(law, _) = &spring.law {
            for d in 0..6 {
                if let Some(own) = spring.coordinates[d] {
                    from[d] = self.coordinates[own];
                }
            }
            let square;
            (borne, square) = law::torque(law, &from);
            tally.largest = tally.largest.max(square);
            for d in 0..6 {
                residual[d] = torque[d] - borne[d];
            }
        } else {
            for d in 0..6 {
                if let Some(own) = spring.coordinates[d] {
                    borne[d] = self.torque[own];
                }
            }
        }
        let step = match &spring.law {
            Law::Parallelogram(..) => self.laws[law].times(&residual),
            Law::Constant | Law::Curved(..) => times(&spring.compliance, &residual),
        };
        for d in 0..6 {
            if let Some(own) = spring.coordinates[d] {
                self.bears(own, torque[d], borne[d], tally);
                self.follows(own, from[d] + step[d], active);
            }
        }
    }

    /// One in the lanes where the next pass would still change the torques. If passes contract by a
    /// ratio, the next change is that ratio times the last one.
    #[inline(always)]
    pub fn moving(&self, rounding: Lanes<S>) -> Lanes<S> {
        let one = Lanes::new(self.simd, 1.0);
        let Tally { size, change, .. } = self.tally;
        let most = (size * (LAST_CHANGE * LAST_CHANGE)).max(rounding);
        let moving = most.where_less(change, one, one.same(0.0));
        let allowed = (self.before * size * (TOLERANCE * TOLERANCE)).max(rounding * rounding);
        allowed.where_less(change * change, one, moving)
    }

    /// One in the lanes where the last pass has brought more than this share of the one before.
    #[inline(always)]
    pub fn slower_than(&self, share: f64) -> Lanes<S> {
        let one = Lanes::new(self.simd, 1.0);
        let most = self.before * (share * share);
        most.where_less(self.tally.change, one, one.same(0.0))
    }

    /// One where every spring turns less than so much (rad) and all numbers are numbers.
    #[inline(always)]
    pub fn sound(&self, plan: &Plan, turn: f64) -> Lanes<S> {
        let one = Lanes::new(self.simd, 1.0);
        let mut most = one.same(0.0);
        for step in &plan.steps {
            if let Step::Spring(spring) = step {
                for k in 3..6 {
                    if let Some(own) = spring.coordinates[k] {
                        let x = self.coordinates[own].abs();
                        most = x.where_less(one * turn, most, one);
                    }
                }
            }
        }
        let within = self
            .tally
            .largest
            .where_less(one * MOST_SQUARE, one, one.same(0.0));
        (one - most) * within
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

/// Twist of a limb's tip per unit of a motion, base axes.
#[inline(always)]
pub(super) fn twist<S: Simd>(limb: &LoadedLimb<S>, plan: &Plan, screw: usize) -> [Lanes<S>; 6] {
    limb.places[screw].twist(plan.screws[screw].kind, &limb.point)
}

/// Coordinates of a spring in the six directions.
#[inline(always)]
pub(super) fn deflection<S: Simd>(limb: &LoadedLimb<S>, spring: &Spring) -> [Lanes<S>; 6] {
    let mut at = [limb.wrench[0] * 0.0; 6];
    for d in 0..6 {
        if let Some(own) = spring.coordinates[d] {
            at[d] = limb.coordinates[own];
        }
    }
    at
}

/// Twists of a spring's six directions at the tip's place; zero where a direction does not move.
#[inline(always)]
pub(super) fn twists<S: Simd>(
    simd: S,
    plan: &Plan,
    limb: &LoadedLimb<S>,
    spring: &Spring,
) -> Mat6<S> {
    let mut s = [[Lanes::new(simd, 0.0); 6]; 6];
    let mut screw = spring.screw;
    for d in 0..6 {
        if spring.coordinates[d].is_some() {
            s[d] = twist(limb, plan, screw);
            screw += 1;
        }
    }
    s
}
