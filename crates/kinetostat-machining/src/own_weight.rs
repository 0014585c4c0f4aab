//! How far the machine's own weight, and what else acts in its model, put the tool off without a load on
//! it: the part of a correction that has nothing to do with cutting.
//!
//! It is judged by itself. Heavy arms sag by millimetres, as they should; a cutting force that moves the tool
//! that far is a wrong unit. And whoever touched the part off with the machine itself, or has a controller
//! that knows the weight, must not correct it twice.

use kinetostat::{Mechanism, Wrench};
use nalgebra::Vector3;

use crate::result::PointResult;
use crate::run::Task;
use crate::solve::{Orientation, in_chunks};

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
            let pose = task.placement.tool_pose(&point.position_mm.into());
            let none = Wrench::zero();
            let (_, sagged) = own.rest(mechanism, &pose, &none, orientation).ok()?;
            let (_, straight) = without.rest(&bare, &pose, &none, orientation).ok()?;
            let off = sagged.translation.vector - straight.translation.vector;
            Some(task.placement.to_program(&off))
        };
        points.iter().map(shift).collect()
    })
}
