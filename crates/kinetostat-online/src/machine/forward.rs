//! Pose of the tool from commanded joints: nominal geometry, springs at home.
//!
//! A machine of one limb without passive joints has it in closed form. With loops, the platform and the passive joints follow by Newton's
//! iteration from the cycle before: with `Q = I - J_q (J_q^T J_q)^-1 J_q^T` of each limb, the motions that its passive joints cannot make,
//!
//! ```text
//! sum S^T Q S dP = - sum S^T Q r,     J_q dq = r + S dP in the sense of least squares
//! ```

use kinetostat::model::ChainEvaluation;
use kinetostat::spatial::{Pose, Twist, moved, pose_residual, shift_matrix};
use nalgebra::{Matrix6, Vector6};

use crate::machine::limb::{LimbPlan, MOST_PASSIVE, scaled_column};
use crate::machine::model::MachinePlan;
use crate::small::{cholesky, solve_cholesky};

/// Passes of one cycle.
const PASSES: usize = 4;
/// Change of the pose below which it is found, as a share of the natural length.
const PRECISION: f64 = 1e-13;

/// One limb as the program has it.
#[derive(Clone, Debug)]
struct Drawn {
    evaluation: ChainEvaluation,
    coordinates: Vec<f64>,
    /// Cholesky factor of `J_q^T J_q`.
    normal: [f64; MOST_PASSIVE * MOST_PASSIVE],
}

/// The machine as the program has it.
#[derive(Clone, Debug)]
pub(crate) struct Forward {
    limbs: Vec<Drawn>,
    pub pose: Pose,
}

impl Forward {
    pub(crate) fn new(plan: &MachinePlan) -> Self {
        let limbs = plan.limbs.iter().map(|limb| Drawn {
            evaluation: ChainEvaluation::new(&limb.nominal, &[]),
            coordinates: limb.nominal.home_coordinates(),
            normal: [0.0; MOST_PASSIVE * MOST_PASSIVE],
        });
        Self {
            limbs: limbs.collect(),
            pose: plan.home,
        }
    }

    /// Passive joints of a limb.
    pub(crate) fn coordinates(&self, limb: usize) -> &[f64] {
        &self.limbs[limb].coordinates
    }

    /// Follows the joints; true if the pose is found.
    pub(crate) fn follow(&mut self, plan: &MachinePlan, joints: &[f64]) -> bool {
        if plan.is_serial {
            let (limb, drawn) = (&plan.limbs[0], &mut self.limbs[0]);
            drawn
                .evaluation
                .move_to(&limb.nominal, &limb.base, &drawn.coordinates, joints);
            self.pose = drawn.evaluation.tip_pose() * limb.platform_from_tip.inverse();
            return true;
        }
        for _ in 0..PASSES {
            match self.pass(plan, joints) {
                Some(moved) if moved < PRECISION * plan.length => return true,
                Some(_) => {}
                None => {
                    // A state that leads nowhere is not kept.
                    *self = Self {
                        pose: plan.home,
                        limbs: std::mem::take(&mut self.limbs),
                    };
                    for (drawn, limb) in self.limbs.iter_mut().zip(&plan.limbs) {
                        for (x, own) in drawn.coordinates.iter_mut().zip(limb.nominal.coordinates())
                        {
                            *x = own.home;
                        }
                    }
                    return false;
                }
            }
        }
        false
    }

    /// One pass; how far the platform moved and was off, m, or nothing where the loops are singular.
    fn pass(&mut self, plan: &MachinePlan, joints: &[f64]) -> Option<f64> {
        let length = plan.length;
        let (mut matrix, mut right) = ([0.0; 36], Vector6::zeros());
        for (drawn, limb) in self.limbs.iter_mut().zip(&plan.limbs) {
            let (blocked, closure, shift) = drawn.blocked(limb, &self.pose, joints, length)?;
            let by_platform = blocked * shift;
            let own = shift.transpose() * by_platform;
            for i in 0..6 {
                for j in 0..6 {
                    matrix[6 * i + j] += own[(i, j)];
                }
            }
            right -= shift.transpose() * blocked * closure;
        }
        if !cholesky(&mut matrix, 6) {
            return None;
        }
        let mut motion: [f64; 6] = right.into();
        solve_cholesky(&matrix, 6, &mut motion);
        let mut most = 0.0_f64;
        for (drawn, limb) in self.limbs.iter_mut().zip(&plan.limbs) {
            most = most.max(drawn.go_along(limb, &self.pose, &Vector6::from(motion), length));
        }
        for (k, x) in motion.iter_mut().enumerate() {
            most = most.max(x.abs());
            *x /= if k < 3 { 1.0 } else { length };
        }
        self.pose = moved(&self.pose, &Twist(Vector6::from(motion)));
        (most < 10.0 * length).then_some(most)
    }
}

impl Drawn {
    /// Motions that the passive joints cannot make, how far the tip is from the platform, and the motion of the tip by that of the
    /// platform, all in units of length.
    fn blocked(
        &mut self,
        limb: &LimbPlan,
        pose: &Pose,
        joints: &[f64],
        length: f64,
    ) -> Option<(Matrix6<f64>, Vector6<f64>, Matrix6<f64>)> {
        let commands = &joints[limb.joints.clone()];
        self.evaluation
            .move_to(&limb.nominal, &limb.base, &self.coordinates, commands);
        self.evaluation.differentiate();
        let p = limb.passive.len();
        let column =
            |k: usize| Vector6::from(scaled_column(&self.evaluation, limb.passive[k], length));
        for i in 0..p {
            for j in 0..p {
                self.normal[i * p + j] = column(i).dot(&column(j));
            }
        }
        if p > 0 && !cholesky(&mut self.normal, p) {
            return None;
        }
        let mut blocked = Matrix6::identity();
        for row in 0..6 {
            let mut share = [0.0; MOST_PASSIVE];
            for k in 0..p {
                share[k] = column(k)[row];
            }
            solve_cholesky(&self.normal, p, &mut share[..p]);
            for k in 0..p {
                let axis = column(k);
                for i in 0..6 {
                    blocked[(i, row)] -= axis[i] * share[k];
                }
            }
        }
        let (closure, shift) = self.closure(limb, pose, length);
        Some((blocked, closure, shift))
    }

    fn closure(&self, limb: &LimbPlan, pose: &Pose, length: f64) -> (Vector6<f64>, Matrix6<f64>) {
        let tip = pose * limb.platform_from_tip;
        let mut closure = pose_residual(&tip, &self.evaluation.tip_pose()).0;
        for k in 3..6 {
            closure[k] *= length;
        }
        let arm = (tip.translation.vector - pose.translation.vector) / length;
        (closure, shift_matrix(&arm))
    }

    /// Passive joints follow a motion of the platform; the largest step in units of length.
    fn go_along(
        &mut self,
        limb: &LimbPlan,
        pose: &Pose,
        motion: &Vector6<f64>,
        length: f64,
    ) -> f64 {
        let p = limb.passive.len();
        let (closure, shift) = self.closure(limb, pose, length);
        let wanted = closure + shift * motion;
        let mut step = [0.0; MOST_PASSIVE];
        for k in 0..p {
            let axis = Vector6::from(scaled_column(&self.evaluation, limb.passive[k], length));
            step[k] = axis.dot(&wanted);
        }
        solve_cholesky(&self.normal, p, &mut step[..p]);
        let mut most = 0.0_f64;
        for (x, passive) in step.iter().zip(&limb.passive) {
            self.coordinates[*passive] += x;
            most = most.max(x.abs() * length);
        }
        most
    }
}
