//! Inverse kinematics of a limb from its nominal, unloaded geometry: actuator commands and passive
//! joints for a pose of the tip.

use nalgebra::{DMatrix, DVector};

use crate::error::{Error, Place, Result};
use crate::linalg::saddle::pseudo_inverse;
use crate::model::chain::{Chain, Drive, Element, Motion, Role};
use crate::model::kinematics::Kinematics;
use crate::spatial::{MotionKind, Pose, pose_residual};

/// Joints of a limb at a pose.
#[derive(Clone, Debug, PartialEq)]
pub struct LimbPosture {
    /// Actuator commands, m or rad.
    pub commands: Vec<f64>,
    /// All coordinates (springs at their home, zero unless given; passive joints as they come), m or
    /// rad.
    pub coordinates: Vec<f64>,
}

/// The joints that bring the tip of the unloaded `chain` to `target` (base of the chain at `base`),
/// nearest to `start`; `None` starts from the chain's home.
///
/// # Errors
/// [`Error::Unreachable`] with the nearest pose found; numbers that are not finite or absurdly large,
/// a start that is not of this chain.
pub fn inverse_kinematics(
    chain: &Chain,
    base: &Pose,
    target: &Pose,
    start: Option<&LimbPosture>,
) -> Result<LimbPosture> {
    let place = Place::limb(chain.name());
    for (what, pose) in [("the pose of the base", base), ("the target pose", target)] {
        crate::model::limits::check_pose(&place, what, pose)?;
    }
    if let Some(start) = start {
        chain.check(&start.coordinates, &start.commands)?;
    }
    let mut search = JointSearch::new(chain, base, target);
    let home = LimbPosture {
        commands: chain.home_commands(),
        coordinates: chain.home_coordinates(),
    };
    let first = start.unwrap_or(&home);
    let mut nearest = match search.run(first.clone()) {
        Ok(found) => return Ok(found),
        Err(failed) => failed,
    };
    // Starts elsewhere: along the path from home, then from irregular postures around it.
    if let Ok(found) = search.by_continuation(&home) {
        return Ok(found);
    }
    for attempt in 1..=12_u32 {
        let spread = 0.3 + 0.1 * f64::from(attempt);
        let nudge = |i: usize, x: f64| {
            x + spread * (((i + 1) as f64 * f64::from(attempt) * 0.618_034).fract() - 0.5)
        };
        let mut trial = home.clone();
        for (i, c) in trial.commands.iter_mut().enumerate() {
            *c = nudge(i + 17, *c);
        }
        for (i, x) in trial.coordinates.iter_mut().enumerate() {
            if chain.coordinates()[i].role == Role::Passive {
                *x = nudge(i, *x);
            }
        }
        match search.run(trial) {
            Ok(found) => return Ok(found),
            Err(failed) if failed.0 < nearest.0 => nearest = failed,
            Err(_) => {}
        }
    }
    let (_, pose) = nearest;
    let residual = pose_residual(target, &pose);
    Err(Error::Unreachable {
        place,
        distance_m: residual.linear().norm(),
        angle_rad: residual.angular().norm(),
        nearest: Box::new(pose),
    })
}

/// Motion of the commands per motion of the tip, r x 6 (least squares over the directions that the
/// limb can move in), at a posture.
#[must_use]
pub(crate) fn command_rates(chain: &Chain, base: &Pose, posture: &LimbPosture) -> DMatrix<f64> {
    let search = JointSearch::new(chain, base, &Pose::identity());
    let kinematics = Kinematics::new(chain, base, &posture.coordinates, &posture.commands);
    let jacobian = search.jacobian(&kinematics);
    // Normal equations, if the joints are certainly independent.
    let inverse = (jacobian.transpose() * &jacobian)
        .cholesky()
        .filter(|c| {
            let d = c.l_dirty().diagonal();
            d.min() > 1e-4 * d.max()
        })
        .map_or_else(
            || pseudo_inverse(&jacobian).0,
            |c| c.solve(&jacobian.transpose()),
        );
    let (passive, r) = (search.passive.len(), posture.commands.len());
    let weights = search.weights();
    DMatrix::from_fn(r, 6, |i, j| inverse[(passive + i, j)] * weights[j])
}

/// Motions that the unloaded limb can make at a posture: orthogonal projector on the twists that it
/// cannot make, 6 x 6, in scaled units (rotations times the natural length).
pub(crate) fn blocked_motions(chain: &Chain, base: &Pose, posture: &LimbPosture) -> DMatrix<f64> {
    let search = JointSearch::new(chain, base, &Pose::identity());
    let kinematics = Kinematics::new(chain, base, &posture.coordinates, &posture.commands);
    let jacobian = search.jacobian(&kinematics);
    let (inverse, _) = pseudo_inverse(&jacobian);
    DMatrix::identity(6, 6) - jacobian * inverse
}

struct JointSearch<'a> {
    chain: &'a Chain,
    base: &'a Pose,
    target: Pose,
    passive: Vec<usize>,
    length: f64,
}

impl<'a> JointSearch<'a> {
    fn new(chain: &'a Chain, base: &'a Pose, target: &Pose) -> Self {
        Self {
            chain,
            base,
            target: *target,
            passive: chain.indices_of(Role::Passive),
            length: chain.scale().length,
        }
    }

    /// Scales of the six components of a pose residual.
    fn weights(&self) -> [f64; 6] {
        let l = self.length;
        [1.0, 1.0, 1.0, l, l, l]
    }

    /// 6 x (n_q + r), rotations of the tip times the natural length.
    fn jacobian(&self, kinematics: &Kinematics) -> DMatrix<f64> {
        let all = kinematics.jacobian(self.chain.tip());
        let n = self.chain.coordinate_count();
        let weights = self.weights();
        let columns = self.passive.len() + self.chain.actuators().len();
        DMatrix::from_fn(6, columns, |i, j| {
            let index = self
                .passive
                .get(j)
                .copied()
                .unwrap_or(n + j.saturating_sub(self.passive.len()));
            all[(i, index)] * weights[i]
        })
    }

    fn pose_residual(&self, kinematics: &Kinematics) -> DVector<f64> {
        let e = pose_residual(&self.target, &kinematics.tip_pose()).0;
        let weights = self.weights();
        DVector::from_fn(6, |i, _| e[i] * weights[i])
    }

    /// Levenberg-Marquardt from `at`; `Err` holds the remaining distance and pose.
    fn run(&mut self, mut at: LimbPosture) -> std::result::Result<LimbPosture, (f64, Pose)> {
        let mut kinematics = Kinematics::new(self.chain, self.base, &at.coordinates, &at.commands);
        let mut residual = self.pose_residual(&kinematics);
        let mut damping = 0.0_f64;
        let goal = 1e-13 * self.length;
        let mut polished = false;
        for _ in 0..100 {
            let size = residual.norm();
            if size <= goal || (polished && size <= 100.0 * goal) {
                return Ok(self.wrapped(at));
            }
            let jacobian = self.jacobian(&kinematics);
            let normal = jacobian.transpose() * &jacobian;
            let gradient = jacobian.transpose() * &residual;
            if gradient.norm() <= 1e-15 * size * jacobian.norm() {
                break;
            }
            let step = if damping == 0.0 {
                normal
                    .clone()
                    .cholesky()
                    .filter(|c| {
                        let d = c.l_dirty().diagonal();
                        d.min() > 1e-5 * d.max()
                    })
                    .map_or_else(
                        || pseudo_inverse(&jacobian).0 * &residual,
                        |c| c.solve(&gradient),
                    )
            } else {
                let mut damped = normal;
                for i in 0..damped.nrows() {
                    damped[(i, i)] += damping;
                }
                match damped.cholesky() {
                    Some(c) => c.solve(&gradient),
                    None => break,
                }
            };
            let mut trial = at.clone();
            let length = self.limit(&step);
            for (k, &i) in self.passive.iter().enumerate() {
                trial.coordinates[i] += length * step[k];
            }
            for (k, c) in trial.commands.iter_mut().enumerate() {
                *c += length * step[self.passive.len() + k];
            }
            kinematics.update(self.chain, self.base, &trial.coordinates, &trial.commands);
            let next = self.pose_residual(&kinematics);
            if next.norm() < size {
                polished = next.norm() > 0.5 * size;
                (at, residual) = (trial, next);
                damping *= 0.1;
                if damping < 1e-9 {
                    damping = 0.0;
                }
            } else {
                if size <= 1e3 * goal {
                    return Ok(self.wrapped(at));
                }
                kinematics.update(self.chain, self.base, &at.coordinates, &at.commands);
                damping = (10.0 * damping).max(1e-8);
                if damping > 1e8 {
                    break;
                }
            }
        }
        Err((residual.norm(), kinematics.tip_pose()))
    }

    /// Follows the straight path from home to the target in small steps.
    fn by_continuation(
        &mut self,
        home: &LimbPosture,
    ) -> std::result::Result<LimbPosture, (f64, Pose)> {
        let goal = self.target;
        let start =
            Kinematics::new(self.chain, self.base, &home.coordinates, &home.commands).tip_pose();
        let motion = pose_residual(&goal, &start);
        let mut at = home.clone();
        let steps = 16;
        for k in 1..=steps {
            let share = f64::from(k) / f64::from(steps);
            self.target = if k == steps {
                goal
            } else {
                crate::spatial::moved(&start, &crate::spatial::Twist(motion.0 * share))
            };
            let found = self.run(at);
            match found {
                Ok(next) => at = next,
                Err(failed) => {
                    self.target = goal;
                    return Err(failed);
                }
            }
        }
        Ok(at)
    }

    fn limit(&self, step: &DVector<f64>) -> f64 {
        let kind = |k: usize| match self.passive.get(k) {
            Some(&i) => self.chain.coordinates()[i].kind,
            None => self.chain.actuators()[k - self.passive.len()].kind,
        };
        step.iter().enumerate().fold(1.0_f64, |limit, (k, dx)| {
            let most = match kind(k) {
                MotionKind::Revolute => 0.5,
                MotionKind::Prismatic => self.length,
            };
            limit.min(most / dx.abs().max(1e-300))
        })
    }

    fn wrapped(&self, mut at: LimbPosture) -> LimbPosture {
        wrap(self.chain, &mut at);
        at
    }
}

/// Passive rotations in (-pi, pi]; actuators with limits in the turn nearest to their range.
pub(crate) fn wrap(chain: &Chain, at: &mut LimbPosture) {
    wrap_passive(chain, at);
    let turn = std::f64::consts::TAU;
    for (i, (command, a)) in at.commands.iter_mut().zip(chain.actuators()).enumerate() {
        if let (MotionKind::Revolute, Some((low, high))) = (a.kind, a.limits)
            && (*command < low || *command > high)
            && periodic(chain, |m| m.command.filter(|d| d.index == i))
        {
            *command -= turn * ((*command - 0.5 * (low + high)) / turn).round();
        }
    }
}

/// Passive rotations in (-pi, pi].
pub(crate) fn wrap_passive(chain: &Chain, at: &mut LimbPosture) {
    let turn = std::f64::consts::TAU;
    for (i, c) in chain.coordinates().iter().enumerate() {
        if c.role == Role::Passive
            && c.kind == MotionKind::Revolute
            && at.coordinates[i].abs() > std::f64::consts::PI
            && periodic(chain, |m| m.coordinate.filter(|d| d.index == i))
        {
            at.coordinates[i] -= turn * (at.coordinates[i] / turn).round();
        }
    }
}

/// A full turn of what drives these motions changes nothing: not so where it drives a screw or a gear.
fn periodic(chain: &Chain, driven: impl Fn(&Motion) -> Option<Drive>) -> bool {
    chain.elements().iter().all(|element| match element {
        Element::Motion(motion) => driven(motion)
            .is_none_or(|d| motion.kind == MotionKind::Revolute && d.ratio.fract() == 0.0),
        _ => true,
    })
}
