//! Sentences of the errors that need more than their fields.

use super::load_limit::LoadLimit;
use super::place::Place;
use crate::number;
use crate::spatial::{MotionKind, Pose};

/// Joint values in the unit that people read; the unit comes once, at the end.
pub(super) fn joint_values<const N: usize>(kind: MotionKind, values: [f64; N]) -> String {
    let (factor, unit) = match kind {
        MotionKind::Prismatic => (1e3, "mm"),
        MotionKind::Revolute => (1_f64.to_degrees(), "deg"),
    };
    let number = |value: &f64| {
        let text = number::fixed(value * factor, 4);
        number::without_zeros(&text).to_owned()
    };
    let numbers: Vec<String> = values.iter().map(number).collect();
    format!("{} {unit}", numbers.join(" .. "))
}

/// Error without an equilibrium: beyond a limit point there is none on the branch, else it tells how far the iteration
/// came.
pub(super) fn not_converged(
    place: &Place,
    iterations: usize,
    [closure, torque]: [f64; 2],
    share: f64,
    limit: Option<&LoadLimit>,
) -> String {
    match limit {
        Some(limit) => {
            // Rounded before it is printed, so that there is no minus zero.
            let d = limit
                .displacement
                .linear()
                .map(|x| (x * 1e7).round() * 1e-4 + 0.0);
            let share = number::setting(limit.share);
            format!(
                "{place}: from rest it carries only {share} of this load: a limit point of the load lies at the displacement [{:.4} {:.4} {:.4}] mm, and there it snaps to another equilibrium",
                d.x, d.y, d.z
            )
        }
        None if !(closure.is_finite() && torque.is_finite()) => format!(
            "{place}: no equilibrium found in {iterations} iterations: with these numbers the deflections grow beyond all limits; the largest share of the load with an equilibrium is {share:.3}. Look for a load, a length or a stiffness in the wrong unit"
        ),
        None if share > 0.999 => format!(
            "{place}: equilibria were found up to the whole load, and still the iteration did not converge in {iterations} steps: a limit of the load is near, or the correction is too large"
        ),
        None => format!(
            "{place}: no equilibrium found in {iterations} iterations (the largest share of the load with an equilibrium: {share:.3}; the last try left a closure of {} m, and torques of {} times the largest out of equilibrium)",
            // A smaller residual is the rounding of its arithmetic.
            number::short(if closure < 1e-12 { 0.0 } else { closure }),
            number::short(torque)
        ),
    }
}

pub(super) fn nearest_found(distance_m: f64, angle_rad: f64, nearest: &Pose) -> String {
    if !(distance_m.is_finite() && angle_rad.is_finite()) {
        return "no pose near it was found: look for a length in the wrong unit".to_owned();
    }
    let [x, y, z]: [f64; 3] = (nearest.translation.vector * 1e3).into();
    let shown = |x: f64| number::fixed(x, 3);
    format!(
        "the nearest pose found is {} away, at ({}, {}, {}) mm in base axes",
        number::apart(distance_m * 1e3, angle_rad.to_degrees()),
        shown(x),
        shown(y),
        shown(z)
    )
}
