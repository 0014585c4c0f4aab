//! Distance between two frames.

use nalgebra::Isometry3;

/// Returns the distance of two frames, mm, and the angle between them, rad.
pub(crate) fn distance(one: &Isometry3<f64>, other: &Isometry3<f64>) -> [f64; 2] {
    [
        (one.translation.vector - other.translation.vector).norm(),
        one.rotation.angle_to(&other.rotation),
    ]
}
