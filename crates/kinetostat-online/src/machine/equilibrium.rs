//! The loaded equilibrium whose tool is where the program has it: target, limbs and platform corrected together, pass by pass.
//!
//! ```text
//! serial     wrench of the tip given by the load;  theta <- theta + C (tau - T)                        [R 4.16]
//! loops      [C, J_q; J_q^T, 0] [dW; dq] = [r - J_theta C (tau - T) + S dX; -tau_q],   sum S^T (W + dW) = W_load     [R 6.21-6.30]
//! target     t0 <- t0 + (t_desired - t), in the directions that are corrected                            [R 7.13]
//! ```
//!
//! Matrices are those of the state at the beginning of the cycle and of springs at rest, so that a pass contracts by the share of
//! the geometric stiffness. State is kept from cycle to cycle: where nothing changes, one pass confirms it.

use kinetostat::spatial::{Pose, Twist, Wrench, moved, pose_residual, shift_matrix};
use nalgebra::{Matrix6, Vector6};

use crate::machine::forward::Forward;
use crate::machine::joints::FARTHEST;
use crate::machine::limb::LimbState;
use crate::machine::model::{LimbPlan, MOST_PASSIVE, MachinePlan};

/// Passes of one cycle at most.
pub const MOST_PASSES: u32 = 8;
/// Change of a pass below which the state is the equilibrium, as a share of the natural length.
const PRECISION: f64 = 1e-11;
/// A motion of the program in one cycle above which passive joints are taken along, as a share of the natural length.
const JUMP: f64 = 0.01;

/// State of a machine and its buffers.
#[derive(Clone, Debug)]
pub(crate) struct MachineState {
    pub forward: Forward,
    limbs: Vec<LimbState>,
    /// Joints of the program in the last cycle whose loops closed.
    pub joints: Vec<f64>,
    /// Pose to command so that the tool is where the program has it.
    pub target: Pose,
    /// Pose of the tool in equilibrium.
    pub tool: Pose,
    /// Compliance of the tool at its point, base axes, springs at rest (m/N, rad/(N m)).
    pub compliance: Matrix6<f64>,
    poses: [Pose; 2],
    wrenches: Vec<(usize, Wrench)>,
}

/// Outcome of the passes of a cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Solved {
    /// In equilibrium after so many passes.
    Converged(u32),
    /// Not in equilibrium after all passes; the next cycle goes on.
    Unfinished,
    /// The tool or a limb is held by nothing, or the joints cannot follow the target.
    Singular,
}

impl MachineState {
    /// State at home; `None` if a spring has no compliance.
    pub(crate) fn new(plan: &MachinePlan) -> Option<Self> {
        let limbs: Option<Vec<LimbState>> = plan.limbs.iter().map(LimbState::new).collect();
        let limbs = limbs?;
        let home = limbs.iter().flat_map(|l| &l.joints.commands);
        Some(Self {
            forward: Forward::new(plan),
            joints: home.copied().collect(),
            limbs,
            target: plan.home,
            tool: plan.home,
            compliance: Matrix6::zeros(),
            poses: [plan.limbs[0].base, plan.home],
            wrenches: Vec::with_capacity(2 * plan.loads.len() + 1),
        })
    }

    /// Follows the joints of the program and factors the machine there. False where the loops do not close (yet) or the
    /// machine is singular; the next cycle then begins anew from the unloaded machine.
    pub(crate) fn prepare(&mut self, plan: &MachinePlan, joints: &[f64]) -> bool {
        let before = self.forward.pose;
        if !self.forward.follow(plan, joints) {
            return false;
        }
        // The target goes along with the program, and so does the tool of a machine whose limbs lead it.
        let program = self.forward.pose;
        let (correction, _) = plan.split(&pose_residual(&self.target, &before));
        self.target = moved(&program, &correction);
        let jump = pose_residual(&program, &before);
        let jumps = size(&jump.0, plan.length) > JUMP * plan.length;
        for (index, (limb, own)) in self.limbs.iter_mut().zip(&plan.limbs).enumerate() {
            for (command, joint) in limb.joints.commands.iter_mut().zip(own.joints.clone()) {
                *command += joints[joint] - self.joints[joint];
            }
            if jumps {
                limb.jump(own, self.forward.coordinates(index));
            }
        }
        self.tool = moved(&self.tool, &jump);
        self.joints.copy_from_slice(joints);
        let found = self.factor(plan);
        if !found {
            self.unload(plan);
        }
        found
    }

    /// Factors of all limbs and the compliance of the tool; false if something is singular.
    fn factor(&mut self, plan: &MachinePlan) -> bool {
        let mut stiffness = Matrix6::zeros();
        for (limb, own) in self.limbs.iter_mut().zip(&plan.limbs) {
            if !(limb.joints.factor(own) && limb.differentiate(own)) {
                return false;
            }
            let tip = limb.tip();
            if plan.is_serial {
                self.tool = tip * own.platform_from_tip.inverse();
                let arm = self.tool.translation.vector - tip.translation.vector;
                let shift = shift_matrix(&arm);
                self.compliance = shift * limb.tip_compliance * shift.transpose();
                return self.compliance.iter().all(|x| x.is_finite());
            }
            if !limb.factor_held(own) {
                return false;
            }
            let shift = shift_matrix(&(tip.translation.vector - self.tool.translation.vector));
            for (j, mut column) in stiffness.column_iter_mut().enumerate() {
                let motion = shift.column(j).into_owned();
                column += shift.transpose() * limb.hold(own, &motion, &[0.0; MOST_PASSIVE]).0;
            }
        }
        let inverse = inverse_in_units(&stiffness, plan.length);
        self.compliance = inverse.unwrap_or_default();
        inverse.is_some()
    }

    /// Puts the machine where it is unloaded.
    fn unload(&mut self, plan: &MachinePlan) {
        (self.target, self.tool) = (self.forward.pose, self.forward.pose);
        for (index, (limb, own)) in self.limbs.iter_mut().zip(&plan.limbs).enumerate() {
            let commands = &self.joints[own.joints.clone()];
            limb.unload(self.forward.coordinates(index), commands);
        }
    }

    /// Passes towards the equilibrium under a wrench on the tool (at its point, base axes), after [`Self::prepare`].
    pub(crate) fn solve(&mut self, plan: &MachinePlan, wrench: &Wrench) -> Solved {
        for pass in 1..=MOST_PASSES {
            let Some(change) = self.pass(plan, wrench) else {
                self.unload(plan);
                return Solved::Singular;
            };
            if change < PRECISION * plan.length {
                return Solved::Converged(pass);
            }
        }
        Solved::Unfinished
    }

    /// One pass; the largest change in m (rotations at the natural length), nothing where numbers go wild.
    fn pass(&mut self, plan: &MachinePlan, wrench: &Wrench) -> Option<f64> {
        let change = match plan.is_serial {
            true => self.serial(plan, wrench),
            false => self.platform(plan, wrench),
        };
        let correction = pose_residual(&self.target, &self.forward.pose);
        let near = size(&correction.0, plan.length) < FARTHEST * plan.length;
        let mut limbs = self.limbs.iter().zip(&plan.limbs);
        let sound = limbs.all(|(limb, own)| limb.is_sound(own, &self.joints[own.joints.clone()]));
        (change.is_finite() && near && sound).then_some(change)
    }

    /// Load on the tool at its present pose, about its point: the given wrench, the platform's weight and its loads.
    fn load(&mut self, plan: &MachinePlan, wrench: &Wrench) -> Wrench {
        let arm = self.tool.rotation * plan.centre_of_mass;
        let weight = Wrench::new(plan.weight, arm.cross(&plan.weight));
        self.poses[1] = self.tool;
        self.wrenches.clear();
        for load in &plan.loads {
            load.wrenches(&self.poses, &mut self.wrenches);
        }
        let own = self.wrenches.iter().filter(|(on, _)| *on == plan.tool);
        own.fold(*wrench + weight, |sum, (_, own)| sum + *own)
    }

    /// A pass of one chain. The deflection is that of the actual chain from the nominal one at the same joints, so that joints which are still on
    /// their way to the target, as near a singular posture, are not corrected twice.
    fn serial(&mut self, plan: &MachinePlan, wrench: &Wrench) -> f64 {
        let own = &plan.limbs[0];
        self.limbs[0].move_actual(own);
        let tip = self.limbs[0].tip();
        self.tool = tip * own.platform_from_tip.inverse();
        let arm = tip.translation.vector - self.tool.translation.vector;
        let load = self.load(plan, wrench).shifted(&arm);
        let limb = &mut self.limbs[0];
        limb.wrench = load;
        let (motion, _) = limb.spring_step(own);
        limb.take_step(own, &Vector6::zeros(), &[0.0; MOST_PASSIVE]);
        self.tool = moved(&self.tool, &Twist(motion).shifted(&-arm));
        let tip = limb.joints.tip(own);
        let nominal = tip * own.platform_from_tip.inverse();
        let (deflection, _) = plan.split(&pose_residual(&self.tool, &nominal));
        self.target = moved(&self.forward.pose, &-deflection);
        let (off, _) = limb.joints.follow(own, &self.target, &tip);
        off.max(size(&motion, plan.length))
    }

    /// A pass of a machine with loops: the target is moved by what the tool is off, and the tool is taken to go along.
    fn platform(&mut self, plan: &MachinePlan, wrench: &Wrench) -> f64 {
        let mut joints_off = 0.0_f64;
        for (limb, own) in self.limbs.iter_mut().zip(&plan.limbs) {
            joints_off = kinetostat::number::larger(joints_off, limb.follow(own, &self.target));
        }
        let mut unbalanced = self.load(plan, wrench).0;
        for (limb, own) in self.limbs.iter_mut().zip(&plan.limbs) {
            let (closure, shift, torques) = limb_residual(limb, own, &self.tool);
            let (change, _) = limb.hold(own, &closure, &torques);
            unbalanced -= shift.transpose() * (limb.wrench.0 + change);
        }
        let motion = self.compliance * unbalanced;
        let mut largest = joints_off.max(size(&motion, plan.length));
        for (limb, own) in self.limbs.iter_mut().zip(&plan.limbs) {
            // Evaluated once more instead of kept: torques cost less than the pose, which stays.
            let (closure, shift, torques) = limb_residual(limb, own, &self.tool);
            let (change, joints) = limb.hold(own, &(closure + shift * motion), &torques);
            limb.take_step(own, &change, &joints);
            let steps = joints.iter().chain(&limb.step).map(|x| x.abs());
            largest = steps.fold(largest, |most, x| {
                kinetostat::number::larger(most, x * kinetostat::number::smaller(plan.length, 1.0))
            });
        }
        self.tool = moved(&self.tool, &Twist(motion));
        let (off, _) = plan.split(&pose_residual(&self.forward.pose, &self.tool));
        self.target = moved(&self.target, &off);
        self.tool = moved(&self.tool, &off);
        largest.max(size(&off.0, plan.length))
    }
}

/// Distance of a limb's tip from its place on the platform once its springs have taken their step, the motion of the tip by
/// the tool's, and the torques of its passive joints.
fn limb_residual(
    limb: &mut LimbState,
    own: &LimbPlan,
    tool: &Pose,
) -> (Vector6<f64>, Matrix6<f64>, [f64; MOST_PASSIVE]) {
    let tip = limb.tip();
    let (gone, torques) = limb.spring_step(own);
    let closure = pose_residual(&(tool * own.platform_from_tip), &tip).0 - gone;
    let shift = shift_matrix(&(tip.translation.vector - tool.translation.vector));
    (closure, shift, torques)
}

/// Size of a twist, m, rotations at a length.
fn size(twist: &Vector6<f64>, length: f64) -> f64 {
    let linear = twist.fixed_rows::<3>(0).norm();
    linear.max(twist.fixed_rows::<3>(3).norm() * length)
}

/// Inverse of a stiffness whose metres and radians are made comparable by a length.
fn inverse_in_units(stiffness: &Matrix6<f64>, length: f64) -> Option<Matrix6<f64>> {
    let unit = |k: usize| if k < 3 { 1.0 } else { length };
    let scaled = Matrix6::from_fn(|i, j| stiffness[(i, j)] / (unit(i) * unit(j)));
    let inverse = scaled.try_inverse()?;
    let back = |i, j| inverse[(i, j)] / (unit(i) * unit(j));
    (inverse.norm() * scaled.norm() < 1e13).then(|| Matrix6::from_fn(back))
}
