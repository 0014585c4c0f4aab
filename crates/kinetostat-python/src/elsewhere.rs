//! Postures of many that are solved otherwise than next to home: in another configuration, or with an orientation that follows.

use kinetostat::batch::{Batch, BatchEquilibrium, BatchStiffness, Details};
use kinetostat::compensation::{target_under_load, target_under_load_following};
use kinetostat::{Directions, Mechanism, Pose, Posture, PostureRequest, Result, Wrench};
use kinetostat_machining::Configurations;
use numpy::PyArray3;
use pyo3::prelude::*;

use crate::arrays::{Numbers, array, matrix_of, reserve, rows};
use crate::columns::{Columns, done};
use crate::machine::Machine;
use crate::work::Manner;

/// Places of a block that an arm reaches within its limits in another configuration than next to home: their numbers, and all
/// commands, one after the other.
pub(crate) fn in_other_configurations(
    configurations: &Configurations,
    poses: &[Pose],
    status: &[u8],
) -> (Vec<usize>, Vec<f64>) {
    let (mut places, mut commands) = (Vec::new(), Vec::new());
    if !configurations.are_several() {
        return (places, commands);
    }
    let left = status
        .iter()
        .enumerate()
        .filter(|(_, status)| **status != 0);
    for (place, _) in left {
        if let Some(posture) = within(configurations, &poses[place], status[place]) {
            places.push(place);
            commands.extend(posture.commands());
        }
    }
    (places, commands)
}

/// The posture in another configuration of a place that has this status.
fn within(configurations: &Configurations, pose: &Pose, status: u8) -> Option<Posture> {
    match status {
        1 => configurations.within_limits(pose),
        // A posture next to home without an equilibrium is not tried in other configurations.
        _ => configurations.posture(pose).ok(),
    }
    .filter(|posture| posture.within_limits().is_ok())
}

/// Solves places again at commands, where there are any.
pub(crate) fn stiffness_at(batch: &Batch, commands: &[f64]) -> Option<BatchStiffness> {
    match commands.is_empty() {
        true => None,
        false => batch.stiffness_at_joints(commands).ok(),
    }
}

/// Equilibria of these places under their wrenches.
pub(crate) fn equilibrium_at(
    batch: &Batch,
    (places, commands): &(Vec<usize>, Vec<f64>),
    wrenches: &[Wrench],
    details: Details,
) -> Option<BatchEquilibrium> {
    let own: Vec<Wrench> = places.iter().map(|place| wrenches[*place]).collect();
    match commands.is_empty() {
        true => None,
        false => batch.equilibrium_at_joints(commands, &own, details).ok(),
    }
}

/// A target under load: where to command, where the tool is then, and the commands.
pub(crate) struct Target {
    pub posture: Posture,
    pub tool: Pose,
}

/// The target of a place of this status in another configuration, if it is within all limits there.
pub(crate) fn target_elsewhere(
    configurations: &Configurations,
    pose: &Pose,
    wrench: &Wrench,
    directions: Directions,
    status: u8,
) -> Option<Target> {
    if status == 0 || !configurations.are_several() {
        return None;
    }
    let near = within(configurations, pose, status)?;
    let found = target_under_load(&near, pose, wrench, directions, near.rest_state());
    let target = of(found).ok()?;
    target.posture.within_limits().is_ok().then_some(target)
}

fn of(found: Result<(Posture, kinetostat::machine::MechanismState)>) -> Result<Target> {
    let (posture, state) = found?;
    let tool = state.platforms[posture.mechanism().tool()];
    Ok(Target { posture, tool })
}

/// The target at which the position of the tool is that of a pose, its orientation the nearest that the machine can have.
pub(crate) fn target_following(
    mechanism: &Mechanism,
    pose: &Pose,
    wrench: &Wrench,
) -> Result<Target> {
    let (position, wanted) = (&pose.translation.vector, &pose.rotation);
    let near = mechanism.posture(PostureRequest::position(position, wanted))?;
    let start = near.rest_state();
    of(target_under_load_following(
        &near, position, wanted, wrench, start,
    ))
}

/// Poses (n, 4, 4) at positions (n, 3) with the orientation nearest to that at home, which the machine takes there; with that at home
/// where it does not get there.
#[pyfunction]
#[pyo3(signature = (machine, positions, threads=None))]
pub fn poses_following<'py>(
    py: Python<'py>,
    machine: &Machine,
    positions: Numbers<'py>,
    threads: Option<usize>,
) -> PyResult<Bound<'py, PyArray3<f64>>> {
    let (count, numbers) = rows("poses", &positions, &[3])?;
    reserve(count, size_of::<[f64; 3]>())?;
    let places: Vec<[f64; 3]> = numbers.as_chunks::<3>().0.to_vec();
    let mechanism = machine.mechanism.clone();
    let manner = Manner {
        threads,
        progress: None,
    };
    let mut columns = Columns::new(count, &[16])?;
    let columns = done(py, count, &manner, move |course| {
        let home = mechanism.platforms()[mechanism.tool()].home;
        columns.fill(course, |_: &mut (), first, out, status| {
            let each = out[0].chunks_exact_mut(16);
            for (row, place) in each.zip(&places[first..first + status.len()]) {
                let at = Pose::from_parts((*place).into(), home.rotation);
                let (position, wanted) = (&at.translation.vector, &at.rotation);
                let found = mechanism.posture(PostureRequest::position(position, wanted));
                let pose = found.map_or(at, |posture| *posture.target());
                row.copy_from_slice(&matrix_of(&pose));
            }
        });
        columns
    })?;
    let numbers = columns.numbers.into_iter().next().unwrap_or_default();
    array(py, numbers, [count, 4, 4])
}
