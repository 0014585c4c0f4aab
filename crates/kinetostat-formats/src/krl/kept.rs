//! Coordinates of an end that are taken over from the previous pose.

use nalgebra::{UnitQuaternion, Vector3};

use crate::krl::position::angles_of;
use crate::model::orientation::OrientationText;
use crate::model::target::PoseTarget;

/// A, B and C of an orientation as a controller says them: B no farther than 90 degrees.
pub(crate) fn kept_angles(orientation: &UnitQuaternion<f64>) -> [f64; 3] {
    let [a, b, c] = angles_of(orientation);
    let other = |angle: f64| match angle > 0.0 {
        true => angle - 180.0,
        false => angle + 180.0,
    };
    let angles = match b.abs() > 90.0 {
        true => [other(a), 180.0_f64.copysign(b) - b, other(c)],
        false => [a, b, c],
    };
    // Half a turn is 180 degrees, also where the last bit says -180.
    angles.map(|angle| match angle < HALF_TURN_DEG {
        true => angle + 360.0,
        false => angle,
    })
}

/// Half a turn backward, with the last bits that a rotation loses, degrees.
const HALF_TURN_DEG: f64 = 1e-9 - 180.0;

/// Tolerance of B about 90 degrees: from there on, omitted angles may differ from those that were written.
const NEAR_BEYOND_DEG: f64 = 1e-6;

/// True if the controller may express the same orientation with another A and C at this B.
pub(crate) fn is_beyond(b: f64) -> bool {
    b.is_nan() || b.abs() > 90.0 - NEAR_BEYOND_DEG
}

/// Fills in what a position leaves open from the pose of before; none where that is not certain.
pub(crate) fn completed(
    open: &[Option<f64>; 6],
    before: &PoseTarget,
    is_beyond: bool,
) -> Option<(Vector3<f64>, UnitQuaternion<f64>)> {
    let place = [0, 1, 2].map(|axis| open[axis].unwrap_or(before.position_mm[axis]));
    let turn = match (open[3], open[4], open[5]) {
        (None, None, None) => before.orientation,
        (Some(a), Some(b), Some(c)) => OrientationText::Abc.rotation_of(&[a, b, c])?,
        _ if is_beyond => return None,
        (a, b, c) => {
            let kept = kept_angles(&before.orientation);
            let angles = [0, 1, 2].map(|index| [a, b, c][index].unwrap_or(kept[index]));
            OrientationText::Abc.rotation_of(&angles)?
        }
    };
    Some((Vector3::from(place), turn))
}
