//! Poses that were measured on a machine, and their differences from computed ones.

use kinetostat::{Pose, spatial::pose_residual};
use nalgebra::{UnitQuaternion, Vector3};

/// A pose that was measured: joints as the controller shows them (m, rad) and the tool's place.
#[derive(Clone, Debug)]
pub struct MeasuredPose {
    /// Joints as the controller shows them, m or rad.
    pub joints: Vec<f64>,
    /// Position of the tool in the base, m.
    pub position: Vector3<f64>,
    /// Orientation of the tool in the base, where one was measured.
    pub rotation: Option<UnitQuaternion<f64>>,
}

/// A difference of two poses, m and rad.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Difference {
    /// Distance of the positions, m.
    pub distance: f64,
    /// Angle between the orientations, rad; `None` where no orientation was measured.
    pub angle: Option<f64>,
}

/// Tolerance for equal poses, m and rad.
#[derive(Clone, Copy, Debug)]
pub struct Tolerance {
    /// Largest distance of the positions, m.
    pub distance: f64,
    /// Largest angle between the orientations, rad.
    pub angle: f64,
}

impl Tolerance {
    /// The larger of both differences, 1 at the tolerance.
    pub(crate) fn share(&self, difference: &Difference) -> f64 {
        let angle = difference.angle.unwrap_or(0.0) / self.angle;
        (difference.distance / self.distance).max(angle)
    }
}

/// Distance (m) and angle (rad) from a measured pose to a computed one; no angle where no orientation was measured.
#[must_use]
pub fn difference(measured: &MeasuredPose, computed: &Pose) -> Difference {
    let target = Pose::from_parts(
        measured.position.into(),
        measured.rotation.unwrap_or(computed.rotation),
    );
    let residual = pose_residual(&target, computed);
    Difference {
        distance: residual.linear().norm(),
        angle: measured.rotation.map(|_| residual.angular().norm()),
    }
}
