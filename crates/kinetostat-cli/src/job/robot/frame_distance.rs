//! How far two frames are apart.

use nalgebra::Isometry3;

/// How far one frame is from another, mm, and by how much it is turned from it, rad.
pub(crate) fn distance(one: &Isometry3<f64>, other: &Isometry3<f64>) -> [f64; 2] {
    [
        (one.translation.vector - other.translation.vector).norm(),
        one.rotation.angle_to(&other.rotation),
    ]
}
