//! One limb under load: springs of the actual chain that follow their torques, passive joints and wrench that follow the platform.
//!
//! Springs take `theta <- theta + C (tau - T(theta))`, `C` their compliance at rest: a step of Newton's iteration with the
//! tangent of the unloaded limb [R 4.16]. Passive joints go along with those of the nominal chain, and by `[C, J_q; J_q^T, 0]`.

use kinetostat::model::{ChainEvaluation, SpringLaw};
use kinetostat::spatial::{Pose, Wrench};
use nalgebra::{Matrix6, Vector6};

use crate::machine::joints::Joints;
use crate::machine::model::{LimbPlan, MOST_PASSIVE};
use crate::small::Lu;

/// State of a limb and its buffers.
#[derive(Clone, Debug)]
pub(crate) struct LimbState {
    /// Nominal chain at the target.
    pub joints: Joints,
    actual: ChainEvaluation,
    /// Springs and passive joints of the actual chain.
    bent: Vec<f64>,
    /// Wrench on the tip, about it, base axes.
    pub wrench: Wrench,
    /// Compliance of each spring block at rest, row by row.
    compliance: Vec<Vec<f64>>,
    spring_torque: Vec<f64>,
    /// Step of the springs towards their torques.
    pub step: Vec<f64>,
    /// Compliance of the tip by the springs alone.
    pub tip_compliance: Matrix6<f64>,
    saddle: Lu<12>,
}

impl LimbState {
    /// At home, unloaded; `None` if a spring has no compliance at rest.
    pub(crate) fn new(plan: &LimbPlan) -> Option<Self> {
        let home = plan.actual.home_coordinates();
        let blocks = plan.actual.springs().iter().map(|block| {
            let inverse = block.stiffness_at(&home).try_inverse()?;
            let inverse = 0.5 * (&inverse + inverse.transpose());
            let finite = inverse.iter().all(|x| x.is_finite());
            finite.then(|| inverse.as_slice().to_vec())
        });
        Some(Self {
            compliance: blocks.collect::<Option<_>>()?,
            joints: Joints::new(plan, true),
            actual: ChainEvaluation::new(&plan.actual, &plan.loads),
            spring_torque: vec![0.0; home.len()],
            step: vec![0.0; home.len()],
            bent: home,
            wrench: Wrench::zero(),
            tip_compliance: Matrix6::zeros(),
            saddle: Lu::new(),
        })
    }

    /// Puts the limb where it is unloaded, at these coordinates and commands of the nominal chain.
    pub(crate) fn unload(&mut self, coordinates: &[f64], commands: &[f64]) {
        self.joints.coordinates.copy_from_slice(coordinates);
        self.joints.commands.copy_from_slice(commands);
        self.bent.copy_from_slice(coordinates);
        self.wrench = Wrench::zero();
    }

    /// Takes the passive joints of both chains along to those of the program, where it jumps.
    pub(crate) fn jump(&mut self, plan: &LimbPlan, coordinates: &[f64]) {
        for i in &plan.passive {
            self.bent[*i] += coordinates[*i] - self.joints.coordinates[*i];
            self.joints.coordinates[*i] = coordinates[*i];
        }
    }

    /// One step of the joints towards the target, and the actual chain with them. Returns how far the tip was off, m.
    pub(crate) fn follow(&mut self, plan: &LimbPlan, target: &Pose) -> f64 {
        let tip = self.joints.tip(plan);
        let (off, share) = self.joints.follow(plan, target, &tip);
        for (i, step) in plan.passive.iter().zip(&self.joints.step) {
            self.bent[*i] += share * step;
        }
        self.move_actual(plan);
        off
    }

    pub(crate) fn move_actual(&mut self, plan: &LimbPlan) {
        let commands = &self.joints.commands;
        self.actual
            .move_to(&plan.actual, &plan.base, &self.bent, commands);
    }

    pub(crate) fn tip(&self) -> Pose {
        self.actual.tip_pose()
    }

    /// Deflections of the springs under torques.
    fn deflect(
        plan: &LimbPlan,
        compliance: &[Vec<f64>],
        torque: impl Fn(usize) -> f64,
        mut take: impl FnMut(usize, f64),
    ) {
        for (block, own) in plan.actual.springs().iter().zip(compliance) {
            let k = block.len();
            for i in 0..k {
                let row = (0..k).map(|j| own[i * k + j] * torque(block.first + j));
                take(block.first + i, row.sum());
            }
        }
    }

    /// Compliance of the laws for which that at rest is not good enough: the matrix of a parallelogram depends on the posture, and a gear
    /// that stiffens at its knee would throw the iteration back and forth. False if one is singular.
    fn update_compliance(&mut self, plan: &LimbPlan) -> bool {
        for (block, compliance) in plan.actual.springs().iter().zip(&mut self.compliance) {
            match &block.law {
                SpringLaw::Parallelogram(law) => {
                    let inclination = self.joints.coordinates[law.inclination];
                    let Some(inverse) = law.matrix(inclination).try_inverse() else {
                        return false;
                    };
                    compliance.copy_from_slice(inverse.as_slice());
                }
                SpringLaw::Bilinear(law) => {
                    let deflection = self.bent[block.first] - block.rest[0];
                    let is_beyond = deflection.abs() > law.knee;
                    compliance[0] = if is_beyond { law.beyond } else { law.stiffness }.recip();
                }
                _ => {}
            }
        }
        true
    }

    /// Jacobian, and compliance of the tip, at the present state; false where they are not finite.
    pub(crate) fn differentiate(&mut self, plan: &LimbPlan) -> bool {
        self.move_actual(plan);
        self.actual.differentiate();
        if !self.update_compliance(plan) {
            return false;
        }
        let (jacobian, compliance) = (self.actual.jacobian(), &self.compliance);
        let mut sum = Matrix6::zeros();
        for column in 0..6 {
            let torque = |i: usize| jacobian[(column, i)];
            Self::deflect(plan, compliance, torque, |i, x| {
                let mut own = sum.column_mut(column);
                own.axpy(x, &jacobian.column(i), 1.0);
            });
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
        let right = std::array::from_fn(|k| match k < 6 {
            true => motion[k],
            false => -unbalanced[k - 6] / plan.stiffness,
        });
        let found = self.saddle.solve(&right);
        let wrench = Vector6::from_fn(|k, _| found[k] * plan.stiffness);
        (wrench, std::array::from_fn(|k| found[6 + k]))
    }

    /// Torques at the present pose under the wrench on the tip, and the step of the springs towards them. Returns the motion
    /// of the tip by that step, and the torques of passive joints.
    pub(crate) fn spring_step(&mut self, plan: &LimbPlan) -> (Vector6<f64>, [f64; MOST_PASSIVE]) {
        self.actual.load(&plan.actual, &plan.loads, &self.wrench);
        self.update_compliance(plan);
        self.spring_torque.fill(0.0);
        for block in plan.actual.springs() {
            block.add_torque(
                &self.bent,
                &self.joints.coordinates,
                &mut self.spring_torque,
            );
        }
        let (torques, own) = (self.actual.torques(), &self.spring_torque);
        let (jacobian, step) = (self.actual.jacobian(), &mut self.step);
        let mut moved = Vector6::zeros();
        let unbalanced = |i: usize| torques[i] - own[i];
        Self::deflect(plan, &self.compliance, unbalanced, |i, x| {
            step[i] = x;
            moved.axpy(x, &jacobian.column(i), 1.0);
        });
        let passive = |k: usize| plan.passive.get(k).map_or(0.0, |i| torques[*i]);
        (moved, std::array::from_fn(passive))
    }

    /// Takes the step of the springs and what a change of the wrench bends them by; passive joints take theirs.
    pub(crate) fn take_step(
        &mut self,
        plan: &LimbPlan,
        wrench: &Vector6<f64>,
        joints: &[f64; MOST_PASSIVE],
    ) {
        let (jacobian, step) = (self.actual.jacobian(), &mut self.step);
        let torque = |i: usize| jacobian.column(i).dot(wrench);
        Self::deflect(plan, &self.compliance, torque, |i, x| step[i] += x);
        self.wrench.0 += wrench;
        for (x, step) in self.bent.iter_mut().zip(&self.step) {
            *x += step;
        }
        for (i, step) in plan.passive.iter().zip(joints) {
            self.bent[*i] += step;
        }
    }

    /// True if all numbers are finite and nothing has gone far beyond anything physical.
    pub(crate) fn is_sound(&self, plan: &LimbPlan, joints: &[f64]) -> bool {
        let far = 1e3 * plan.length.max(1.0);
        self.joints.is_near(plan, joints)
            && self.bent.iter().all(|x| x.abs() < far)
            && self.wrench.0.iter().all(|x| x.is_finite())
    }
}
