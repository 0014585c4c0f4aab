//! Equilibrium of a machine, serial or with platforms, several postures at once.

use pulp::Simd;

use crate::batch::limb::loaded::{EXACT, LoadedLimb, MOST_PASSES, MOST_TURN};
use crate::batch::limb::newton::Newton;
use crate::batch::limb::reach::MOST_STEPS;
use crate::batch::machine::group::REGULAR;
use crate::batch::machine::loaded::Machine;
use crate::batch::numbers::instruction_set::apart;
use crate::batch::numbers::lanes::Lanes;
use crate::batch::numbers::vectors::select;
use crate::batch::plan::steps::Plan;
use crate::spatial::Directions;

/// Equilibria of a serial machine after which a lane is given up.
const MOST_ROUNDS: usize = 12;

impl<S: Simd> Machine<S> {
    /// Equilibrium of the machine in the lanes that are `good`, its target corrected if the tool is to be at its place in
    /// these directions: above zero in the lanes that are done.
    #[inline(always)]
    pub fn converge(
        &mut self,
        simd: S,
        wrench: &[Lanes<S>; 6],
        directions: Option<Directions>,
        good: Lanes<S>,
    ) -> Lanes<S> {
        match self.is_serial() {
            true => self.converge_serial(simd, wrench, directions, good),
            false => self.converge_platform(simd, wrench, directions, good),
        }
    }

    /// A serial machine: its target is corrected after each equilibrium [R 7.13]. Every round starts from the
    /// unloaded limb, so that a lane that is done keeps its bits.
    #[inline(always)]
    fn converge_serial(
        &mut self,
        simd: S,
        wrench: &[Lanes<S>; 6],
        directions: Option<Directions>,
        mut good: Lanes<S>,
    ) -> Lanes<S> {
        let (zero, one) = (Lanes::new(simd, 0.0), Lanes::new(simd, 1.0));
        let mut rounds = 0;
        loop {
            let (plan, limb) = (&self.actual[0], &mut self.limbs[0]);
            limb.start(plan, &self.joints[0].commands, &[]);
            let done = serial(simd, plan, limb, &mut self.newton, *wrench, &self.gravity);
            (self.rotation, self.point) = (limb.rotation, limb.point);
            good = good.least_of(done);
            let Some(directions) = directions else {
                return good;
            };
            let able = (one * REGULAR).where_less(good, one, zero);
            let off = self.correct(simd, directions, able);
            rounds += 1;
            if off.all_less(0.5) {
                return good;
            }
            if rounds == MOST_ROUNDS {
                return good * (one - off);
            }
            good = good.least_of(one - self.reach(simd, MOST_STEPS, off));
        }
    }
}

/// Passes that bring more than this share of the one before do not come to an end in time.
const MOST_CONTRACTION: f64 = 0.4;
/// Springs turn less than this in Newton's iteration, rad: see [`Lanes::sin_cos_near_zero`].
const MOST_TURN_FAR: f64 = 0.7;

/// Equilibrium of a serial limb under a dead wrench at its tip: one in the lanes that are done.
#[inline(always)]
pub(crate) fn serial<S: Simd>(
    simd: S,
    plan: &Plan,
    limb: &mut LoadedLimb<S>,
    newton: &mut Option<Newton<S>>,
    wrench: [Lanes<S>; 6],
    gravity: &[f64; 3],
) -> Lanes<S> {
    apart!(simd, {
        let (zero, one) = (Lanes::new(simd, 0.0), Lanes::new(simd, 1.0));
        let (mut active, mut lost) = (one, zero);
        limb.wrench = wrench;
        for pass in 0..=MOST_PASSES {
            limb.outwards(plan, gravity);
            if pass == MOST_PASSES || active.all_less(0.5) {
                break;
            }
            limb.inwards(plan, active);
            active = active * limb.moving(zero, &EXACT);
            if pass > 0 {
                lost = select(active, limb.slower_than(MOST_CONTRACTION), lost);
                active = active * (one - lost);
            }
        }
        let done = (one - active) * (one - lost) * limb.sound(plan, MOST_TURN);
        if (one - done).all_less(0.5) || !plan.has_tangent() {
            return done;
        }
        if newton.is_none() {
            *newton = Some(Newton::new(simd, plan));
        }
        let Some(newton) = newton else {
            return done;
        };
        let found = newton.converge(plan, limb, gravity, one - done);
        done + found * limb.sound(plan, MOST_TURN_FAR)
    })
}
