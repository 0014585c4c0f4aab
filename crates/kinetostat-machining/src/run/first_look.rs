//! The first look at a program: a few places, solved before anything is divided, show a wrong unit in
//! milliseconds where the whole program would take minutes.

use kinetostat::Error;
use kinetostat::number::smaller;

use crate::checks::refused::{of_points, of_task};
use crate::limits::Beyond;
use crate::load::along_path::LoadAlongPath;
use crate::result::point::PointResult;
use crate::run::machines::Machines;
use crate::run::points::chunk;
use crate::run::sites::{of_path, spacing_mm};
use crate::task::{RunError, Task};
use crate::watch::Watch;

/// Places of a program at which figures are compared with their limits before anything is divided.
const FIRST_LOOKS: usize = 8;

/// A correction beyond its limit by this is refused by the first look: what a wrong unit does takes minutes to be
/// solved everywhere.
const GROSS: f64 = 10.0;

/// A load beyond its limits under which a place has no equilibrium, or that puts the tool off by far more than any correction:
/// a machine that folds over takes minutes to be solved everywhere. Of other loads an analysis only warns.
///
/// # Errors
/// [`RunError::Cancelled`].
pub(crate) fn folding_load(
    task: &Task<'_>,
    load: &LoadAlongPath<'_>,
    watch: &dyn Watch,
) -> Result<Vec<Beyond>, RunError> {
    let mut beyond = of_task(task);
    beyond.retain(|b| ["force_n", "moment_n_m"].contains(&b.limit.name));
    if beyond.is_empty() {
        return Ok(beyond);
    }
    let mut points = Vec::new();
    for found in looks(task, load, watch) {
        match found {
            Ok(point) => points.push(point),
            Err(RunError::Cancelled) => return Err(RunError::Cancelled),
            Err(RunError::Point { cause, .. }) if matches!(*cause, Error::NotConverged { .. }) => {
                return Ok(beyond);
            }
            // Of the place or the machine: reported where the program is solved.
            Err(_) => {}
        }
    }
    let folds = (gross(task, &points).iter()).any(|b| b.limit.name == "correction_mm");
    Ok(if folds { beyond } else { Vec::new() })
}

/// What is beyond its limits by far at a few places of the program as it is.
///
/// # Errors
/// Where the first of them has no answer. That a later one has none is reported where the program is solved, for there
/// may be others before it.
pub(crate) fn first_look(
    task: &Task<'_>,
    load: &LoadAlongPath<'_>,
    watch: &dyn Watch,
) -> Result<FirstLook, RunError> {
    let mut points = Vec::new();
    for (index, found) in looks(task, load, watch).enumerate() {
        match found {
            Ok(point) => points.push(point),
            Err(error) if index == 0 || matches!(error, RunError::Cancelled) => return Err(error),
            Err(_) => {}
        }
    }
    Ok(FirstLook {
        beyond: gross(task, &points),
        stiffness: smallest_stiffness(&points),
    })
}

/// What a first look shows.
pub(crate) struct FirstLook {
    /// What is beyond its limits by far.
    pub beyond: Vec<Beyond>,
    /// Smallest stiffness against a force, N/mm; infinite where no place was solved.
    pub stiffness: f64,
}

fn smallest_stiffness(points: &[PointResult]) -> f64 {
    let stiffnesses = points.iter().map(|p| p.smallest_stiffness_n_per_mm);
    stiffnesses.fold(f64::INFINITY, smaller)
}

/// Smallest stiffness against a force at a few places of the program, N/mm; places without an answer are left out.
///
/// # Errors
/// [`RunError::Cancelled`].
pub(crate) fn stiffness_at_first_look(
    task: &Task<'_>,
    load: &LoadAlongPath<'_>,
    watch: &dyn Watch,
) -> Result<f64, RunError> {
    let mut points = Vec::new();
    for found in looks(task, load, watch) {
        match found {
            Ok(point) => points.push(point),
            Err(RunError::Cancelled) => return Err(RunError::Cancelled),
            // Reported where the program is solved.
            Err(_) => {}
        }
    }
    Ok(smallest_stiffness(&points))
}

/// A few places of the program as it is, each solved by itself.
fn looks<'t>(
    task: &'t Task<'_>,
    load: &'t LoadAlongPath<'_>,
    watch: &'t dyn Watch,
) -> impl Iterator<Item = Result<PointResult, RunError>> + use<'t> {
    let sites = || of_path(task.path, load, &task.placement, spacing_mm(task));
    let every = sites().count().div_ceil(FIRST_LOOKS).max(1);
    let machines = Machines::new(task);
    sites().step_by(every).flat_map(move |site| {
        if watch.cancelled() {
            return vec![Err(RunError::Cancelled)];
        }
        let (machine, orientation) = machines.at(&site);
        let one = std::slice::from_ref(&site);
        chunk(
            task,
            machine,
            &mut Default::default(),
            one,
            (orientation, false),
        )
    })
}

/// Corrections that are beyond their limits by far.
fn gross(task: &Task<'_>, points: &[PointResult]) -> Vec<Beyond> {
    let mut beyond = of_points(task, points);
    beyond.retain(|b| {
        let of_correction = ["correction_mm", "own_weight_mm"].contains(&b.limit.name);
        of_correction && b.found > GROSS * b.allowed
    });
    beyond
}
