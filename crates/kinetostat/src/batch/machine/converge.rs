//! Equilibrium of a machine, serial or with platforms, several postures at once.

use pulp::Simd;

use crate::batch::limb::reach::MOST_STEPS;
use crate::batch::limb::serial::serial;
use crate::batch::machine::group::REGULAR;
use crate::batch::machine::loaded::Machine;
use crate::batch::numbers::lanes::Lanes;
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
