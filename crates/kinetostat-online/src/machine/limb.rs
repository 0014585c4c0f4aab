//! One limb: joints of the nominal chain that follow the target, and springs of the actual chain that follow their torques.
//!
//! The nominal chain answers the target by a Newton step of least squares over passive joints and commands. The actual
//! chain has the passive joints in common with it and moves along. Springs take `theta <- theta + C (tau - T(theta))`, `C` their
//! compliance at rest: a step of Newton's iteration with the tangent of the unloaded limb [R 4.16].

use std::ops::Range;

use kinetostat::model::{ChainEvaluation, Load, Role, SpringLaw};
use kinetostat::spatial::{Pose, Twist, Wrench, pose_residual};
use kinetostat::{Chain, Mechanism};
use nalgebra::{Matrix6, Vector6};

use crate::small::{Lu, cholesky, solve_cholesky};

/// Passive joints of a limb at most; more are redundant.
pub(crate) const MOST_PASSIVE: usize = 6;
/// Longest step of a joint in one pass, rad, or share of the natural length.
const LONGEST_STEP: f64 = 0.3;

/// What never changes of a limb.
#[derive(Clone, Debug)]
pub(crate) struct LimbPlan {
    pub nominal: Chain,
    pub actual: Chain,
    pub loads: Vec<Load>,
    pub base: Pose,
    pub platform_from_tip: Pose,
    /// Coordinates that are passive joints.
    pub passive: Vec<usize>,
    /// Its actuators among the joints of the machine.
    pub joints: Range<usize>,
    /// Natural length (m) and stiffness (N/m).
    pub length: f64,
    pub stiffness: f64,
}

/// Buffers and state of a limb.
#[derive(Clone, Debug)]
pub(crate) struct LimbState {
    pub nominal: ChainEvaluation,
    pub actual: ChainEvaluation,
    /// Passive joints of the nominal chain at the target; its springs are at home.
    pub drawn: Vec<f64>,
    /// Springs and passive joints of the actual chain.
    pub bent: Vec<f64>,
    /// Commands that lead the nominal chain to the target.
    pub commands: Vec<f64>,
    /// Wrench on the tip, about it, base axes.
    pub wrench: Wrench,
    /// Compliance of each spring block at rest, row by row.
    compliance: Vec<Vec<f64>>,
    spring_torque: Vec<f64>,
    /// Step of the springs towards their torques.
    pub step: Vec<f64>,
    /// Columns of passive joints and commands, rotations times the natural length.
    columns: Vec<[f64; 6]>,
    normal: Vec<f64>,
    joint_step: Vec<f64>,
    /// Compliance of the tip by its springs alone.
    pub tip_compliance: Matrix6<f64>,
    saddle: Lu<12>,
}

impl LimbPlan {
    pub(crate) fn new(mechanism: &Mechanism, index: usize, first_joint: usize) -> Self {
        let limb = &mechanism.limbs()[index];
        let gravity = mechanism.gravity();
        let weight = (gravity != nalgebra::Vector3::zeros()).then(|| Load::gravity(gravity));
        let scale = limb.actual.scale();
        Self {
            nominal: limb.nominal.clone(),
            actual: limb.actual.clone(),
            loads: weight
                .into_iter()
                .chain(mechanism.loads(index).iter().cloned())
                .collect(),
            base: mechanism.platforms()[limb.from].home,
            platform_from_tip: limb.platform_from_tip,
            passive: limb.actual.indices_of(Role::Passive),
            joints: first_joint..first_joint + limb.nominal.actuators().len(),
            length: scale.length,
            stiffness: scale.stiffness,
        }
    }

    /// State at home, unloaded; `None` if a spring has no compliance at rest.
    pub(crate) fn start(&self) -> Option<LimbState> {
        let home = self.actual.home_coordinates();
        let blocks = self.actual.springs().iter();
        let compliance: Option<Vec<Vec<f64>>> = blocks
            .map(|block| {
                let inverse = block.stiffness_at(&home).try_inverse()?;
                let inverse = 0.5 * (&inverse + inverse.transpose());
                let finite = inverse.iter().all(|x| x.is_finite());
                finite.then(|| inverse.as_slice().to_vec())
            })
            .collect();
        let unknowns = self.passive.len() + self.joints.len();
        Some(LimbState {
            nominal: ChainEvaluation::new(&self.nominal, &[]),
            actual: ChainEvaluation::new(&self.actual, &self.loads),
            drawn: self.nominal.home_coordinates(),
            bent: home.clone(),
            commands: self.nominal.home_commands(),
            wrench: Wrench::zero(),
            compliance: compliance?,
            spring_torque: vec![0.0; home.len()],
            step: vec![0.0; home.len()],
            columns: vec![[0.0; 6]; unknowns],
            normal: vec![0.0; unknowns.min(6).pow(2)],
            joint_step: vec![0.0; unknowns.max(6)],
            tip_compliance: Matrix6::zeros(),
            saddle: Lu::new(),
        })
    }
}

/// Columns of a Jacobian of the tip in units of length.
pub(crate) fn scaled_column(evaluation: &ChainEvaluation, index: usize, length: f64) -> [f64; 6] {
    let jacobian = evaluation.jacobian();
    std::array::from_fn(|k| jacobian[(k, index)] * if k < 3 { 1.0 } else { length })
}

/// A twist in units of length.
pub(crate) fn scaled(twist: &Twist, length: f64) -> [f64; 6] {
    std::array::from_fn(|k| twist.0[k] * if k < 3 { 1.0 } else { length })
}

impl LimbState {
    /// Puts the limb where it is unloaded, its passive joints as those of the nominal chain.
    pub(crate) fn unload(&mut self, plan: &LimbPlan) {
        for (i, x) in self.bent.iter_mut().enumerate() {
            *x = self.drawn[i];
        }
        debug_assert_eq!(self.bent.len(), plan.actual.coordinate_count());
        self.wrench = Wrench::zero();
    }

    /// Factors the least squares of the joints at the present nominal state; false if it is singular.
    pub(crate) fn factor_joints(&mut self, plan: &LimbPlan) -> bool {
        let (n, unknowns) = (plan.nominal.coordinate_count(), self.columns.len());
        self.move_nominal(plan);
        self.nominal.differentiate();
        for j in 0..unknowns {
            let index = match plan.passive.get(j) {
                Some(passive) => *passive,
                None => n + j - plan.passive.len(),
            };
            self.columns[j] = scaled_column(&self.nominal, index, plan.length);
        }
        let size = unknowns.min(6);
        for i in 0..size {
            for j in 0..size {
                self.normal[i * size + j] = if unknowns < 6 {
                    (0..6)
                        .map(|k| self.columns[i][k] * self.columns[j][k])
                        .sum()
                } else {
                    self.columns.iter().map(|c| c[i] * c[j]).sum()
                };
            }
        }
        size > 0 && cholesky(&mut self.normal, size)
    }

    fn move_nominal(&mut self, plan: &LimbPlan) {
        self.nominal
            .move_to(&plan.nominal, &plan.base, &self.drawn, &self.commands);
    }

    /// One step of the joints towards a target of the platform. Passive joints of the actual chain go along. Returns how
    /// far the tip was off before, m (rotations at the natural length).
    pub(crate) fn follow(&mut self, plan: &LimbPlan, target: &Pose) -> f64 {
        self.move_nominal(plan);
        let tip = target * plan.platform_from_tip;
        let off = scaled(&pose_residual(&tip, &self.nominal.tip_pose()), plan.length);
        let size = self.columns.len().min(6);
        let step = &mut self.joint_step;
        if self.columns.len() < 6 {
            for (x, column) in step.iter_mut().zip(&self.columns) {
                *x = (0..6).map(|k| column[k] * off[k]).sum();
            }
            solve_cholesky(&self.normal, size, &mut step[..size]);
        } else {
            let mut multipliers = off;
            solve_cholesky(&self.normal, size, &mut multipliers);
            for (x, column) in step.iter_mut().zip(&self.columns) {
                *x = (0..6).map(|k| column[k] * multipliers[k]).sum();
            }
        }
        let mut share = 1.0_f64;
        for x in step.iter().take(self.columns.len()) {
            share = share.min(LONGEST_STEP * plan.length.max(1.0) / x.abs().max(f64::MIN_POSITIVE));
        }
        for (j, x) in step.iter().take(self.columns.len()).enumerate() {
            match plan.passive.get(j) {
                Some(passive) => {
                    self.drawn[*passive] += share * x;
                    self.bent[*passive] += share * x;
                }
                None => self.commands[j - plan.passive.len()] += share * x,
            }
        }
        off.iter().map(|x| x * x).sum::<f64>().sqrt()
    }

    /// Moves the actual chain to its springs, passive joints and commands.
    pub(crate) fn move_actual(&mut self, plan: &LimbPlan) {
        self.actual
            .move_to(&plan.actual, &plan.base, &self.bent, &self.commands);
    }

    /// Jacobian and compliance of the tip at the present state, and the factors of the limb held at its tip.
    pub(crate) fn factor_springs(&mut self, plan: &LimbPlan) -> bool {
        self.move_actual(plan);
        self.actual.differentiate();
        for (block, compliance) in plan.actual.springs().iter().zip(&mut self.compliance) {
            // The one law whose matrix depends on the posture.
            if let SpringLaw::Parallelogram(law) = &block.law {
                let Some(inverse) = law.matrix(self.drawn[law.inclination]).try_inverse() else {
                    return false;
                };
                compliance.copy_from_slice(inverse.as_slice());
            }
        }
        let jacobian = self.actual.jacobian();
        let mut sum = Matrix6::zeros();
        for (block, compliance) in plan.actual.springs().iter().zip(&self.compliance) {
            let k = block.len();
            for i in 0..k {
                let mut moved = Vector6::<f64>::zeros();
                for j in 0..k {
                    let share = compliance[i * k + j];
                    if share != 0.0 {
                        for row in 0..6 {
                            moved[row] += share * jacobian[(row, block.first + j)];
                        }
                    }
                }
                for row in 0..6 {
                    for column in 0..6 {
                        sum[(row, column)] += jacobian[(row, block.first + i)] * moved[column];
                    }
                }
            }
        }
        self.tip_compliance = sum;
        sum.iter().all(|x| x.is_finite())
    }

    /// Factors `[C, J_q; J_q^T, 0]`, wrenches in units of the natural stiffness; false if it is singular.
    pub(crate) fn factor_held(&mut self, plan: &LimbPlan) -> bool {
        let (jacobian, passive) = (self.actual.jacobian(), &plan.passive);
        let compliance = &self.tip_compliance;
        self.saddle
            .factor(6 + passive.len(), |i, j| match (i < 6, j < 6) {
                (true, true) => compliance[(i, j)] * plan.stiffness,
                (true, false) => jacobian[(i, passive[j - 6])],
                (false, true) => jacobian[(j, passive[i - 6])],
                (false, false) => 0.0,
            })
    }

    /// Change of the wrench on the tip (N, N m) and of the passive joints that meets a motion of the tip and torques of
    /// passive joints that are not balanced.
    pub(crate) fn hold(
        &self,
        plan: &LimbPlan,
        motion: &Vector6<f64>,
        unbalanced: &[f64; MOST_PASSIVE],
    ) -> (Vector6<f64>, [f64; MOST_PASSIVE]) {
        let mut right = [0.0; 12];
        right[..6].copy_from_slice(motion.as_slice());
        for k in 0..plan.passive.len() {
            right[6 + k] = -unbalanced[k] / plan.stiffness;
        }
        let found = self.saddle.solve(&right);
        let wrench = Vector6::from_fn(|k, _| found[k] * plan.stiffness);
        (wrench, std::array::from_fn(|k| found[6 + k]))
    }

    /// Torques at the present pose under the wrench on the tip, and the step of the springs towards them. Returns the motion
    /// of the tip by that step; `unbalanced` are the torques of passive joints.
    pub(crate) fn spring_step(
        &mut self,
        plan: &LimbPlan,
        unbalanced: &mut [f64; MOST_PASSIVE],
    ) -> Vector6<f64> {
        self.actual.load(&plan.actual, &plan.loads, &self.wrench);
        self.spring_torque.fill(0.0);
        for block in plan.actual.springs() {
            block.add_torque(&self.bent, &self.drawn, &mut self.spring_torque);
        }
        let torques = self.actual.torques();
        for (k, passive) in plan.passive.iter().enumerate() {
            unbalanced[k] = torques[*passive];
        }
        let mut moved = Vector6::zeros();
        let jacobian = self.actual.jacobian();
        for (block, compliance) in plan.actual.springs().iter().zip(&self.compliance) {
            let (k, first) = (block.len(), block.first);
            for i in 0..k {
                let step: f64 = (0..k)
                    .map(|j| {
                        compliance[i * k + j] * (torques[first + j] - self.spring_torque[first + j])
                    })
                    .sum();
                self.step[first + i] = step;
                for row in 0..6 {
                    moved[row] += jacobian[(row, first + i)] * step;
                }
            }
        }
        moved
    }

    /// Adds to the step of the springs what a change of the wrench on the tip bends them by.
    pub(crate) fn bend_by(&mut self, plan: &LimbPlan, wrench: &Vector6<f64>) {
        let jacobian = self.actual.jacobian();
        for (block, compliance) in plan.actual.springs().iter().zip(&self.compliance) {
            let (k, first) = (block.len(), block.first);
            for j in 0..k {
                let torque: f64 = (0..6)
                    .map(|row| jacobian[(row, first + j)] * wrench[row])
                    .sum();
                for i in 0..k {
                    self.step[first + i] += compliance[i * k + j] * torque;
                }
            }
        }
    }

    /// Takes the step of the springs.
    pub(crate) fn take_step(&mut self) {
        for (x, step) in self.bent.iter_mut().zip(&self.step) {
            *x += step;
        }
    }

    /// True if all numbers are finite and no spring or passive joint has gone far beyond anything physical.
    pub(crate) fn is_sound(&self, plan: &LimbPlan) -> bool {
        let far = 1e3 * plan.length.max(1.0);
        let lists = self.bent.iter().chain(&self.drawn).chain(&self.commands);
        lists.chain(self.wrench.0.iter()).all(|x| x.is_finite())
            && self.bent.iter().all(|x| x.abs() < far)
    }
}
