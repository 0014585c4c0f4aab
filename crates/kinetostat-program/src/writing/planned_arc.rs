//! An arc to be written by a language that states its centre: [`crate::PlannedPiece::arc`].

use nalgebra::Vector3;

use crate::path::curve::Arc;
use crate::writing::output_state::FittedArc;

/// An arc about an axis of the path's own arc, whose distance from the axis stays and which rises evenly, before rounding.
///
/// ```
/// use kinetostat_program::*;
/// use nalgebra::Vector3;
///
/// let program = Program::read("G21 G90 G17\nG0 X10 Y0 Z0\nG3 X0 Y10 I-10 J0 F600\nM2\n")?;
/// let path = interpret(&program, &ReadOptions::default())?;
/// // The part is made 0.2 % larger and lies 0.1 mm higher.
/// let field = |request: &Request| Ok(request.position_mm * 2e-3 + Vector3::z() * 0.1);
/// let writing = WriteOptions::default();
/// let circles = [Circles::Straight, Circles::AboutAxis];
/// let plan = Plan::with_circles(&path, &field, (&writing, &circles), &Unwatched)?;
/// let piece = &plan.moves()[1].pieces.iter().find(|piece| piece.arc.is_some()).unwrap();
/// let arc = piece.arc.unwrap();
/// assert!((arc.angle_rad - std::f64::consts::FRAC_PI_2).abs() < 1e-6);
/// assert!((arc.length_mm(&piece.position_mm, &piece.position_mm) - 15.7394).abs() < 1e-3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlannedArc {
    /// A place of its axis, part frame, mm.
    pub centre_mm: Vector3<f64>,
    /// Direction of its axis, of length 1.
    pub axis: Vector3<f64>,
    /// Radius, mm.
    pub radius_mm: f64,
    /// Angle from its start to its end about the axis, right-handed, rad.
    pub angle_rad: f64,
}

impl PlannedArc {
    pub(crate) fn new(of: &Arc, fitted: &FittedArc) -> Self {
        let [first, second] = fitted.centre_mm;
        Self {
            centre_mm: of.first * first + of.second * second,
            axis: of.axis,
            radius_mm: fitted.radius_mm,
            angle_rad: fitted.sweep_rad,
        }
    }

    /// Length between two ends, mm: only their heights along the axis matter.
    #[must_use]
    pub fn length_mm(&self, from: &Vector3<f64>, to: &Vector3<f64>) -> f64 {
        (self.radius_mm * self.angle_rad).hypot((to - from).dot(&self.axis))
    }
}
