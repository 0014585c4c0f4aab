//! What the loads ask of the actuators.

use pulp::Simd;

use super::lanes::{Lanes, constant, cross, dot, minus};
use super::loaded::LoadedLimb;
use super::plan::{Plan, Step};
use super::unloaded::Place;
use crate::chain::MotionKind;

/// Adds the force (N) or torque (N m) of the loads on every actuator of a limb where it lies: of the
/// wrench at its tip and of the weights beyond.
#[inline(always)]
pub(super) fn forces<S: Simd>(
    simd: S,
    plan: &Plan,
    limb: &LoadedLimb<S>,
    gravity: &[f64; 3],
    out: &mut [Lanes<S>],
) {
    let gravity = constant(simd, gravity);
    let [fx, fy, fz, mx, my, mz] = limb.wrench;
    let mut force = [fx, fy, fz];
    // About the base's origin.
    let lever = cross(&limb.point, &force);
    let mut moment = [mx + lever[0], my + lever[1], mz + lever[2]];
    let mut mass = limb.masses.len();
    for step in plan.steps.iter().rev() {
        match step {
            Step::Mass { mass: m, .. } => {
                mass -= 1;
                let [x, y, z] = gravity;
                let weight = [x * *m, y * *m, z * *m];
                let own = cross(&limb.masses[mass], &weight);
                for k in 0..3 {
                    force[k] = force[k] + weight[k];
                    moment[k] = moment[k] + own[k];
                }
            }
            Step::Joint(joint) => {
                let Some((own, ratio)) = joint.amount.command else {
                    continue;
                };
                let Place { axis, origin } = &limb.places[joint.screw];
                let along = match joint.kind {
                    MotionKind::Prismatic => dot(axis, &force),
                    MotionKind::Revolute => dot(axis, &minus(&moment, &cross(origin, &force))),
                };
                out[own] = along.times_plus(along.same(ratio), out[own]);
            }
            Step::Spring(_) | Step::Shift(_) | Step::Rotate(_) => {}
        }
    }
}
