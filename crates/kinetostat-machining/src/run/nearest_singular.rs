//! Place of a program nearest to a singular posture.

use kinetostat::Posture;

use crate::checks::few_places::every;
use crate::measured_frame::PartPlace;
use crate::near::{natural_length, near_singular};
use crate::postures::orientation::Orientation;
use crate::result::point::PointResult;
use crate::result::run_result::NearSingularPlace;
use crate::task::Task;

/// The place nearest to a singular posture: ends of moves and places between them, evenly spread.
/// Places are compared by the tool's motion, rotations at the natural length.
pub(crate) fn nearest_singular(
    task: &Task<'_>,
    points: &[PointResult],
) -> Option<NearSingularPlace> {
    let length_mm = 1e3 * natural_length(task.mechanism);
    let orientation = Orientation {
        follows: task.placement.orientation_follows,
        load_turns: false,
    };
    let mut last: Option<Posture> = None;
    let mut found: Option<(f64, NearSingularPlace)> = None;
    for point in points.iter().step_by(every(task, points.len())) {
        let pose = PartPlace::of_point(task, point).pose();
        let mechanism = task.mechanism_on(point.line);
        let near = last
            .as_ref()
            .filter(|near| std::ptr::eq(near.mechanism(), mechanism));
        let posture = orientation.posture(mechanism, &pose, near);
        let Ok(posture) = posture else { continue };
        if let Some(near) = near_singular(&posture) {
            let far = near
                .distance_mm
                .max(near.rotation_deg.to_radians() * length_mm);
            if found.as_ref().is_none_or(|(least, _)| far < *least) {
                found = Some((
                    far,
                    NearSingularPlace {
                        line: point.line,
                        position_mm: point.position_mm,
                        posture: near,
                    },
                ));
            }
        }
        last = Some(posture);
    }
    found.map(|(_, place)| place)
}
