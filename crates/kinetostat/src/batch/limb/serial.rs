//! Equilibrium of a serial limb under a wrench at its tip: the contracting iteration, then Newton's where it
//! does not contract.

use pulp::Simd;

use crate::batch::limb::loaded::{EXACT, LoadedLimb, MOST_PASSES, MOST_TURN};
use crate::batch::limb::newton::Newton;
use crate::batch::numbers::apart::apart;
use crate::batch::numbers::lanes::Lanes;
use crate::batch::numbers::vectors::select;
use crate::batch::plan::steps::Plan;

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
