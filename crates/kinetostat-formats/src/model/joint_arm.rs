//! The arm whose joint values a table states.

use std::fmt::Debug;
use std::sync::Arc;

use nalgebra::Isometry3;

/// Kinematic model of an arm: tool pose of joint values, and the inverse.
///
/// Joint values are in degrees, or mm of linear joints, in the order of the joints; poses are those of the tool in axes of the robot's
/// base, mm.
pub trait JointArm: Debug + Send + Sync {
    /// Number of joints.
    fn joint_count(&self) -> usize;

    /// The pose of the tool at as many joint values.
    fn tool_pose(&self, joints: &[f64]) -> Isometry3<f64>;

    /// The joint values next to others that give a pose; none where there are none.
    fn joints_near(&self, tool: &Isometry3<f64>, near: &[f64]) -> Option<Vec<f64>>;
}

/// Interpolation by the controller from one row of a table of joint values to the next.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BetweenRows {
    /// All joints in step: rows must stand so near to each other that the tool goes all but straight.
    Joint,
    /// The tool on a straight line.
    Linear,
}

/// The arm of a table of joint values, and how it moves between its rows.
///
/// ```
/// use std::sync::Arc;
/// use kinetostat_formats::*;
/// use nalgebra::{Isometry3, Vector3};
///
/// /// Two slides, x and y, that carry the tool.
/// #[derive(Debug)]
/// struct Slides;
/// impl JointArm for Slides {
///     fn joint_count(&self) -> usize {
///         2
///     }
///     fn tool_pose(&self, joints: &[f64]) -> Isometry3<f64> {
///         Isometry3::translation(joints[0], joints[1], 0.0)
///     }
///     fn joints_near(&self, tool: &Isometry3<f64>, _near: &[f64]) -> Option<Vec<f64>> {
///         Some(vec![tool.translation.x, tool.translation.y])
///     }
/// }
///
/// let text = "joint_1_mm,joint_2_mm,note\n0,0,begin\n50,7.5,cut\n";
/// let mut options = ReadOptions::default();
/// options.arm = Some(TableArm { arm: Arc::new(Slides), between: BetweenRows::Linear });
/// let program = read_poses(vec![SourceFile::new("q.csv", text)], &options).unwrap();
/// assert_eq!(program.motions[1].target.pose().unwrap().position_mm.y, 7.5);
/// // What is written are joint values again.
/// let piece = Piece::to(1, Vector3::new(50.0, 7.6, 0.0));
/// let files = write(&program, &[piece], &WriteOptions::default()).unwrap();
/// assert_eq!(files[0].1, text.replace("7.5", "7.600000").as_bytes());
/// ```
#[derive(Debug, Clone)]
#[allow(
    clippy::exhaustive_structs,
    reason = "an arm, and what is between rows"
)]
pub struct TableArm {
    /// The arm.
    pub arm: Arc<dyn JointArm>,
    /// Interpolation between rows.
    pub between: BetweenRows,
}

impl PartialEq for TableArm {
    /// Identity of the arm: models of equal build are different.
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.arm, &other.arm) && self.between == other.between
    }
}
