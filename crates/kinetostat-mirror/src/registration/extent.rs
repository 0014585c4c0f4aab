//! Check that measured points are about as large as the path.

use kinetostat_program::NominalPath;
use nalgebra::Vector3;

use crate::error::MirrorError;
use crate::points::MeasuredPoints;

/// Points that span less of the extent of the path than this, or so many times more, are laid onto something else.
const SMALLEST: f64 = 0.05;
/// Places of the path that say how large it is.
const PLACES: usize = 1000;

/// Refuses to register points of another size: a cloud in a wrong unit lies well on a piece of one line. Points in the frame of
/// the program may be of a small piece of it, but not within the smoothing length, `within_mm`: there they are of one place.
///
/// # Errors
/// Points that span less than a twentieth of the path, or more than twenty times as much.
pub(crate) fn of_the_same_size(
    nominal: &NominalPath<'_>,
    measured: &MeasuredPoints,
    within_mm: Option<f64>,
) -> Result<(), MirrorError> {
    let along = |k: usize| nominal.length_mm() * k as f64 / PLACES as f64;
    let path_mm = diagonal((0..=PLACES).map(|k| nominal.point_at(along(k))));
    let points_mm = diagonal(measured.points().iter().map(|point| point.position_mm));
    let share = points_mm / path_mm;
    let is_of_a_piece = within_mm.is_some_and(|within_mm| points_mm >= within_mm);
    if (SMALLEST..=1.0 / SMALLEST).contains(&share) || is_of_a_piece {
        return Ok(());
    }
    Err(MirrorError::new(format!(
        "the measured points span {points_mm:.3} mm and the path {path_mm:.3} mm: they fit a small piece of it in many places, or none. Check the unit of their columns (inches or metres taken for millimetres), measure more of the path, or give points of one feature in the frame of the program, do not register them, and smooth over less than they span"
    )))
}

/// Diagonal of the box around points, mm.
fn diagonal(points: impl Iterator<Item = Vector3<f64>>) -> f64 {
    let around = |corners: Option<[Vector3<f64>; 2]>, point: Vector3<f64>| {
        let [low, high] = corners.unwrap_or([point, point]);
        Some([low.inf(&point), high.sup(&point)])
    };
    let corners = points.fold(None, around);
    corners.map_or(0.0, |[low, high]| (high - low).norm())
}
