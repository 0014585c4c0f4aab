//! Joints of a limb's nominal chain that follow a target of its tip: Newton steps of least squares, rotations at the natural length.
//!
//! ```text
//! fewer than six unknowns   (J^T J) d = J^T e          six or more   d = J^T (J J^T)^-1 e      (least motion)
//! ```

use kinetostat::model::ChainEvaluation;
use kinetostat::spatial::{Pose, pose_residual};
use nalgebra::Vector6;

use crate::machine::model::LimbPlan;
use crate::small::Lu;

/// Longest step of a joint in one pass, rad, or share of the natural length.
const LONGEST_STEP: f64 = 0.3;

/// Joints beyond this, rad or share of the natural length, from those of the program are no correction.
pub(crate) const FARTHEST: f64 = 0.25;

/// Nominal chain of a limb with springs at home; unknown are its passive joints, or these and its commands.
#[derive(Clone, Debug)]
pub(crate) struct Joints {
    evaluation: ChainEvaluation,
    pub coordinates: Vec<f64>,
    pub commands: Vec<f64>,
    /// Columns of the Jacobian: passive joints first.
    indices: Vec<usize>,
    columns: Vec<Vector6<f64>>,
    factor: Lu<6>,
    pub step: Vec<f64>,
}

impl Joints {
    pub(crate) fn new(plan: &LimbPlan, with_commands: bool) -> Self {
        let (n, chain) = (plan.nominal.coordinate_count(), &plan.nominal);
        let commands = if with_commands { plan.joints.len() } else { 0 };
        let indices: Vec<usize> = plan
            .passive
            .iter()
            .copied()
            .chain(n..n + commands)
            .collect();
        Self {
            evaluation: ChainEvaluation::new(chain, &[]),
            coordinates: chain.home_coordinates(),
            commands: chain.home_commands(),
            columns: vec![Vector6::zeros(); indices.len()],
            step: vec![0.0; indices.len()],
            indices,
            factor: Lu::new(),
        }
    }

    /// Moves the chain to its present joints; the pose of its tip.
    pub(crate) fn tip(&mut self, plan: &LimbPlan) -> Pose {
        let (own, commands) = (&self.coordinates, &self.commands);
        self.evaluation
            .move_to(&plan.nominal, &plan.base, own, commands);
        self.evaluation.tip_pose()
    }

    /// Factors the least squares at the present joints; false if it is singular.
    pub(crate) fn factor(&mut self, plan: &LimbPlan) -> bool {
        self.tip(plan);
        self.evaluation.differentiate();
        for (column, index) in self.columns.iter_mut().zip(&self.indices) {
            *column = self.evaluation.jacobian().column(*index).into_owned();
            column.fixed_rows_mut::<3>(3).scale_mut(plan.length);
        }
        let columns = &self.columns;
        self.factor
            .factor(columns.len().min(6), |i, j| match columns.len() < 6 {
                true => columns[i].dot(&columns[j]),
                false => columns.iter().map(|c| c[i] * c[j]).sum(),
            })
    }

    /// Steps of the joints that come nearest to a motion of the tip (rotations at the natural length), and the motion that they make.
    pub(crate) fn answer(&mut self, motion: &Vector6<f64>) -> Vector6<f64> {
        if self.columns.len() < 6 {
            let mut right = [0.0; 6];
            for (x, column) in right.iter_mut().zip(&self.columns) {
                *x = column.dot(motion);
            }
            self.step
                .copy_from_slice(&self.factor.solve(&right)[..self.columns.len()]);
        } else {
            let multipliers = Vector6::from(self.factor.solve(&(*motion).into()));
            for (x, column) in self.step.iter_mut().zip(&self.columns) {
                *x = column.dot(&multipliers);
            }
        }
        let own = self.columns.iter().zip(&self.step);
        own.fold(Vector6::zeros(), |sum, (column, x)| sum + column * *x)
    }

    /// Takes the steps, shortened alike where one is too long. Returns the share taken.
    pub(crate) fn take_steps(&mut self, plan: &LimbPlan) -> f64 {
        let most = self
            .step
            .iter()
            .fold(0.0_f64, |most, x| kinetostat::number::larger(most, x.abs()));
        let share = (LONGEST_STEP * plan.length.max(1.0) / most.max(f64::MIN_POSITIVE)).min(1.0);
        let n = self.coordinates.len();
        for (index, step) in self.indices.iter().zip(&self.step) {
            match index.checked_sub(n) {
                Some(command) => self.commands[command] += share * step,
                None => self.coordinates[*index] += share * step,
            }
        }
        share
    }

    /// One step towards a target of the platform, from the present pose of the tip. Returns how far the tip was off, in units of
    /// length, and the share taken.
    pub(crate) fn follow(&mut self, plan: &LimbPlan, target: &Pose, tip: &Pose) -> (f64, f64) {
        let off = plan.in_length(pose_residual(&(target * plan.platform_from_tip), tip).0);
        self.answer(&off);
        (off.norm(), self.take_steps(plan))
    }

    /// True if all numbers are finite and the commands lie beside the joints of the program: near a singular posture they diverge, or
    /// settle on another branch.
    pub(crate) fn is_near(&self, plan: &LimbPlan, joints: &[f64]) -> bool {
        let beside = |(x, joint): (&f64, &f64)| (x - joint).abs() < FARTHEST * plan.length.max(1.0);
        self.coordinates.iter().all(|x| x.is_finite())
            && self.commands.iter().zip(joints).all(beside)
    }
}
