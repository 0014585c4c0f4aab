//! A limb swept from the tip to the base: what its parts bear, and how far they follow.

use pulp::Simd;

use crate::batch::limb::law;
use crate::batch::limb::loaded::{LoadedLimb, Motion, Tally};
use crate::batch::numbers::instruction_set::apart;
use crate::batch::numbers::lanes::Lanes;
use crate::batch::numbers::vectors::{Vec3, component, cross};
use crate::batch::numbers::wrenches::{back, lever, rotated_back, slid};
use crate::batch::plan::steps::{Joint, Law, Plan, Spring, Step, Support};
use crate::spatial::MotionKind;

/// State of an inward pass at a place.
#[derive(Clone, Copy)]
struct Reached<S: Simd> {
    force: Vec3<S>,
    moment: Vec3<S>,
    motion: Motion<S>,
    tally: Tally<S>,
}

impl<S: Simd> LoadedLimb<S> {
    /// Torques of the wrench at the tip and of the weights, where the limb lies; then the springs
    /// follow in the lanes where `active` is one.
    #[inline(always)]
    pub fn inwards(&mut self, plan: &Plan, active: Lanes<S>) {
        self.backward::<false>(plan, active);
    }

    /// Passes inwards and returns the motion of the tip (m, rad, base axes), to first order: the limb is not swept
    /// outwards again.
    #[inline(always)]
    pub fn inwards_moving(&mut self, plan: &Plan, active: Lanes<S>) -> [Lanes<S>; 6] {
        self.backward::<true>(plan, active);
        let Motion { turn, shift } = self.motion;
        let arm = cross(&turn, &self.point);
        let [x, y, z] = [0, 1, 2].map(|k| shift[k] + arm[k]);
        [x, y, z, turn[0], turn[1], turn[2]]
    }

    #[inline(always)]
    fn backward<const MOVING: bool>(&mut self, plan: &Plan, active: Lanes<S>) {
        apart!(self.simd, {
            let zero = Lanes::new(self.simd, 0.0);
            let (mut force, mut moment) = self.at_tip();
            let mut tally = Tally {
                size: zero,
                change: zero,
                largest: zero,
            };
            // Motion of the tip as the frame reached sees it: a twist is transported as a wrench is.
            let mut motion = Motion {
                turn: [zero; 3],
                shift: [zero; 3],
            };
            let (mut mass, mut law) = (self.gravity.len(), self.laws.len());
            for step in plan.steps.iter().rev() {
                match step {
                    Step::Mass { at, mass: m } => {
                        mass -= 1;
                        self.weight(mass, at, *m, &mut force, &mut moment);
                    }
                    Step::Shift(l) => {
                        lever(l, &force, &mut moment);
                        if MOVING {
                            lever(l, &motion.turn, &mut motion.shift);
                        }
                    }
                    Step::Rotate(by) => {
                        rotated_back(self.simd, by, &mut force, &mut moment);
                        if MOVING {
                            let Motion { turn, shift } = &mut motion;
                            rotated_back(self.simd, by, turn, shift);
                        }
                    }
                    Step::Joint(joint) => {
                        let torque = self.joint_bears(joint, &mut force, &mut moment);
                        let gone = self.joint_follows(joint, torque, active, &mut tally);
                        if MOVING {
                            self.joint_carries(joint, gone, &mut motion);
                        }
                    }
                    // Apart, on copies: the sweeps of other limbs keep their numbers in registers.
                    Step::Spring(spring) if spring.own_weight.is_some() => {
                        let at = Reached {
                            force,
                            moment,
                            motion,
                            tally,
                        };
                        let at = self.segment::<MOVING>(spring, active, at);
                        (force, moment) = (at.force, at.moment);
                        (motion, tally) = (at.motion, at.tally);
                    }
                    Step::Spring(spring) => {
                        if matches!(spring.law, Law::Parallelogram(..)) {
                            law -= 1;
                        }
                        let torque = self.spring_bears(spring, &mut force, &mut moment);
                        let gone = self.spring_follows(spring, law, torque, active, &mut tally);
                        if MOVING {
                            self.spring_carries(spring, &gone, &mut motion);
                        }
                    }
                }
            }
            self.motion = motion;
            self.before = self.tally.change;
            self.tally = tally;
            self.bent = true;
        })
    }

    /// Goes along the spring of a segment with a mass along it.
    #[inline(always)]
    fn segment<const MOVING: bool>(
        &mut self,
        spring: &Spring,
        active: Lanes<S>,
        mut at: Reached<S>,
    ) -> Reached<S> {
        apart!(self.simd, {
            let mut torque = self.spring_bears(spring, &mut at.force, &mut at.moment);
            self.own_weight(spring, &mut torque, &mut at.moment);
            // Segments have no laws by posture.
            let gone = self.spring_follows(spring, 0, torque, active, &mut at.tally);
            if MOVING {
                self.spring_carries(spring, &gone, &mut at.motion);
            }
            at
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

    /// Load on a joint along its motion; force and moment are transported to its start.
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

    /// The motion of the tip beyond a joint that has gone so far, as the frame before it sees it.
    #[inline(always)]
    fn joint_carries(&self, joint: &Joint, gone: Lanes<S>, motion: &mut Motion<S>) {
        let Motion { turn, shift } = motion;
        let [s, c] = self.moved[joint.screw];
        let to = match joint.kind {
            MotionKind::Prismatic => {
                slid(joint.axis, s, turn, shift);
                shift
            }
            MotionKind::Revolute => {
                back(joint.axis, s, c, turn, shift);
                turn
            }
        };
        match joint.axis {
            0 => to[0] = to[0] + gone,
            1 => to[1] = to[1] + gone,
            _ => to[2] = to[2] + gone,
        }
    }

    /// Change of the joint's displacement.
    #[inline(always)]
    fn joint_follows(
        &mut self,
        joint: &Joint,
        torque: Lanes<S>,
        active: Lanes<S>,
        tally: &mut Tally<S>,
    ) -> Lanes<S> {
        let Some((own, ratio)) = joint.amount.coordinate else {
            return torque.same(0.0);
        };
        match joint.support {
            Support::Spring(compliance) => {
                let torque = torque * ratio;
                self.bears(own, torque, self.torque[own], tally);
                let to = match &joint.law {
                    Some(law) => law::single_deflection(law, torque),
                    None => torque * compliance,
                };
                let gone = (to - self.coordinates[own]) * ratio;
                self.follows(own, to, active);
                gone
            }
            // Several motions may belong to one passive joint: see `clear`.
            _ => {
                self.torque[own] = torque.times_plus(torque.same(ratio), self.torque[own]);
                torque.same(0.0)
            }
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

    /// The motion of the tip beyond a spring that has gone so far, as the frame before it sees it.
    #[inline(always)]
    fn spring_carries(&self, spring: &Spring, gone: &[Lanes<S>; 6], motion: &mut Motion<S>) {
        let Motion { turn, shift } = motion;
        let mut screw = spring.screw + spring.moving;
        for i in 0..3 {
            let k = 2 - i;
            if spring.coordinates[3 + k].is_some() && self.bent {
                screw -= 1;
                let [s, c] = self.moved[screw];
                back(k, s, c, turn, shift);
            }
            turn[k] = turn[k] + gone[3 + k];
        }
        for k in 0..3 {
            if let (Some(own), true) = (spring.coordinates[k], self.bent) {
                slid(k, self.coordinates[own], turn, shift);
            }
            shift[k] = shift[k] + gone[k];
        }
    }

    /// Changes of the spring's displacements in its six directions.
    #[inline(always)]
    fn spring_follows(
        &mut self,
        spring: &Spring,
        law: usize,
        torque: [Lanes<S>; 6],
        active: Lanes<S>,
        tally: &mut Tally<S>,
    ) -> [Lanes<S>; 6] {
        let zero = Lanes::new(self.simd, 0.0);
        // Deflection of the spring, its load there, and the residual to multiply by its compliance.
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
        let step = self.yields(spring, law, &residual);
        let mut gone = [zero; 6];
        for d in 0..6 {
            if let Some(own) = spring.coordinates[d] {
                self.bears(own, torque[d], borne[d], tally);
                let to = from[d] + step[d];
                gone[d] = to - self.coordinates[own];
                self.follows(own, to, active);
            }
        }
        gone
    }
}
