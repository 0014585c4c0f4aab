//! Many postures at once.

use std::borrow::Cow;
use std::sync::Arc;

use kinetostat::batch::{Batch, BatchEquilibrium, BatchStiffness, Details, Status, Table};
use kinetostat::spatial::pose_residual;
use kinetostat::{Directions, Mechanism, Pose, Wrench};
use kinetostat_machining::Configurations;
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{Numbers, array, matrix_of, poses, reserve, rows, wrenches};
use crate::columns::{Columns, done};
use crate::elsewhere::{
    Target, equilibrium_at, in_other_configurations, stiffness_at, target_elsewhere,
    target_following,
};
use crate::errors::{Class, error, of_core, require_stiffness};
use crate::machine::Machine;
use crate::work::Manner;

/// Number of a posture's status in `kinetostat.Status`.
fn number(status: Status, outside: bool) -> u8 {
    match (status.is_solved(), outside) {
        (false, _) => 2,
        (true, true) => 1,
        (true, false) => 0,
    }
}

/// Postures that lie side by side in a table ([`Table::data`]).
const SIDE_BY_SIDE: usize = 8;

/// Hands over the rows of an array of so many columns, each with the columns of its posture's block of a table and the posture's
/// place in them.
fn by_rows<'a>(
    table: &Table,
    columns: usize,
    to: &'a mut [f64],
    mut row: impl FnMut(&[[f64; SIDE_BY_SIDE]], usize, &'a mut [f64]),
) {
    let width = table.width();
    if width == 0 || columns == 0 {
        return;
    }
    let blocks = table.data().chunks_exact(SIDE_BY_SIDE * width);
    for (block, rows) in blocks.zip(to.chunks_mut(SIDE_BY_SIDE * columns)) {
        let (numbers, _) = block.as_chunks::<SIDE_BY_SIDE>();
        for (i, own) in rows.chunks_exact_mut(columns).enumerate() {
            // The remainder is what it is, and is seen to be in range.
            row(numbers, i % SIDE_BY_SIDE, own);
        }
    }
}

/// Puts rows of a table into rows of an array.
fn put(table: &Table, to: &mut [f64]) {
    by_rows(table, table.width(), to, |numbers, i, row| {
        for (number, column) in row.iter_mut().zip(numbers) {
            *number = column[i];
        }
    });
}

/// Puts one row of a table into a row of an array.
fn put_row(table: &Table, row: usize, place: usize, to: &mut [f64]) {
    let numbers: Vec<f64> = table.row(row).collect();
    put_numbers(&numbers, place, to);
}

/// Puts numbers into a row of an array that is kept.
fn put_numbers(numbers: &[f64], place: usize, to: &mut [f64]) {
    let width = numbers.len();
    if let Some(own) = to.get_mut(width * place..width * (place + 1)) {
        own.copy_from_slice(numbers);
    }
}

/// Rows of 16 numbers, a 4 x 4 matrix each, from rows of 12: rotation row by row, position.
fn put_poses(table: &Table, to: &mut [f64]) {
    by_rows(table, 16, to, |numbers, i, row| {
        for k in 0..3 {
            for j in 0..3 {
                row[4 * k + j] = numbers[3 * k + j][i];
            }
            row[4 * k + 3] = numbers[9 + k][i];
        }
        let known = !row[3].is_nan();
        row[12..15].fill(if known { 0.0 } else { f64::NAN });
        row[15] = if known { 1.0 } else { f64::NAN };
    });
}

/// Limits of all actuators, in their order; infinite where there are none.
struct Limits(Vec<(f64, f64)>);

impl Limits {
    fn of(machine: &Mechanism) -> Self {
        let each = machine.limbs().iter().flat_map(|l| l.nominal.actuators());
        let limits = each.map(|a| a.limits.unwrap_or((f64::NEG_INFINITY, f64::INFINITY)));
        Self(limits.collect())
    }

    /// States of postures with these commands, a row each.
    fn states(&self, found: &[Status], commands: &[f64], to: &mut [u8]) {
        let each = self.0.len();
        for (i, (to, found)) in to.iter_mut().zip(found).enumerate() {
            let own = commands[i * each..].iter().zip(&self.0);
            let outside = own.fold(false, |any, (x, (low, high))| any | (x < low) | (x > high));
            *to = number(*found, outside);
        }
    }
}

/// Commands of the machine: poses of its tool, or its joints.
enum Places {
    Poses(Vec<Pose>),
    Joints(Vec<f64>, usize),
}

impl Places {
    fn of(
        machine: &Machine,
        targets: Option<&Numbers<'_>>,
        joints: Option<&Numbers<'_>>,
        threads: Option<usize>,
    ) -> PyResult<Self> {
        match (targets, joints) {
            (Some(targets), None) => Ok(Self::Poses(poses("poses", targets, threads)?)),
            (None, Some(joints)) => {
                let each = machine.mechanism.actuator_count();
                let (_, numbers) = rows("joints", joints, &[each])?;
                // A machine that cannot be commanded by joints is refused before the work begins.
                let none = machine.batch().targets_at_joints(&[]);
                none.map_err(|e| of_core(&e))?;
                reserve(numbers.len(), size_of::<f64>())?;
                Ok(Self::Joints(numbers.to_vec(), each))
            }
            _ => Err(error(Class::Argument, "give poses or joints")),
        }
    }

    fn len(&self) -> usize {
        match self {
            Self::Poses(poses) => poses.len(),
            Self::Joints(commands, each) => commands.len() / each.max(&1),
        }
    }

    fn stiffness(&self, batch: &Batch, from: usize, to: usize, out: &mut BatchStiffness) {
        match self {
            Self::Poses(poses) => batch.stiffness_into(&poses[from..to], out),
            Self::Joints(commands, each) => {
                // The machine can be commanded so, and all rows have the length that it needs.
                let _ = batch.stiffness_at_joints_into(&commands[from * each..to * each], out);
            }
        }
    }

    /// Commands that were given, of the rows from one to another.
    fn given(&self, from: usize, to: usize) -> Option<&[f64]> {
        match self {
            Self::Poses(_) => None,
            Self::Joints(commands, each) => Some(&commands[from * each..to * each]),
        }
    }

    /// Places from the first of a block that are solved in another configuration, and the commands there: of poses.
    fn elsewhere(
        &self,
        configurations: &Configurations,
        first: usize,
        status: &[u8],
    ) -> (Vec<usize>, Vec<f64>) {
        match self {
            Self::Poses(poses) => in_other_configurations(configurations, &poses[first..], status),
            Self::Joints(..) => Default::default(),
        }
    }

    /// Commanded poses of the tool, as drawn, for a range of rows.
    fn targets(&self, batch: &Batch, from: usize, to: usize) -> Cow<'_, [Pose]> {
        match self {
            Self::Poses(poses) => Cow::Borrowed(&poses[from..to]),
            Self::Joints(commands, each) => {
                let own = &commands[from * each..to * each];
                Cow::Owned(batch.targets_at_joints(own).unwrap_or_default())
            }
        }
    }

    fn equilibrium(
        &self,
        batch: &Batch,
        (from, to): (usize, usize),
        wrenches: &[Wrench],
        details: Details,
        out: &mut BatchEquilibrium,
    ) -> kinetostat::Result<()> {
        match self {
            Self::Poses(poses) => batch.equilibrium_into(&poses[from..to], wrenches, details, out),
            Self::Joints(commands, each) => {
                let own = &commands[from * each..to * each];
                batch.equilibrium_at_joints_into(own, wrenches, details, out)
            }
        }
    }
}

/// Reads one wrench for all postures, or one for each.
pub(crate) fn each_wrench(count: usize, numbers: &Numbers<'_>) -> PyResult<Vec<Wrench>> {
    let found = wrenches("wrenches", numbers)?;
    match found.len() {
        1 => {
            reserve(count, size_of::<Wrench>())?;
            Ok(vec![found[0]; count])
        }
        n if n == count => Ok(found),
        n => Err(error(
            Class::Argument,
            format!(
                "wrenches has shape ({n}, 6), expected (1, 6) or ({count}, 6) as there are {count} postures"
            ),
        )),
    }
}

/// Stiffness (n, 6, 6), commands (n, actuators), state (n,) of many postures of the unloaded machine as drawn.
#[pyfunction]
#[pyo3(signature = (machine, poses=None, joints=None, threads=None, progress=None))]
pub fn stiffness_of_many<'py>(
    py: Python<'py>,
    machine: &Machine,
    poses: Option<Numbers<'py>>,
    joints: Option<Numbers<'py>>,
    threads: Option<usize>,
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let places = Places::of(machine, poses.as_ref(), joints.as_ref(), threads)?;
    require_stiffness(&machine.mechanism)?;
    let (batch, limits) = (machine.batch(), Limits::of(&machine.mechanism));
    let configurations = machine.configurations();
    let (count, actuators) = (places.len(), machine.mechanism.actuator_count());
    let manner = Manner { threads, progress };
    let mut columns = Columns::new(count, &[36, actuators])?;
    let columns = done(py, count, &manner, move |course| {
        columns.fill(course, |found: &mut BatchStiffness, first, out, status| {
            let end = first + status.len();
            places.stiffness(&batch, first, end, found);
            put(&found.stiffness, out[0]);
            match places.given(first, end) {
                Some(commands) => out[1].copy_from_slice(commands),
                None => put(&found.commands, out[1]),
            }
            limits.states(&found.status, out[1], status);
            let elsewhere = places.elsewhere(&configurations, first, status);
            let Some(again) = stiffness_at(&batch, &elsewhere.1) else {
                return;
            };
            let each = elsewhere.1.chunks_exact(actuators).zip(&elsewhere.0);
            for (row, (commands, &place)) in each.enumerate() {
                if again.status[row].is_solved() {
                    put_row(&again.stiffness, row, place, out[0]);
                    out[1][actuators * place..actuators * (place + 1)].copy_from_slice(commands);
                    status[place] = 0;
                }
            }
        });
        columns
    })?;
    let mut numbers = columns.numbers.into_iter();
    let mut next = || numbers.next().unwrap_or_default();
    let answer = PyDict::new(py);
    answer.set_item("matrix", array(py, next(), [count, 6, 6])?)?;
    answer.set_item("commands", array(py, next(), [count, actuators])?)?;
    answer.set_item("status", PyArray1::from_vec(py, columns.status))?;
    Ok(answer)
}

/// Equilibria of many postures. `details`: 0 rest, 1 stiffness too, 2 stability too. `fields`: tool, displacement, forces of the
/// actuators and stiffness are kept; all without it.
#[pyfunction]
#[pyo3(signature = (machine, wrenches, details, poses=None, joints=None, fields=None, threads=None, progress=None))]
pub fn equilibrium_of_many<'py>(
    py: Python<'py>,
    machine: &Machine,
    wrenches: Numbers<'py>,
    details: u8,
    poses: Option<Numbers<'py>>,
    joints: Option<Numbers<'py>>,
    fields: Option<[bool; 4]>,
    threads: Option<usize>,
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let places = Places::of(machine, poses.as_ref(), joints.as_ref(), threads)?;
    require_stiffness(&machine.mechanism)?;
    let (batch, limits) = (machine.batch(), Limits::of(&machine.mechanism));
    let configurations = machine.configurations();
    let (count, actuators) = (places.len(), machine.mechanism.actuator_count());
    let wrenches = each_wrench(count, &wrenches)?;
    let details = match details {
        0 => Details::Rest,
        1 => Details::Stiffness,
        _ => Details::Stability,
    };
    let wanted = |from: Details, width: usize| if details >= from { width } else { 0 };
    let [tool, displacement, forces, stiffness] = fields.unwrap_or([true; 4]);
    let kept = |kept: bool, width: usize| if kept { width } else { 0 };
    let widths = [
        kept(tool, 16),
        kept(displacement, 6),
        actuators,
        kept(forces, actuators),
        kept(stiffness, wanted(Details::Stiffness, 36)),
        wanted(Details::Stability, 3),
    ];
    let manner = Manner { threads, progress };
    let mut columns = Columns::new(count, &widths)?;
    let columns = done(py, count, &manner, move |course| {
        columns.fill(
            course,
            |found: &mut BatchEquilibrium, first, out, status| {
                let end = first + status.len();
                let own = &wrenches[first..end];
                if places
                    .equilibrium(&batch, (first, end), own, details, found)
                    .is_err()
                {
                    out.iter_mut().for_each(|column| column.fill(f64::NAN));
                    status.fill(2);
                    return;
                }
                put_poses(&found.tool, out[0]);
                let targets = places.targets(&batch, first, end);
                let rows = out[1].chunks_exact_mut(6).zip(targets.iter());
                for (i, (row, target)) in rows.enumerate() {
                    if found.status[i].is_solved() {
                        let moved = pose_residual(&found.tool_pose(i), target);
                        row.copy_from_slice(moved.0.as_slice());
                    } else {
                        row.fill(f64::NAN);
                    }
                }
                put(&found.commands, out[2]);
                put(&found.actuator_forces, out[3]);
                put(&found.stiffness, out[4]);
                put(&found.stability, out[5]);
                limits.states(&found.status, out[2], status);
                let elsewhere = places.elsewhere(&configurations, first, status);
                let Some(again) = equilibrium_at(&batch, &elsewhere, own, details) else {
                    return;
                };
                for (row, &place) in elsewhere.0.iter().enumerate() {
                    if !again.status[row].is_solved() {
                        continue;
                    }
                    let tool = again.tool_pose(row);
                    put_numbers(&matrix_of(&tool), place, out[0]);
                    let moved = pose_residual(&tool, &targets[place]);
                    put_numbers(moved.0.as_slice(), place, out[1]);
                    put_row(&again.commands, row, place, out[2]);
                    put_row(&again.actuator_forces, row, place, out[3]);
                    put_row(&again.stiffness, row, place, out[4]);
                    put_row(&again.stability, row, place, out[5]);
                    status[place] = 0;
                }
            },
        );
        columns
    })?;
    let mut numbers = columns.numbers.into_iter();
    let mut next = || numbers.next().unwrap_or_default();
    let answer = PyDict::new(py);
    let each: [(&str, bool, &[usize]); 6] = [
        ("tool", tool, &[count, 4, 4]),
        ("displacement", displacement, &[count, 6]),
        ("commands", true, &[count, actuators]),
        ("actuator_forces", forces, &[count, actuators]),
        ("stiffness", widths[4] > 0, &[count, 6, 6]),
        ("stability", widths[5] > 0, &[count, 3]),
    ];
    for (name, kept, shape) in each {
        let numbers = next();
        if kept {
            answer.set_item(name, array(py, numbers, shape)?)?;
        }
    }
    answer.set_item("status", PyArray1::from_vec(py, columns.status))?;
    Ok(answer)
}

/// Poses to command so that the tool is at `poses` under `wrenches` in the directions that are corrected. If only the position is
/// corrected and the machine turns its tool as it moves, the orientation is the nearest that it can have.
#[pyfunction]
#[pyo3(signature = (machine, poses, wrenches, directions, threads=None, progress=None))]
pub fn targets_of_many<'py>(
    py: Python<'py>,
    machine: &Machine,
    poses: Numbers<'py>,
    wrenches: Numbers<'py>,
    directions: [bool; 6],
    threads: Option<usize>,
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let wanted = crate::arrays::poses("poses", &poses, threads)?;
    let (batch, limits) = (machine.batch(), Limits::of(&machine.mechanism));
    let (count, actuators) = (wanted.len(), machine.mechanism.actuator_count());
    let wrenches = each_wrench(count, &wrenches)?;
    let chosen = (0..6).filter(|k| directions[*k]);
    let directions = chosen.fold(Directions::NONE, Directions::with);
    let batch: Arc<Batch> = batch;
    let (mechanism, configurations) = (machine.mechanism.clone(), machine.configurations());
    let follows = directions == Directions::POSITION && machine.turns();
    let manner = Manner { threads, progress };
    let mut columns = Columns::new(count, &[16, 16, actuators])?;
    let columns = done(py, count, &manner, move |course| {
        columns.fill(course, |_: &mut (), first, out, status| {
            let end = first + status.len();
            if follows {
                for (i, status) in status.iter_mut().enumerate() {
                    let (pose, wrench) = (&wanted[first + i], &wrenches[first + i]);
                    let found = target_following(&mechanism, pose, wrench);
                    *status = put_target(found.ok().as_ref(), i, out);
                }
                return;
            }
            let found =
                batch.targets_under_load(&wanted[first..end], &wrenches[first..end], directions);
            let Ok(found) = found else {
                out.iter_mut().for_each(|column| column.fill(f64::NAN));
                status.fill(2);
                return;
            };
            for (row, target) in out[0].chunks_exact_mut(16).zip(&found.targets) {
                row.copy_from_slice(&matrix_of(target));
            }
            let equilibrium = &found.equilibrium;
            put_poses(&equilibrium.tool, out[1]);
            put(&equilibrium.commands, out[2]);
            limits.states(&equilibrium.status, out[2], status);
            for (i, status) in status.iter_mut().enumerate() {
                let (pose, wrench) = (&wanted[first + i], &wrenches[first + i]);
                let found = target_elsewhere(&configurations, pose, wrench, directions, *status);
                if found.is_some() {
                    *status = put_target(found.as_ref(), i, out);
                }
            }
        });
        columns
    })?;
    let mut numbers = columns.numbers.into_iter();
    let mut next = || numbers.next().unwrap_or_default();
    let answer = PyDict::new(py);
    answer.set_item("targets", array(py, next(), [count, 4, 4])?)?;
    answer.set_item("tool", array(py, next(), [count, 4, 4])?)?;
    answer.set_item("commands", array(py, next(), [count, actuators])?)?;
    answer.set_item("status", PyArray1::from_vec(py, columns.status))?;
    Ok(answer)
}

/// Writes a target under load, where there is one, into a row of targets, tools and commands; its state.
fn put_target(found: Option<&Target>, row: usize, out: &mut [&mut [f64]]) -> u8 {
    let [targets, tools, commands] = out else {
        return 2;
    };
    let pose = 16 * row..16 * (row + 1);
    let Some(found) = found else {
        targets[pose.clone()].fill(f64::NAN);
        tools[pose].fill(f64::NAN);
        let actuators = commands.len() / (targets.len() / 16);
        commands[actuators * row..actuators * (row + 1)].fill(f64::NAN);
        return 2;
    };
    targets[pose.clone()].copy_from_slice(&matrix_of(found.posture.target()));
    tools[pose].copy_from_slice(&matrix_of(&found.tool));
    let own = found.posture.commands();
    commands[own.len() * row..own.len() * (row + 1)].copy_from_slice(&own);
    u8::from(found.posture.within_limits().is_err())
}
