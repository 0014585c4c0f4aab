//! Forward kinematics: where the unloaded nominal machine stands with known actuator commands.
//!
//! A chain alone is a product. Loops are closed by Newton's iteration on the motions of the platforms
//! and of the passive joints, `J_q dq + B dP_from - T dP_to = c` for every limb with its closure `c`,
//! followed from home by steps of the commands, so that the shape is the one that leads there.

use nalgebra::{DMatrix, DVector, Vector6};

use crate::error::{Error, Result};
use crate::linalg::saddle::{Saddle, pseudo_inverse, rows_certainly_independent};
use crate::machine::inverse::limb::{LimbPosture, wrap_passive};
use crate::machine::posture::Posture;
use crate::model::chain::Role;
use crate::model::kinematics::{Kinematics, unloaded_tip};
use crate::model::mechanism::Mechanism;
use crate::number::larger;
use crate::spatial::{MotionKind, Pose, Twist, moved, pose_residual, shift_matrix};

/// Largest motion of a command between two closed shapes, rad or natural lengths.
const STRIDE: f64 = 0.2;

/// Platforms and joints on the way.
#[derive(Clone)]
struct ClosedShape {
    platforms: Vec<Pose>,
    limbs: Vec<LimbPosture>,
}

/// The shortest solution of `matrix * step = closure`, or what comes nearest to one. Singular values
/// only where rows or columns may depend on each other.
fn shortest(matrix: &DMatrix<f64>, closure: &DVector<f64>) -> DVector<f64> {
    let (rows, columns) = matrix.shape();
    let transposed = matrix.transpose();
    if rows == columns {
        let units = vec![1.0; rows];
        let mut b = DMatrix::from_column_slice(rows, 1, closure.as_slice());
        Saddle::new(matrix.clone(), &units, &units).solve(&mut b);
        return b.column(0).into_owned();
    }
    // Newton's iteration mends what the squares of the Gram matrix lose.
    let regular = match rows < columns {
        true => rows_certainly_independent(matrix).then(|| matrix * &transposed),
        false => rows_certainly_independent(&transposed).then(|| &transposed * matrix),
    };
    let solved = regular
        .and_then(nalgebra::DMatrix::cholesky)
        .map(|gram| match rows < columns {
            true => &transposed * gram.solve(closure),
            false => gram.solve(&(&transposed * closure)),
        });
    solved.unwrap_or_else(|| pseudo_inverse(matrix).0 * closure)
}

impl Mechanism {
    /// The posture with these actuator commands (m or rad, in the order of
    /// [`Self::actuator_names`]): nominal geometry, springs at their home, passive joints and
    /// platforms where the loops lead them from home.
    ///
    /// # Errors
    /// A list of the wrong length or a number that is not finite; [`Error::NoClosure`] where the
    /// loops do not close all the way from home to these commands.
    pub(crate) fn posture_at_commands(&self, commands: &[f64]) -> Result<Posture> {
        let place = || self.place();
        if commands.len() != self.actuator_count() {
            return Err(Error::Size {
                place: place(),
                what: "commands",
                expected: self.actuator_count(),
                found: commands.len(),
            });
        }
        let mut rest = commands;
        let wanted: Vec<&[f64]> = self
            .limbs()
            .iter()
            .map(|limb| {
                let (own, others) = rest.split_at(limb.nominal.actuators.len());
                rest = others;
                own
            })
            .collect();
        for (limb, own) in self.limbs().iter().zip(&wanted) {
            limb.nominal.check(&limb.nominal.home_coordinates(), own)?;
        }
        if let [limb] = self.limbs()
            && limb.nominal.indices_of(Role::Passive).is_empty()
        {
            return self.open(limb.nominal.home_coordinates(), wanted[0].to_vec());
        }
        let home = self.posture(&self.platforms()[self.tool()].home)?;
        let mut at = ClosedShape {
            platforms: home.platforms().to_vec(),
            limbs: home.limbs().to_vec(),
        };
        let start = at.limbs.clone();
        let length = self.scale().length;
        let longest = self
            .limbs()
            .iter()
            .zip(wanted.iter().zip(&start))
            .flat_map(|(limb, (to, from))| {
                let all = limb
                    .nominal
                    .actuators
                    .iter()
                    .zip(to.iter().zip(&from.commands));
                all.map(|(a, (to, from))| match a.kind {
                    MotionKind::Prismatic => (to - from).abs() / length,
                    MotionKind::Revolute => (to - from).abs(),
                })
            })
            .fold(0.0, larger);
        let (mut share, mut step) = (0.0_f64, 1.0 / (longest / STRIDE).ceil().clamp(1.0, 1e4));
        let least = 1e-3 * step;
        let mut closed = false;
        while !closed {
            let next = (share + step).min(1.0);
            let mut trial = at.clone();
            for (limb, (to, from)) in trial.limbs.iter_mut().zip(wanted.iter().zip(&start)) {
                for (c, (to, from)) in limb.commands.iter_mut().zip(to.iter().zip(&from.commands)) {
                    *c = if next < 1.0 {
                        from + next * (to - from)
                    } else {
                        *to
                    };
                }
            }
            match self.close(trial) {
                Ok(shape) => {
                    (at, share) = (shape, next);
                    closed = share >= 1.0;
                    step *= 1.5;
                }
                Err((gap_m, gap_rad)) => {
                    step *= 0.5;
                    if step < least {
                        return Err(Error::NoClosure {
                            place: place(),
                            share,
                            gap_m,
                            gap_rad,
                        });
                    }
                }
            }
        }
        for (limb, joints) in self.limbs().iter().zip(&mut at.limbs) {
            wrap_passive(&limb.nominal, joints);
        }
        self.posture_from_joints(&at.platforms[self.tool()], at.limbs)
    }

    /// A single limb whose joints are all known.
    fn open(&self, coordinates: Vec<f64>, commands: Vec<f64>) -> Result<Posture> {
        let limb = &self.limbs()[0];
        let base = &self.platforms()[limb.from].home;
        let tip = unloaded_tip(&limb.nominal, base, &coordinates, &commands);
        let target = tip * limb.platform_from_tip.inverse();
        let joints = LimbPosture {
            commands,
            coordinates,
        };
        self.posture_from_joints(&target, vec![joints])
    }

    /// Moves platforms and passive joints until every loop closes; `Err` holds the closure residual.
    fn close(&self, mut at: ClosedShape) -> std::result::Result<ClosedShape, (f64, f64)> {
        let length = self.scale().length;
        let moving = 6 * (self.platforms().len() - 1);
        let passive: Vec<Vec<usize>> = self
            .limbs()
            .iter()
            .map(|l| l.nominal.indices_of(Role::Passive))
            .collect();
        let columns = moving + passive.iter().map(Vec::len).sum::<usize>();
        let goal = 1e-14 * length;
        let mut residual = (f64::INFINITY, f64::INFINITY);
        let mut last = f64::INFINITY;
        for _ in 0..30 {
            let mut matrix = DMatrix::zeros(6 * self.limbs().len(), columns);
            let mut closure = DVector::zeros(6 * self.limbs().len());
            let mut first = moving;
            residual = (0.0, 0.0);
            for (i, limb) in self.limbs().iter().enumerate() {
                let joints = &at.limbs[i];
                let (from, to) = (&at.platforms[limb.from], &at.platforms[limb.to]);
                let target = to * limb.platform_from_tip;
                let kinematics =
                    Kinematics::new(&limb.nominal, from, &joints.coordinates, &joints.commands);
                let tip = kinematics.tip_pose();
                let c = pose_residual(&target, &tip);
                residual = (
                    residual.0.max(c.linear().norm()),
                    residual.1.max(c.angular().norm()),
                );
                let arm = target.translation.vector - to.translation.vector;
                let lever = tip.translation.vector - from.translation.vector;
                for (platform, block) in [
                    (limb.to, -shift_matrix(&arm)),
                    (limb.from, shift_matrix(&lever)),
                ] {
                    if platform > 0 {
                        let mut view = matrix.fixed_view_mut::<6, 6>(6 * i, 6 * (platform - 1));
                        view += block;
                    }
                }
                let jacobian = kinematics.jacobian(limb.nominal.tip());
                for (k, &q) in passive[i].iter().enumerate() {
                    let mut view = matrix.fixed_view_mut::<6, 1>(6 * i, first + k);
                    view.copy_from(&jacobian.column(q));
                }
                first += passive[i].len();
                closure.fixed_rows_mut::<6>(6 * i).copy_from(&c.0);
            }
            // Lengths and angles: rotations count at the natural length, in rows and in columns.
            for i in 0..6 * self.limbs().len() {
                if i % 6 >= 3 {
                    matrix.row_mut(i).scale_mut(length);
                    closure[i] *= length;
                }
            }
            let size = closure.norm();
            if size <= goal || (size <= 100.0 * goal && size > 0.5 * last) {
                return Ok(at);
            }
            if !size.is_finite() {
                break;
            }
            last = size;
            let mut first = moving;
            let mut scales = vec![1.0; columns];
            for (j, scale) in scales.iter_mut().enumerate().take(moving) {
                *scale = if j % 6 < 3 { length } else { 1.0 };
            }
            for (limb, own) in self.limbs().iter().zip(&passive) {
                for (k, &q) in own.iter().enumerate() {
                    if limb.nominal.coordinates[q].kind == MotionKind::Prismatic {
                        scales[first + k] = length;
                    }
                }
                first += own.len();
            }
            for (j, scale) in scales.iter().enumerate() {
                matrix.column_mut(j).scale_mut(*scale);
            }
            let step = shortest(&matrix, &closure);
            // Angles, or lengths by the natural one.
            let most = step.amax();
            let share = if most > 0.5 { 0.5 / most } else { 1.0 };
            let by = |j: usize| share * step[j] * scales[j];
            for p in 1..self.platforms().len() {
                let twist = Twist(Vector6::from_fn(|k, _| by(6 * (p - 1) + k)));
                at.platforms[p] = moved(&at.platforms[p], &twist);
            }
            let mut first = moving;
            for (joints, own) in at.limbs.iter_mut().zip(&passive) {
                for (k, &q) in own.iter().enumerate() {
                    joints.coordinates[q] += by(first + k);
                }
                first += own.len();
            }
        }
        Err(residual)
    }
}
