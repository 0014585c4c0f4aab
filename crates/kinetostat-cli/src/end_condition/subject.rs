//! Interface to a chain or a machine for the answers of `curve` and `equilibria`.

use kinetostat::{MotionKind, continuation::CurveEquilibrium};
use nalgebra::Vector3;

use crate::end_condition::coordinates::CoordinateName;
use crate::machine::units::unit_of;
use crate::ui::numbers::fixed;

/// A chain or a machine, commanded for a place.
pub(crate) trait Subject {
    type Equilibrium: CurveEquilibrium;

    /// Names of all coordinates, for people and for tables.
    fn coordinates(&self) -> Vec<CoordinateName>;
    /// Values of all coordinates in their units; of a drive the joint's whole position, command included.
    fn values(&self, e: &Self::Equilibrium) -> Vec<f64>;
    /// The line through all joints, m.
    fn outline(&self, e: &Self::Equilibrium) -> Vec<Vector3<f64>>;
    /// A motion (m, rad) in words: of the coordinates of a chain, of the tool of a machine.
    fn motion_description(&self, motion: &[f64]) -> String;
}

/// A motion in words: the parts that move most, each by how much while the largest turns by one degree (or slides by one
/// millimetre, where nothing turns). `length`: natural length, m.
pub(crate) fn motion_description(
    parts: &[(String, MotionKind)],
    motion: &[f64],
    length: f64,
) -> String {
    if motion.is_empty() {
        return String::new();
    }
    let largest = |kind: MotionKind| {
        parts
            .iter()
            .zip(motion)
            .filter(|(part, _)| part.1 == kind)
            .map(|(part, m)| m.abs() * unit_of(part.1))
            .fold(0.0, kinetostat::number::larger)
    };
    let (turns, slides) = (
        largest(MotionKind::Revolute),
        largest(MotionKind::Prismatic),
    );
    // Radians against the natural length decide which kind leads.
    let length = 1e3 * length;
    let unit = if turns.to_radians() * length >= slides {
        turns
    } else {
        slides
    };
    if unit <= 0.0 {
        return "nothing moves".into();
    }
    let mut moved: Vec<(f64, String)> = parts
        .iter()
        .zip(motion)
        .filter_map(|((name, kind), m)| {
            let by = m * unit_of(*kind) / unit;
            let (size, word) = match kind {
                MotionKind::Revolute => (by.abs().to_radians() * length, "deg"),
                MotionKind::Prismatic => (by.abs(), "mm"),
            };
            let shown = fixed(by, 3);
            let something = shown.bytes().any(|b| (b'1'..=b'9').contains(&b));
            something.then(|| (size, format!("{name} by {shown} {word}")))
        })
        .collect();
    moved.sort_by(|a, b| b.0.total_cmp(&a.0));
    let most = moved.first().map_or(0.0, |p| p.0);
    moved.retain(|p| p.0 > 0.02 * most);
    let more = moved.len().saturating_sub(6);
    let mut text: Vec<String> = moved.into_iter().take(6).map(|p| p.1).collect();
    if more > 0 {
        text.push(format!("{more} more by less"));
    }
    text.join(", ")
}
