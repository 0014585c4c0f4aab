//! Evenly spread postures and wrenches that are the same in every run.

use std::ops::Range;

use kinetostat::Pose;
use nalgebra::{UnitQuaternion, Vector3};

/// Number `k` of item `i`, between -1 and 1: multiples of irrational numbers, one per `k`.
fn spread(i: usize, k: usize) -> f64 {
    // The powers of the root of x^13 = x + 1 fill a cube of twelve dimensions evenly.
    const STEP: f64 = 0.945_4;
    #[allow(clippy::cast_precision_loss, reason = "nobody counts to 2^52")]
    let at = (i + 1) as f64 * STEP.powi(i32::try_from(k + 1).unwrap_or(1));
    2.0 * at.fract() - 1.0
}

/// Commands of `joints` revolute actuators within `reach` (rad), one posture after the other.
#[must_use]
pub fn joints(items: Range<usize>, joints: usize, reach: f64) -> Vec<f64> {
    items
        .flat_map(|i| (0..joints).map(move |k| reach * spread(i, k)))
        .collect()
}

/// Poses around `centre` (m), moved by up to `reach` (m) and turned by up to `turn` (rad) along and
/// about each axis.
#[must_use]
pub fn poses(items: Range<usize>, centre: [f64; 3], reach: f64, turn: f64) -> Vec<Pose> {
    let vector =
        |i: usize, k: usize| Vector3::new(spread(i, k), spread(i, k + 1), spread(i, k + 2));
    let pose = |i| {
        let place = Vector3::from(centre) + vector(i, 0) * reach;
        Pose::from_parts(
            place.into(),
            UnitQuaternion::from_scaled_axis(vector(i, 3) * turn),
        )
    };
    items.map(pose).collect()
}

/// Dead wrenches of the given force (N) and moment (N m), six numbers each.
#[must_use]
pub fn wrenches(items: Range<usize>, force: f64, moment: f64) -> Vec<f64> {
    let direction = |i: usize, k: usize| {
        Vector3::new(spread(i, k), spread(i, k + 1), spread(i, k + 2)).normalize()
    };
    let both = |i| {
        let (f, m) = (direction(i, 6) * force, direction(i, 9) * moment);
        [f.x, f.y, f.z, m.x, m.y, m.z]
    };
    items.flat_map(both).collect()
}
