//! Arcs about a stated centre.

use kinetostat_program::Arc;
use nalgebra::Vector3;

/// The arc from `start` to `end` about a centre and an axis by an angle in rad, right-handed; the rise is even.
pub(crate) fn about(
    start: &Vector3<f64>,
    end: &Vector3<f64>,
    centre: &Vector3<f64>,
    axis: &Vector3<f64>,
    angle_rad: f64,
) -> Option<Arc> {
    let across = |place: &Vector3<f64>| {
        let arm = place - centre;
        arm - axis * arm.dot(axis)
    };
    let (arm, last) = (across(start), across(end));
    let first = arm.try_normalize(1e-9)?;
    Some(Arc {
        centre: start - arm,
        first,
        second: axis.cross(&first),
        axis: *axis,
        start_angle: 0.0,
        sweep: angle_rad,
        start_radius: arm.norm(),
        end_radius: last.norm(),
        rise: (end - start).dot(axis),
    })
}
