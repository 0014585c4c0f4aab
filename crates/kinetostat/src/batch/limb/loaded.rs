//! Equilibrium under load, several postures at once.
//!
//! The torques of a chain depend on its deflections weakly: `theta <- K^-1 tau(theta)` [R 4.16] contracts by about
//! the share of the geometric stiffness in the springs', and needs no matrix. One pass goes outward along the chain
//! (where the tip is, in which direction gravity points) and inward again (torques). Inward, force and moment are
//! kept in the axes and about the origin of the frame reached, so that the torque on a coordinate is one of their
//! components. Where limbs hold a platform together, see [`crate::batch::machine::platform`]. Contraction is watched: a lane that is
//! not done after [`MOST_PASSES`] is left to Newton's ([`crate::batch::limb::newton`]).

use pulp::Simd;

use crate::batch::limb::law;
use crate::batch::limb::reach::Joints;
use crate::batch::limb::unloaded::MotionAxis;
use crate::batch::numbers::lanes::{Lanes, MOST_SQUARE};
use crate::batch::numbers::symmetric::Symmetric;
use crate::batch::numbers::vectors::{Mat3, Vec3, identity, select};
use crate::batch::numbers::wrenches::{Mat6, times};
use crate::batch::plan::steps::{Joint, Law, Plan, Spring, Step};

/// Passes after which a lane is given up. One of `MOST_CONTRACTION` (see [`crate::batch::machine::converge`]) is done in thirty.
pub(crate) const MOST_PASSES: usize = 30;

/// When a lane is done.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Precision {
    /// Relative change of the torques that the next pass would bring.
    pub torque: f64,
    /// Largest change by the last pass, however fast the passes contract.
    pub last: f64,
    /// Largest distance of a limb from its platform, share of the natural length or rad.
    pub place: f64,
    /// Factor on `place` and `torque` in the last pass, if by the rate of contraction the next one would be within
    /// them.
    pub ahead: f64,
    /// The target is corrected where the tool is off by more than this, share of the natural length or rad.
    pub tool: f64,
}

impl Precision {
    /// One where a square is above the `most` that is allowed of it, and the next one would be so too: if it falls by as much once
    /// more as since the `last` pass. Before the first pass that was zero.
    #[inline(always)]
    pub fn goes_on<S: Simd>(&self, square: Lanes<S>, last: Lanes<S>, most: Lanes<S>) -> Lanes<S> {
        let (zero, one) = (most.same(0.0), most.same(1.0));
        let above = most.where_less(square, one, zero);
        let stays = (most * last).where_less(square * square, one, zero);
        let far = (most * (self.ahead * self.ahead)).where_less(square, one, zero);
        above * stays.max(far)
    }
}

/// Precision up to rounding.
pub(crate) const EXACT: Precision = Precision {
    torque: 1e-13,
    last: 1e-10,
    place: 1e-13,
    ahead: 1.0,
    tool: 3e-13,
};

/// Precision of machines that start from the equilibrium of the drawn one: a millionth of a tenth of a micrometre in
/// place.
pub(crate) const FROM_DRAWN: Precision = Precision {
    torque: 1e-10,
    last: 1e-7,
    place: 1e-12,
    ahead: 10.0,
    tool: 3e-13,
};

/// Precision along a path. A program is written in tenths of micrometres, and so are tolerances: what is left of a
/// place is less than a thousandth of that.
pub(crate) const ALONG_PATH: Precision = Precision {
    torque: 1e-8,
    last: 1e-6,
    place: 3e-11,
    ahead: 10.0,
    tool: 3e-11,
};

/// Springs turn less than this, rad: see [`crate::batch::limb::outwards`].
pub(crate) const MOST_TURN: f64 = 0.1;

/// A limb on its way to equilibrium.
pub(crate) struct LoadedLimb<S: Simd> {
    /// Springs' deflections and passive joints, by coordinate.
    pub coordinates: Vec<Lanes<S>>,
    pub commands: Vec<Lanes<S>>,
    /// Passive joints of the unloaded limb.
    pub unloaded: Vec<Lanes<S>>,
    /// Torque on every coordinate.
    pub torque: Vec<Lanes<S>>,
    /// Wrench of the platform on the limb's tip, about the tip, base axes.
    pub wrench: [Lanes<S>; 6],
    /// Axes of every motion, after [`Self::frames`].
    pub places: Vec<MotionAxis<S>>,
    /// Centres of the masses, where [`Self::frames`] has looked.
    pub masses: Vec<Vec3<S>>,
    pub rotation: Mat3<S>,
    pub point: Vec3<S>,
    /// Sine and cosine of every rotation, length of every other motion of a joint.
    pub moved: Vec<[Lanes<S>; 2]>,
    /// Gravity at every mass, m/s^2, axes of the frame there.
    pub gravity: Vec<Vec3<S>>,
    /// Compliances of the springs that depend on the commanded posture, in the order of the steps.
    pub laws: Vec<Symmetric<S>>,
    /// Springs are deflected. The first pass finds them as they are drawn.
    pub bent: bool,
    /// One in the lanes where springs may turn more than the short series of [`crate::batch::limb::outwards`] knows, if there are any.
    pub far: Option<Lanes<S>>,
    /// Change of the wrench since the last pass, and the lanes in which it changed.
    pub change: [Lanes<S>; 6],
    pub changed: Lanes<S>,
    /// Motion of the tip in the last pass, as the base sees it.
    pub motion: Motion<S>,
    /// Sums of the last pass.
    pub tally: Tally<S>,
    /// Square of the change in the one before.
    pub before: Lanes<S>,
    pub simd: S,
}

/// A small motion of a body: its rotation, and its translation where the origin of the axes is.
#[derive(Clone, Copy)]
pub(crate) struct Motion<S: Simd> {
    pub turn: Vec3<S>,
    pub shift: Vec3<S>,
}

/// Sums of a pass over the springs.
#[derive(Clone, Copy)]
pub(crate) struct Tally<S: Simd> {
    /// Squares of the torques and of their changes.
    pub size: Lanes<S>,
    pub change: Lanes<S>,
    /// Largest square of a rotation of a spring whose law is a series.
    pub largest: Lanes<S>,
}

impl<S: Simd> LoadedLimb<S> {
    pub fn new(simd: S, plan: &Plan) -> Self {
        let zero = Lanes::new(simd, 0.0);
        let place = MotionAxis {
            axis: [zero; 3],
            origin: [zero; 3],
        };
        let masses = plan.steps.iter().filter(|s| matches!(s, Step::Mass { .. }));
        let masses = vec![[zero; 3]; masses.count()];
        Self {
            coordinates: vec![zero; plan.coordinates],
            commands: vec![zero; plan.commands],
            unloaded: vec![zero; plan.passive.len()],
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
            change: [zero; 6],
            changed: zero,
            motion: Motion {
                turn: [zero; 3],
                shift: [zero; 3],
            },
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
        self.unloaded.copy_from_slice(passive);
        self.take_laws(plan);
    }

    /// Forgets what it bore in an equilibrium before, and in the lanes that are `lost` also how it is bent: there it is at
    /// home.
    #[inline(always)]
    pub fn forget(&mut self, plan: &Plan, lost: Lanes<S>) {
        let zero = Lanes::new(self.simd, 0.0);
        self.torque.fill(zero);
        self.tally.change = zero;
        if lost.all_less(0.5) {
            return;
        }
        for x in self.coordinates.iter_mut().chain(&mut self.wrench) {
            *x = select(lost, zero, *x);
        }
        for (own, last) in plan.passive.iter().zip(&mut self.unloaded) {
            let home = Lanes::new(self.simd, plan.home[*own]);
            *last = select(lost, home, *last);
            self.coordinates[*own] = select(lost, home, self.coordinates[*own]);
        }
    }

    /// Follows other joints in the bent state: the passive ones change as those of the unloaded limb.
    #[inline(always)]
    pub fn follow(&mut self, plan: &Plan, joints: &Joints<S>) {
        self.commands.copy_from_slice(&joints.commands);
        let both = joints.passive.iter().zip(&mut self.unloaded);
        for (own, (to, from)) in plan.passive.iter().zip(both) {
            self.coordinates[*own] = self.coordinates[*own] + (*to - *from);
            *from = *to;
        }
        self.take_laws(plan);
    }

    /// Springs that depend on the commanded posture.
    #[inline(always)]
    fn take_laws(&mut self, plan: &Plan) {
        self.laws.clear();
        for step in &plan.steps {
            if let Step::Spring(spring) = step
                && let Law::Parallelogram(bars, slot) = &spring.law
            {
                let own = law::parallelogram(self.simd, bars, self.unloaded[*slot]);
                self.laws.push(own);
            }
        }
    }

    /// Tangent stiffness of the spring of a joint, whose compliance at rest is `c`.
    #[inline(always)]
    pub fn joint_stiffness(&self, joint: &Joint, own: usize, c: f64) -> Lanes<S> {
        match &joint.law {
            Some(law) => law::single_tangent(law, self.coordinates[own]),
            None => Lanes::new(self.simd, 1.0 / c),
        }
    }

    #[inline(always)]
    pub fn follows(&mut self, own: usize, to: Lanes<S>, active: Lanes<S>) {
        self.coordinates[own] = select(active, to, self.coordinates[own]);
    }

    /// Deflection of a spring under small torques in its six directions.
    #[inline(always)]
    pub fn yields(&self, spring: &Spring, law: usize, torque: &[Lanes<S>; 6]) -> [Lanes<S>; 6] {
        match &spring.law {
            Law::Parallelogram(..) => self.laws[law].times(torque),
            Law::Constant | Law::Curved(..) => times(&spring.compliance, torque),
        }
    }

    /// One in the lanes where the next pass would still change the torques. If passes contract by a
    /// ratio, the next change is that ratio times the last one.
    #[inline(always)]
    pub fn moving(&self, rounding: Lanes<S>, precision: &Precision) -> Lanes<S> {
        let one = Lanes::new(self.simd, 1.0);
        let Precision { torque, last, .. } = precision;
        let Tally { size, change, .. } = self.tally;
        let most = (size * (last * last)).max(rounding);
        let moving = most.where_less(change, one, one.same(0.0));
        let allowed = (self.before * size * (torque * torque)).max(rounding * rounding);
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

/// Twist of a limb's tip per unit of a motion, base axes.
#[inline(always)]
pub(crate) fn twist<S: Simd>(limb: &LoadedLimb<S>, plan: &Plan, screw: usize) -> [Lanes<S>; 6] {
    limb.places[screw].twist(plan.screws[screw].kind, &limb.point)
}

/// Coordinates of a spring in the six directions.
#[inline(always)]
pub(crate) fn deflection<S: Simd>(limb: &LoadedLimb<S>, spring: &Spring) -> [Lanes<S>; 6] {
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
pub(crate) fn twists<S: Simd>(
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
