//! Forces and torques of the actuators under the loads.

use pulp::Simd;

use crate::batch::limb::loaded::LoadedLimb;
use crate::batch::numbers::lanes::Lanes;
use crate::batch::numbers::wrenches::{lever, rotated_back};
use crate::batch::plan::steps::{Plan, Step};

/// Adds the force (N) or torque (N m) of the loads on every actuator of a limb where it lies: of the
/// wrench at its tip and of the weights beyond.
#[inline(always)]
pub(crate) fn forces<S: Simd>(simd: S, plan: &Plan, limb: &LoadedLimb<S>, out: &mut [Lanes<S>]) {
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
