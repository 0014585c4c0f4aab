//! Units in which joints are shown.

use kinetostat::MotionKind;

/// Unit in which a joint is shown, and m or rad in one of it.
pub(crate) fn unit(kind: MotionKind) -> (&'static str, f64) {
    match kind {
        MotionKind::Prismatic => ("mm", 1e-3),
        MotionKind::Revolute => ("deg", std::f64::consts::PI / 180.0),
    }
}

/// mm per m, or degrees per radian.
pub(crate) fn unit_of(kind: MotionKind) -> f64 {
    match kind {
        MotionKind::Revolute => 1_f64.to_degrees(),
        MotionKind::Prismatic => 1e3,
    }
}
