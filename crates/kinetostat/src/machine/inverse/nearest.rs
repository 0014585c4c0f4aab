//! The nearest pose that a machine with fewer than six motions can take.

use nalgebra::{DMatrix, DVector, Vector6};

use crate::error::Error;
use crate::machine::inverse::graph::graph_nearest;
use crate::machine::inverse::limb::{blocked_motions, inverse_kinematics};
use crate::model::mechanism::Mechanism;
use crate::number::larger;
use crate::spatial::{Pose, Twist, moved, pose_residual, shift_matrix};

/// Steps until all limbs reach the same pose.
const STEPS: usize = 12;

impl Mechanism {
    /// The pose next to `target` that every limb can reach, if it lies within `limit` (m; rotations
    /// at the natural length) and `target` differs from it only along motions that the machine does not
    /// have; `target` itself where it can be reached.
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Vector3, vector};
    /// # use kinetostat::*;
    /// # let slide = |axis| ActuatorSpec::new(MotionKind::Prismatic, axis, 5e7); // N/m
    /// # let chain = Chain::builder("gantry")
    /// #     .actuator("x", slide(Vector3::x()))
    /// #     .actuator("y", slide(Vector3::y()))
    /// #     .link("column", &BeamSection::tube(2.1e11, 8.1e10, 0.2, 0.17), 0.4) // Pa, m
    /// #     .build()?;
    /// # let home = Pose::translation(0.4, 0.0, 0.0);
    /// # let gantry = Mechanism::serial(chain, home, Vector3::zeros())?;
    /// // Two slides at right angles leave the plane z = 0 no more than they turn.
    /// let wanted = Pose::new(vector![0.5, 0.2, 1e-3], vector![0.0, 2e-3, 0.0]); // m, rad
    /// let taken = gantry.nearest_reachable(&wanted, 5e-3).expect("less than 5 mm beside it");
    /// let reached = Pose::translation(0.5, 0.2, 0.0);
    /// assert!(spatial::pose_residual(&reached, &taken).0.norm() < 1e-9);
    /// assert!(gantry.nearest_reachable(&wanted, 1e-4).is_none());
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn nearest_reachable(&self, target: &Pose, limit: f64) -> Option<Pose> {
        let length = self.scale().length;
        let size = |t: &Twist| t.linear().norm().max(length * t.angular().norm());
        if self.platforms().len() > 2 {
            let found = graph_nearest(self, target)?;
            return (size(&pose_residual(&found, target)) <= limit).then_some(found);
        }
        let mut pose = *target;
        for _ in 0..STEPS {
            // Closure residual of every limb, and the motions that it cannot make: rows in the tool's twist.
            let mut rows = DMatrix::zeros(6 * self.limbs().len(), 6);
            let mut residuals = DVector::zeros(6 * self.limbs().len());
            let (mut all_reach, mut most) = (true, 0.0_f64);
            for (i, limb) in self.limbs().iter().enumerate() {
                let base = &self.platforms()[limb.from].home;
                let tip = pose * limb.platform_from_tip;
                let (joints, residual) = match inverse_kinematics(&limb.nominal, base, &tip, None) {
                    Ok(joints) => (joints, Twist::zero()),
                    Err(Error::Unreachable { nearest, .. }) => {
                        all_reach = false;
                        let joints = inverse_kinematics(&limb.nominal, base, &nearest, None);
                        (joints.ok()?, pose_residual(&nearest, &tip))
                    }
                    Err(_) => return None,
                };
                if size(&residual) > limit {
                    return None;
                }
                most = larger(most, size(&residual) / length);
                let own = limb.nominal.scale().length;
                let unit = |k: usize| if k < 3 { 1.0 } else { own };
                let blocked = blocked_motions(&limb.nominal, base, &joints);
                let arm = pose.rotation * limb.platform_from_tip.translation.vector;
                let by_tip = DMatrix::from_fn(6, 6, |a, b| blocked[(a, b)] * unit(b));
                let by_tool = by_tip * shift_matrix(&arm);
                let scaled = Vector6::from_fn(|k, _| residual.0[k] * unit(k));
                for a in 0..6 {
                    for b in 0..6 {
                        let turned = if b < 3 { 1.0 } else { 1.0 / length };
                        rows[(6 * i + a, b)] = by_tool[(a, b)] * turned;
                    }
                    residuals[6 * i + a] = scaled[a];
                }
            }
            if all_reach {
                let off = pose_residual(&pose, target);
                return (size(&off) <= limit).then_some(pose);
            }
            // Rows that repeat each other differ by as much as the pose is off.
            let own = crate::linalg::singular_values::SingularValues::of(&rows);
            let step = own.shortest(&residuals, own.largest() * (10.0 * most).max(1e-9));
            let step = Twist(Vector6::from_fn(|k, _| {
                if k < 3 { step[k] } else { step[k] / length }
            }));
            pose = moved(&pose, &step);
            if size(&pose_residual(&pose, target)) > 2.0 * limit {
                return None;
            }
        }
        None
    }

    /// Puts the tool's home at the nearest pose that the machine can take, if it lies within `limit`
    /// (see [`Self::nearest_reachable`]). The home as it was, if it was changed.
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Vector3, vector};
    /// # use kinetostat::*;
    /// # let slide = |axis| ActuatorSpec::new(MotionKind::Prismatic, axis, 5e7); // N/m
    /// # let chain = Chain::builder("gantry")
    /// #     .actuator("x", slide(Vector3::x()))
    /// #     .actuator("y", slide(Vector3::y()))
    /// #     .link("column", &BeamSection::tube(2.1e11, 8.1e10, 0.2, 0.17), 0.4) // Pa, m
    /// #     .build()?;
    /// # let home = Pose::translation(0.4, 0.1, 2e-4);
    /// # let mut gantry = Mechanism::serial(chain, home, Vector3::zeros())?;
    /// // Its drawing puts the tool 0.2 mm above the plane in which it moves.
    /// assert!(gantry.posture(&home).is_err());
    /// assert_eq!(gantry.move_home_within_reach(1e-3), Some(home));
    /// let moved = gantry.platforms()[gantry.tool()].home;
    /// assert!((moved.translation.vector - vector![0.4, 0.1, 0.0]).norm() < 1e-9);
    /// assert!(gantry.posture(&moved).is_ok());
    /// assert_eq!(gantry.move_home_within_reach(1e-3), None, "there is nothing more to do");
    /// # Ok::<(), Error>(())
    /// ```
    pub fn move_home_within_reach(&mut self, limit: f64) -> Option<Pose> {
        let home = self.platforms()[self.tool()].home;
        if self.posture(&home).is_ok() {
            return None;
        }
        let nearest = self.nearest_reachable(&home, limit)?;
        let tool = self.tool();
        self.parts_mut().platforms[tool].home = nearest;
        if self.posture(&nearest).is_err() {
            self.parts_mut().platforms[tool].home = home;
            return None;
        }
        Some(home)
    }
}
