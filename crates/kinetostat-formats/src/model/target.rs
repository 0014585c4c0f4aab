//! Targets of motions.

use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};

/// Arm configuration of a pose, as written.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Configuration {
    /// The text: `[0,-1,-1,0]`, `S 2,T 35`, `N U T, 0, 0, 0`; empty where nothing is stated.
    pub text: String,
    /// Numbers of the configuration in their order.
    pub numbers: Vec<f64>,
}

/// A pose of the tool in the axes of the work object.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PoseTarget {
    /// Place of the tool centre point in mm.
    pub position_mm: Vector3<f64>,
    /// Turns the work object's axes into the tool's.
    pub orientation: UnitQuaternion<f64>,
    /// Arm configuration.
    pub configuration: Configuration,
    /// External axes as written, mm or degrees; none where an axis is not stated (RAPID's 9E9).
    pub external: Vec<Option<f64>>,
}

impl PoseTarget {
    /// Place and orientation as one.
    ///
    /// ```
    /// use kinetostat_formats::{Configuration, PoseTarget};
    /// use nalgebra::{UnitQuaternion, Vector3};
    ///
    /// let target = PoseTarget {
    ///     position_mm: Vector3::new(1.0, 2.0, 3.0),
    ///     orientation: UnitQuaternion::identity(),
    ///     configuration: Configuration::default(),
    ///     external: Vec::new(),
    /// };
    /// assert_eq!(target.isometry().translation.vector.z, 3.0);
    /// ```
    #[must_use]
    pub fn isometry(&self) -> Isometry3<f64> {
        Isometry3::from_parts(Translation3::from(self.position_mm), self.orientation)
    }
}

/// Target of a motion.
#[derive(Debug, Clone, PartialEq)]
pub enum Target {
    /// A pose of the tool.
    Pose(PoseTarget),
    /// Values of the robot's joints as written: degrees, or mm of linear ones.
    Joints {
        /// In the order of the joints.
        values_deg: Vec<f64>,
    },
    /// Not known from the text: only with [`crate::UnknownTargets::LeftAsWritten`].
    Unknown {
        /// Reason in words.
        reason: String,
    },
}

impl Target {
    /// The pose, where it is one.
    ///
    /// ```
    /// use kinetostat_formats::Target;
    ///
    /// assert_eq!(Target::Joints { values_deg: vec![0.0; 6] }.pose(), None);
    /// ```
    #[must_use]
    pub fn pose(&self) -> Option<&PoseTarget> {
        match self {
            Self::Pose(pose) => Some(pose),
            _ => None,
        }
    }
}
