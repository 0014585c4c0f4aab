//! The joint values of an arm as such: which pose of the tool they give, and which ones give a pose.
//!
//! Takes a machine of six turning joints in one chain; gives poses and joint values of the geometry that its controller believes in,
//! without deflections.

use kinetostat::{Mechanism, Pose};

use crate::free_turn::serial::SerialArm;
use crate::joints::Arm;
use crate::result::joints::ArmConfiguration;

/// Longest step of the way from one pose to another, m.
const STEP: f64 = 0.02;

/// And the largest turn on it, rad.
const TURN: f64 = 0.05;

/// Maximum number of steps of a way.
const MOST_STEPS: f64 = 1e4;

/// An arm of six turning joints in one chain.
///
/// ```
/// use kinetostat_machining::ArmJoints;
/// use kinetostat_model::Model;
///
/// let model = Model::preset("heavy_6r")?;
/// let arm = ArmJoints::of(&model.mechanism).ok_or("not an arm of six turning joints")?;
/// let joints = [0.1, -0.2, 0.5, 0.3, 1.2, -0.4]; // rad
/// let tool = arm.tool_at(&joints);
/// // The joint values next to others that give a pose: those of the same configuration.
/// let found = arm.next_to(&tool, &[0.0, -0.3, 0.6, 0.0, 1.3, 0.0]).ok_or("not reached")?;
/// assert!(found.iter().zip(joints).all(|(a, b)| (a - b).abs() < 1e-9));
/// // A machine of other joints is none.
/// assert!(ArmJoints::of(&Model::preset("orthoglide")?.mechanism).is_none());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct ArmJoints {
    arm: SerialArm,
    /// Closed form of the wrist; `None` if the last three axes do not meet in one point.
    wrist: Option<Arm>,
}

impl ArmJoints {
    /// The joints of a machine with its tool; `None` if it has other joints than six that turn in one chain.
    #[must_use]
    pub fn of(mechanism: &Mechanism) -> Option<Self> {
        SerialArm::of(mechanism).map(|arm| Self {
            arm,
            wrist: Arm::of(mechanism),
        })
    }

    /// The configuration at joint values, rad; `None` for an arm whose last three axes do not meet in one point.
    ///
    /// ```
    /// use kinetostat_machining::{ArmJoints, Wrist};
    /// use kinetostat_model::Model;
    ///
    /// let model = Model::preset("heavy_6r")?;
    /// let arm = ArmJoints::of(&model.mechanism).ok_or("not an arm of six turning joints")?;
    /// let bent_down = arm.configuration_by_joints(&[0.0, -0.3, 0.6, 0.0, 1.3, 0.0]).ok_or("no wrist in one point")?;
    /// let bent_up = arm.configuration_by_joints(&[0.0, -0.3, 0.6, 0.0, -1.3, 0.0]).ok_or("no wrist in one point")?;
    /// assert_eq!((bent_down.wrist, bent_up.wrist), (Wrist::NoFlip, Wrist::Flip));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn configuration_by_joints(&self, joints: &[f64; 6]) -> Option<ArmConfiguration> {
        self.wrist.as_ref()?.configuration(joints)
    }

    /// Pose of the tool, base from tool, m, at joint values in rad.
    #[must_use]
    pub fn tool_at(&self, joints: &[f64; 6]) -> Pose {
        self.arm.tool(joints)
    }

    /// The joint values, rad, that bring the tool to a pose (base from tool, m) on the straight way from where it is at others: no
    /// other turn and no other configuration; `None` if that way is singular or leaves the reach.
    #[must_use]
    pub fn next_to(&self, tool: &Pose, near: &[f64; 6]) -> Option<[f64; 6]> {
        let from = self.arm.tool(near);
        let way = tool.translation.vector - from.translation.vector;
        let turn = (from.rotation.inverse() * tool.rotation).scaled_axis();
        let steps = (way.norm() / STEP).max(turn.norm() / TURN).ceil().max(1.0);
        if steps.is_nan() || steps > MOST_STEPS {
            return None;
        }
        let mut joints = *near;
        for step in 1..=steps as usize {
            let share = step as f64 / steps;
            let pose = match share < 1.0 {
                true => Pose::from_parts(
                    (from.translation.vector + way * share).into(),
                    from.rotation * nalgebra::UnitQuaternion::from_scaled_axis(turn * share),
                ),
                false => *tool,
            };
            joints = self.arm.near(&pose, &joints)?;
        }
        Some(joints)
    }
}
