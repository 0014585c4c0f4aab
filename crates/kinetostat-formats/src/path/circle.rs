//! The circle through three points.

use kinetostat_program::Arc;
use nalgebra::Vector3;

/// Sine of the angle at a point between the two others below which the three lie on a line.
const STRAIGHT: f64 = 1e-7;

/// The arc from `start` through `via` to `end`, in mm; `None` where the three lie on a line or two of them at one place.
pub(crate) fn through(start: &Vector3<f64>, via: &Vector3<f64>, end: &Vector3<f64>) -> Option<Arc> {
    let (a, b) = (via - start, end - start);
    let normal = a.cross(&b);
    let size = a.norm() * b.norm();
    if size == 0.0 || (end - via).norm() == 0.0 || normal.norm() <= STRAIGHT * size {
        return None;
    }
    // The centre has the same distance from all three.
    let to_centre = (b * a.norm_squared() - a * b.norm_squared()).cross(&normal)
        * (0.5 / normal.norm_squared());
    let centre = start + to_centre;
    let axis = normal.normalize();
    let first = (start - centre).normalize();
    let second = axis.cross(&first);
    let angle = |point: &Vector3<f64>| {
        let from_centre = point - centre;
        let angle = from_centre.dot(&second).atan2(from_centre.dot(&first));
        angle.rem_euclid(std::f64::consts::TAU)
    };
    // About this axis the way from start over via to end is the positive one.
    Some(Arc {
        centre,
        first,
        second,
        axis,
        start_angle: 0.0,
        sweep: angle(end),
        start_radius: (start - centre).norm(),
        end_radius: (end - centre).norm(),
        rise: 0.0,
    })
}
