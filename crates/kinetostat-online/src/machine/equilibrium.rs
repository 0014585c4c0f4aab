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
use crate::machine::limb::{LimbPlan, LimbState, MOST_PASSIVE};
use crate::machine::model::MachinePlan;

/// Passes of one cycle at most.
pub const MOST_PASSES: u32 = 8;
/// Change of a pass below which the state is the equilibrium, as a share of the natural length.
const PRECISION: f64 = 1e-12;

/// State of a machine and its buffers.
#[derive(Clone, Debug)]
pub(crate) struct MachineState {
    pub forward: Forward,
    limbs: Vec<LimbState>,
    /// Joints of the cycle before.
    joints: Vec<f64>,
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
        let limbs: Option<Vec<LimbState>> = plan.limbs.iter().map(LimbPlan::start).collect();
        let limbs = limbs?;
        Some(Self {
            forward: Forward::new(plan),
            joints: limbs.iter().flat_map(|l| l.commands.clone()).collect(),
            limbs,
            target: plan.home,
            tool: plan.home,
            compliance: Matrix6::zeros(),
            poses: [plan.limbs[0].base, plan.home],
            wrenches: Vec::with_capacity(2 * plan.loads.len() + 1),
        })
    }

    /// Follows the joints of the program and factors the machine there. False where the loops do not close (yet) or the
    /// machine is singular.
    pub(crate) fn prepare(&mut self, plan: &MachinePlan, joints: &[f64]) -> bool {
        let before = self.forward.pose;
        if !self.forward.follow(plan, joints) {
            return false;
        }
        // The target goes along with the program.
        let correction = pose_residual(&self.target, &before);
        let (correction, _) = plan.split(&correction);
        self.target = moved(&self.forward.pose, &correction);
        let mut stiffness = Matrix6::zeros();
        for (index, (limb, own)) in self.limbs.iter_mut().zip(&plan.limbs).enumerate() {
            for (command, joint) in limb.commands.iter_mut().zip(own.joints.clone()) {
                *command += joints[joint] - self.joints[joint];
            }
            // A jump of the joints, at the start for instance, takes the passive joints along.
            let jump = pose_residual(&self.forward.pose, &before);
            if jump.linear().norm() > 0.01 * plan.length || jump.angular().norm() > 0.01 {
                for passive in &own.passive {
                    let x = self.forward.coordinates(index)[*passive];
                    limb.bent[*passive] += x - limb.drawn[*passive];
                    limb.drawn[*passive] = x;
                }
            }
            if !(limb.factor_joints(own) && limb.factor_springs(own)) {
                return self.give_up(plan, joints);
            }
            let tip = limb.actual.tip_pose().translation.vector;
            if plan.is_serial {
                self.tool = limb.actual.tip_pose() * own.platform_from_tip.inverse();
                let shift = shift_matrix(&(self.tool.translation.vector - tip));
                self.compliance = shift * limb.tip_compliance * shift.transpose();
                continue;
            }
            if !limb.factor_held(own) {
                return self.give_up(plan, joints);
            }
            let shift = shift_matrix(&(tip - self.tool.translation.vector));
            for j in 0..6 {
                let motion = shift.column(j).into_owned();
                let (wrench, _) = limb.hold(own, &motion, &[0.0; MOST_PASSIVE]);
                let mut column = stiffness.column_mut(j);
                column += shift.transpose() * wrench;
            }
        }
        if !plan.is_serial {
            let Some(inverse) = inverse_in_units(&stiffness, plan.length) else {
                return self.give_up(plan, joints);
            };
            self.compliance = inverse;
        }
        self.joints.copy_from_slice(joints);
        self.compliance.iter().all(|x| x.is_finite())
    }

    /// Begins anew from the unloaded machine in the next cycle.
    fn give_up(&mut self, plan: &MachinePlan, joints: &[f64]) -> bool {
        self.joints.copy_from_slice(joints);
        self.unload(plan);
        false
    }

    /// Puts the machine where it is unloaded.
    fn unload(&mut self, plan: &MachinePlan) {
        self.target = self.forward.pose;
        self.tool = self.forward.pose;
        for (index, (limb, own)) in self.limbs.iter_mut().zip(&plan.limbs).enumerate() {
            limb.drawn.copy_from_slice(self.forward.coordinates(index));
            limb.commands
                .copy_from_slice(&self.joints[own.joints.clone()]);
            limb.unload(own);
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
        let mut change = 0.0_f64;
        for (limb, own) in self.limbs.iter_mut().zip(&plan.limbs) {
            change = change.max(limb.follow(own, &self.target));
            limb.move_actual(own);
        }
        change = change.max(match plan.is_serial {
            true => self.serial(plan, wrench),
            false => self.platform(plan, wrench),
        });
        let (off, _) = plan.split(&pose_residual(&self.forward.pose, &self.tool));
        change = change.max(size(&off.0, plan.length));
        // The tool is taken to go along with its target.
        self.target = moved(&self.target, &off);
        if plan.directions[3] {
            self.target.rotation.renormalize_fast();
        }
        self.tool = moved(&self.tool, &off);
        let sound = self
            .limbs
            .iter()
            .zip(&plan.limbs)
            .all(|(l, own)| l.is_sound(own));
        (change.is_finite() && sound).then_some(change)
    }

    /// Load on the tool at its present pose, about its point: the given wrench, the platform's weight and its loads.
    fn load(&mut self, plan: &MachinePlan, wrench: &Wrench) -> Wrench {
        let arm = self.tool.rotation * plan.centre_of_mass;
        let mut sum = *wrench + Wrench::new(plan.weight, arm.cross(&plan.weight));
        self.poses[1] = self.tool;
        self.wrenches.clear();
        for load in &plan.loads {
            load.wrenches(&self.poses, &mut self.wrenches);
        }
        for (platform, own) in &self.wrenches {
            if *platform == plan.tool {
                sum += *own;
            }
        }
        sum
    }

    fn serial(&mut self, plan: &MachinePlan, wrench: &Wrench) -> f64 {
        let own = &plan.limbs[0];
        let tip = self.limbs[0].actual.tip_pose();
        self.tool = tip * own.platform_from_tip.inverse();
        let arm = tip.translation.vector - self.tool.translation.vector;
        let load = self.load(plan, wrench).shifted(&arm);
        let limb = &mut self.limbs[0];
        limb.wrench = load;
        let moved_tip = Twist(limb.spring_step(own, &mut [0.0; MOST_PASSIVE]));
        limb.take_step();
        self.tool = moved(&self.tool, &moved_tip.shifted(&-arm));
        size(&moved_tip.0, plan.length)
    }

    fn platform(&mut self, plan: &MachinePlan, wrench: &Wrench) -> f64 {
        let mut unbalanced = self.load(plan, wrench).0;
        let tool = self.tool;
        for (limb, own) in self.limbs.iter_mut().zip(&plan.limbs) {
            let (closure, shift, torques) = limb_residual(limb, own, &tool);
            let (change, _) = limb.hold(own, &closure, &torques);
            unbalanced -= shift.transpose() * (limb.wrench.0 + change);
        }
        let motion = self.compliance * unbalanced;
        let mut largest = size(&motion, plan.length);
        for (limb, own) in self.limbs.iter_mut().zip(&plan.limbs) {
            // Evaluated once more instead of kept: a limb's residual costs less than a pass.
            let (closure, shift, torques) = limb_residual(limb, own, &tool);
            let (change, joints) = limb.hold(own, &(closure + shift * motion), &torques);
            limb.bend_by(own, &change);
            limb.wrench.0 += change;
            for (k, passive) in own.passive.iter().enumerate() {
                limb.bent[*passive] += joints[k];
                largest = largest.max(joints[k].abs() * plan.length);
            }
            for x in &limb.step {
                largest = largest.max(x.abs() * plan.length.min(1.0));
            }
            limb.take_step();
        }
        self.tool = moved(&self.tool, &Twist(motion));
        largest
    }
}

/// How far the tip of a limb is from its place on the platform once its springs have taken their step, the motion of the tip by
/// the tool's, and the torques of its passive joints.
fn limb_residual(
    limb: &mut LimbState,
    own: &LimbPlan,
    tool: &Pose,
) -> (Vector6<f64>, Matrix6<f64>, [f64; MOST_PASSIVE]) {
    let tip = limb.actual.tip_pose();
    let mut torques = [0.0; MOST_PASSIVE];
    let gone = limb.spring_step(own, &mut torques);
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
    let condition = inverse.norm() * scaled.norm();
    (condition < 1e13).then(|| Matrix6::from_fn(|i, j| inverse[(i, j)] / (unit(i) * unit(j))))
}
