//! How far the machine's own weight, and what else acts in its model, put the tool off without a load on
//! it: the part of a correction that has nothing to do with cutting.
//!
//! It has a limit of its own. Heavy arms sag by millimetres, as they should; a cutting force that moves the tool
//! that far is a wrong unit. And whoever touched the part off with the machine itself, or has a controller
//! that knows the weight, must not correct it twice.

use kinetostat::{Mechanism, Wrench};
use nalgebra::Vector3;

use crate::checks::few_places::every;
use crate::postures::neighbour::in_chunks;
use crate::postures::orientation::Orientation;
use crate::result::point::PointResult;
use crate::task::Task;

/// Displacement of the tool at points by what acts without a load on it, program axes, mm: the difference
/// between the machine and the same machine without weight and loads, so that errors of its geometry do not
/// count. None where there is no answer.
pub(crate) fn by_own_loads(task: &Task<'_>, points: &[&PointResult]) -> Vec<Option<Vector3<f64>>> {
    let machine = |p: &PointResult| task.mechanism_on(p.line);
    let of_one_machine = points.chunk_by(|a, b| std::ptr::eq(machine(a), machine(b)));
    of_one_machine
        .flat_map(|run| shifts(task, machine(run[0]), run))
        .collect()
}

fn shifts(
    task: &Task<'_>,
    mechanism: &Mechanism,
    points: &[&PointResult],
) -> Vec<Option<Vector3<f64>>> {
    if !mechanism.has_own_loads() {
        return vec![Some(Vector3::zeros()); points.len()];
    }
    let bare = mechanism.without_own_loads();
    let orientation = Orientation {
        follows: task.placement.orientation_follows,
        load_turns: false,
    };
    in_chunks(points, |[own, without], points| {
        let shift = |point: &&PointResult| {
            let pose = point.wanted_pose(&task.placement);
            let none = Wrench::zero();
            let (_, sagged) = own.rest(mechanism, &pose, &none, orientation).ok()?;
            let (_, straight) = without.rest(&bare, &pose, &none, orientation).ok()?;
            let off = sagged.translation.vector - straight.translation.vector;
            Some(point.placement(&task.placement).to_program(&off))
        };
        points.iter().map(shift).collect()
    })
    .collect()
}

/// How far own weight and loads of the model put the tool off by themselves, mm, the largest of
/// [`RunResult::MAX_POSTURES`](crate::RunResult::MAX_POSTURES) places.
pub(crate) fn largest_by_own_weight(task: &Task<'_>, points: &[&PointResult]) -> Option<f64> {
    let mut machines = points.iter().map(|p| task.mechanism_on(p.line));
    if !machines.any(Mechanism::has_own_loads) {
        return None;
    }
    let some = points.iter().step_by(every(task, points.len()));
    let some: Vec<&PointResult> = some.copied().collect();
    let own = by_own_loads(task, &some);
    let sizes = own.into_iter().flatten().map(|shift| shift.norm());
    sizes.max_by(f64::total_cmp)
}
