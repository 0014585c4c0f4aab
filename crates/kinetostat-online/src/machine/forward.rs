//! Pose of the tool from commanded joints: nominal geometry, springs at home.
//!
//! A machine of one limb without passive joints has it in closed form. With loops, the platform and the passive joints follow by Newton's
//! iteration from the cycle before: with `Q` the motions of a limb's tip that its passive joints cannot make,
//!
//! ```text
//! sum S^T Q S dP = - sum S^T Q r,     J_q dq = r + S dP in the sense of least squares
//! ```

use kinetostat::spatial::{Pose, Twist, moved, pose_residual, shift_matrix};
use nalgebra::{Matrix6, Vector6};

use crate::machine::joints::Joints;
use crate::machine::model::{LimbPlan, MachinePlan};
use crate::small::Lu;

/// Passes of one cycle.
const PASSES: usize = 4;
/// Change below which the pose is found, as a share of the natural length.
const PRECISION: f64 = 1e-13;

/// The machine as the program has it.
#[derive(Clone, Debug)]
pub(crate) struct Forward {
    limbs: Vec<Joints>,
    pub pose: Pose,
}

impl Forward {
    pub(crate) fn new(plan: &MachinePlan) -> Self {
        let limbs = plan.limbs.iter().map(|limb| Joints::new(limb, false));
        Self {
            limbs: limbs.collect(),
            pose: plan.home,
        }
    }

    /// Coordinates of a limb: its passive joints, springs at home.
    pub(crate) fn coordinates(&self, limb: usize) -> &[f64] {
        &self.limbs[limb].coordinates
    }

    /// Follows the joints; true if the pose is found.
    pub(crate) fn follow(&mut self, plan: &MachinePlan, joints: &[f64]) -> bool {
        for (own, limb) in self.limbs.iter_mut().zip(&plan.limbs) {
            own.commands.copy_from_slice(&joints[limb.joints.clone()]);
        }
        if plan.is_serial {
            let tip = self.limbs[0].tip(&plan.limbs[0]);
            self.pose = tip * plan.limbs[0].platform_from_tip.inverse();
            return true;
        }
        for _ in 0..PASSES {
            match self.pass(plan) {
                Some(change) if change < PRECISION * plan.length => return true,
                Some(_) => {}
                None => {
                    self.go_home(plan);
                    return false;
                }
            }
        }
        false
    }

    /// A state that leads nowhere is not kept.
    fn go_home(&mut self, plan: &MachinePlan) {
        self.pose = plan.home;
        for (own, limb) in self.limbs.iter_mut().zip(&plan.limbs) {
            let home = limb.nominal.coordinates().iter();
            for (x, home) in own.coordinates.iter_mut().zip(home) {
                *x = home.home;
            }
        }
    }

    /// One pass; its largest change in m (rotations at the natural length), nothing where the loops are singular or the pose is far away.
    fn pass(&mut self, plan: &MachinePlan) -> Option<f64> {
        let (mut matrix, mut right) = (Matrix6::zeros(), Vector6::zeros());
        for (own, limb) in self.limbs.iter_mut().zip(&plan.limbs) {
            if !own.factor(limb) {
                return None;
            }
            let mut blocked = Matrix6::identity();
            for mut column in blocked.column_iter_mut() {
                let motion = column.clone_owned();
                column -= own.answer(&motion);
            }
            let (closure, shift) = closure(own, limb, &self.pose);
            let held = shift.transpose() * blocked;
            matrix += held * shift;
            right -= held * closure;
        }
        let mut factor = Lu::<6>::new();
        if !factor.factor(6, |i, j| matrix[(i, j)]) {
            return None;
        }
        let motion = Vector6::from(factor.solve(&right.into()));
        let mut change = motion.norm();
        for (own, limb) in self.limbs.iter_mut().zip(&plan.limbs) {
            let (closure, shift) = closure(own, limb, &self.pose);
            change =
                kinetostat::number::larger(change, own.answer(&(closure + shift * motion)).norm());
            own.take_steps(limb);
        }
        let turn = motion.fixed_rows::<3>(3) / plan.length;
        let twist = Twist::new(motion.fixed_rows::<3>(0).into_owned(), turn);
        self.pose = moved(&self.pose, &twist);
        (change < 10.0 * plan.length).then_some(change)
    }
}

/// Distance of a limb's tip from its place on the platform, and the motion of that place by the platform's, in units of length.
fn closure(own: &mut Joints, limb: &LimbPlan, pose: &Pose) -> (Vector6<f64>, Matrix6<f64>) {
    let place = pose * limb.platform_from_tip;
    let off = limb.in_length(pose_residual(&place, &own.tip(limb)).0);
    let arm = (place.translation.vector - pose.translation.vector) / limb.length;
    (off, shift_matrix(&arm))
}
