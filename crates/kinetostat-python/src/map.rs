//! Variables of maps for many postures.

use kinetostat::Wrench;
use kinetostat_dynamics::check_masses;
use kinetostat_machining::{
    EvaluationRoom, Evaluator, Outcome, PlaceState, VARIABLES, Variable, Width, Worse,
};
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{Numbers, array, poses as read_poses};
use crate::batch::each_wrench;
use crate::columns::{Columns, done};
use crate::errors::{Class, error, require_stiffness};
use crate::machine::Machine;
use crate::vibration::of_dynamics;
use crate::work::Manner;

/// Number of a posture's status in `kinetostat.Status`.
fn number(outcome: &Outcome) -> u8 {
    match (outcome.found, outcome.state) {
        (false, _) => 2,
        (true, PlaceState::OutsideLimits) => 1,
        (true, _) => 0,
    }
}

/// Name, unit, columns (none: one for each actuator), description, and which of two values is the worse one.
type Row = (
    &'static str,
    &'static str,
    Option<usize>,
    &'static str,
    &'static str,
);

/// All variables.
#[pyfunction]
pub fn map_variables() -> Vec<Row> {
    let row = |entry: &kinetostat_machining::Entry| {
        let columns = match entry.width {
            Width::Fixed(columns) => Some(columns),
            Width::Actuators => None,
        };
        let worse = match entry.worse {
            Worse::Smaller => "smaller",
            Worse::Larger => "larger",
            Worse::LargerSize => "larger size",
            Worse::Neither => "neither",
        };
        (entry.name, entry.unit, columns, entry.description, worse)
    };
    VARIABLES.iter().map(row).collect()
}

/// The variables of these names, each once.
fn named(names: &[String], loaded: bool, actuators: usize) -> PyResult<Vec<Variable>> {
    let mut chosen = Vec::new();
    for name in names {
        let Some(variable) = Variable::named(name) else {
            let known: Vec<&str> = VARIABLES.iter().map(|entry| entry.name).collect();
            return Err(error(
                Class::Argument,
                format!(
                    "variables: no map has '{name}'; there are {}",
                    known.join(", ")
                ),
            ));
        };
        if variable.needs_load() && !loaded {
            return Err(error(
                Class::Argument,
                format!("variables: '{name}' needs a load: give loads (zeros are one, too)"),
            ));
        }
        if variable.needs_drives() && actuators == 0 {
            return Err(error(
                Class::Argument,
                format!("variables: '{name}' is about drives, and this machine has none"),
            ));
        }
        if chosen.contains(&variable) {
            return Err(error(
                Class::Argument,
                format!("variables: '{name}' is asked for twice"),
            ));
        }
        chosen.push(variable);
    }
    Ok(chosen)
}

/// Variables of many postures (n, 4, 4) under wrenches (n, 6) or (1, 6); without wrenches of the unloaded machine as drawn.
/// `status` (n,) as `kinetostat.Status`, and for each variable an array (n,) or (n, columns).
#[pyfunction]
#[pyo3(signature = (machine, poses, wrenches, variables, threads=None, progress=None))]
pub fn evaluate_many<'py>(
    py: Python<'py>,
    machine: &Machine,
    poses: Numbers<'py>,
    wrenches: Option<Numbers<'py>>,
    variables: Vec<String>,
    threads: Option<usize>,
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let places = read_poses("poses", &poses, threads)?;
    let count = places.len();
    let wrenches = wrenches
        .map(|wrenches| each_wrench(count, &wrenches))
        .transpose()?;
    let chosen = named(
        &variables,
        wrenches.is_some(),
        machine.mechanism.actuator_count(),
    )?;
    if chosen.iter().any(|v| v.needs_stiffness()) {
        require_stiffness(&machine.mechanism)?;
    }
    if chosen.iter().any(|v| v.needs_mass()) {
        check_masses(&machine.mechanism).map_err(of_dynamics)?;
    }
    let evaluator = Evaluator::new(
        &machine.mechanism,
        machine.batch(),
        machine.ratings(),
        &chosen,
    );
    let widths = evaluator.widths();
    let own = widths.clone();
    let manner = Manner { threads, progress };
    let mut columns = Columns::new(count, &own)?;
    let columns = done(py, count, &manner, move |course| {
        columns.fill(course, |room: &mut Room, first, out, status| {
            let end = first + status.len();
            let loads: Option<&[Wrench]> = wrenches.as_deref().map(|all| &all[first..end]);
            room.outcomes.resize(status.len(), UNKNOWN);
            evaluator.evaluate(
                &places[first..end],
                loads,
                &mut room.own,
                out,
                &mut room.outcomes,
            );
            for (status, outcome) in status.iter_mut().zip(&room.outcomes) {
                *status = number(outcome);
            }
        });
        columns
    })?;
    let answer = PyDict::new(py);
    answer.set_item("status", PyArray1::from_vec(py, columns.status))?;
    let found = columns.numbers.into_iter().zip(widths).zip(chosen);
    for ((numbers, width), variable) in found {
        let entry = variable.entry();
        match entry.width {
            Width::Fixed(1) => answer.set_item(entry.name, PyArray1::from_vec(py, numbers))?,
            _ => answer.set_item(entry.name, array(py, numbers, [count, width])?)?,
        }
    }
    Ok(answer)
}

const UNKNOWN: Outcome = Outcome {
    state: PlaceState::Unanswered,
    found: false,
};

/// Buffers that a thread keeps from block to block.
#[derive(Default)]
struct Room {
    own: EvaluationRoom,
    outcomes: Vec<Outcome>,
}
