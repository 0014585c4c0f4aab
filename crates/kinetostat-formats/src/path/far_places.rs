//! Places that no machine reaches: a wrong unit, or a number that was mistyped.

use crate::model::motion::{Motion, MotionKind};

/// Coordinates beyond this are no machine's, as in G-code, mm.
const FARTHEST_MM: f64 = 1e6;

/// Reason and remedy of a motion to an implausibly distant point; `None` if it is near enough.
pub(crate) fn too_far(motion: &Motion) -> Option<(String, &'static str)> {
    let value = farthest_mm(motion).filter(|value| value.is_nan() || value.abs() > FARTHEST_MM)?;
    Some((
        format!("it leads to a coordinate of {value:e} mm, farther than any machine reaches"),
        "check the number and the unit of lengths",
    ))
}

/// The largest coordinate of the poses of a motion, mm; one that is no number where there is one.
fn farthest_mm(motion: &Motion) -> Option<f64> {
    let via = match &motion.kind {
        MotionKind::Circular { via } => via.pose(),
        _ => None,
    };
    let places = [motion.target.pose(), via].into_iter().flatten();
    let mut values = places.flat_map(|pose| pose.position_mm.iter().copied());
    let first = values.next()?;
    Some(values.fold(first, |most, value| {
        match value.abs() > most.abs() || value.is_nan() {
            true => value,
            false => most,
        }
    }))
}
