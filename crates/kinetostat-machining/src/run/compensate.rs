//! A run over a program: deflections along it, the compensated program, and the proof from the
//! written bytes.

use kinetostat_program::{Corrected, CorrectionField, Monitor, NoCorrection, Verification};

use crate::checks::refused::{of_accounting, of_points};
use crate::load::law::CornerLoad;
use crate::load::ramp_findings::TooFast;
use crate::result::point::{PointResult, most, size};
use crate::result::run_result::bound_mm;
use crate::result::tolerance::keeps_as_it_is;
use crate::run::checked::Checked;
use crate::run::conclude::{Run, conclude};
use crate::run::corner_steps::by_the_other_reading;
use crate::run::divide_again::Again;
use crate::run::following::jump;
use crate::run::force_band::force_band;
use crate::run::largest_change::changes;
use crate::run::of_whole::OfWhole;
use crate::run::places::places;
use crate::run::points::solve;
use crate::run::preparation::{Preparation, refuse};
use crate::run::sites::of_path::sites_of_path;
use crate::run::sites::of_written::sites_of_written;
use crate::run::summary::feed_arcs;
use crate::run::way_out::with_way_out;
use crate::task::{RunError, Task};
use crate::watch::Watch;

/// Deflections along the program as it is.
///
/// # Errors
/// [`RunError`] naming the line; [`RunError::BeyondLimits`] where a load that no cutting has folds the machine over.
pub fn analyse(task: &Task<'_>, watch: &dyn Watch) -> Result<Run, RunError> {
    analyse_part(task, None, watch)
}

/// Analysis of a part of a longer program, of which something is known.
///
/// # Errors
/// As [`analyse`].
pub fn analyse_part(
    task: &Task<'_>,
    whole: Option<&OfWhole>,
    watch: &dyn Watch,
) -> Result<Run, RunError> {
    analysed(task, whole, watch).map_err(|error| with_way_out(task, error))
}

fn analysed(task: &Task<'_>, whole: Option<&OfWhole>, watch: &dyn Watch) -> Result<Run, RunError> {
    let prepared = Preparation::of_analysis(task, whole, watch)?;
    let load = &prepared.load.acting;
    let sites = || sites_of_path(task, load);
    let (mut points, _) = solve(task, sites(), prepared.solving(false), watch)?;
    let checked = Checked {
        force_band: force_band(task, &mut points, sites, watch)?,
        places: places(task, &points, sites, prepared.solving(false)),
        ramps: prepared.load.findings.clone(),
        ..Checked::default()
    };
    Ok(conclude(task, load, points, None, &checked))
}

/// The compensated program, with deflections solved again from its bytes.
///
/// # Errors
/// [`RunError`] naming the line; nothing is to be written then.
pub fn compensate_program(task: &Task<'_>, watch: &dyn Watch) -> Result<Run, RunError> {
    compensate_part(task, None, watch)
}

/// Compensation of a part of a longer program, of which something is known. Only the whole program shows that it keeps its
/// tolerance uncorrected: a part is corrected, or left as it is if [`OfWhole::as_it_is`] says so.
///
/// # Errors
/// As [`compensate_program`].
pub fn compensate_part(
    task: &Task<'_>,
    whole: Option<&OfWhole>,
    watch: &dyn Watch,
) -> Result<Run, RunError> {
    compensated(task, whole, watch).map_err(|error| with_way_out(task, error))
}

fn compensated(
    task: &Task<'_>,
    whole: Option<&OfWhole>,
    watch: &dyn Watch,
) -> Result<Run, RunError> {
    let prepared = Preparation::of_correction(task, whole, watch)?;
    let (load, how) = (&prepared.load.acting, prepared.solving(true));
    let field = prepared.field(task);
    let mut again = Again::default();
    let arcs = feed_arcs(task.path());
    let as_it_is = whole.is_some_and(|whole| whole.as_it_is);
    let (mut written, mut check, mut points, mut worse, allowed_mm) = loop {
        let (written, check) = match as_it_is {
            true => write_and_read_again(task, &NoCorrection, watch)?,
            false => write_and_read_again(task, &again.field(&field), watch)?,
        };
        let (points, worse) = solve(task, sites_of_written(task, load, &written), how, watch)?;
        let stable = points.iter().all(|p| p.stable);
        let allowed_mm = bound_mm(&task.writing, arcs, &written.accounting);
        if !stable || as_it_is || !again.divides(task.path(), &field, &points, allowed_mm) {
            break (written, check, points, worse, allowed_mm);
        }
    };
    if let Some(point) = points.iter().find(|p| !p.stable) {
        return Err(RunError::Unstable {
            line: point.line,
            position_mm: point.position_mm,
        });
    }
    // A machine that gives way is the graver finding, so limits come after it.
    let mut beyond = of_accounting(&task.bounds.limits, &written.accounting);
    // The correction of a machine is compared with its limit by the points: the part due to its own weight is known
    // there.
    beyond.retain(|b| b.limit.name != "correction_mm");
    for found in of_points(task, &points) {
        if beyond.iter().all(|b| b.limit != found.limit) {
            beyond.push(found);
        }
    }
    refuse(beyond)?;
    let within_before = whole.is_none()
        && written.bytes != task.program.bytes()
        && within_before(&points, task.writing.tolerance_mm, allowed_mm);
    if within_before {
        // The uncorrected program keeps the tolerance, and the corrected one could be farther off.
        (written, check) = write_and_read_again(task, &NoCorrection, watch)?;
        (points, worse) = solve(task, sites_of_written(task, load, &written), how, watch)?;
    }
    // A block may end farther off if the force changes faster than the correction may; the tolerance is missed there.
    let matters = |found: &TooFast| found.matters(task.writing.tolerance_mm);
    if let Some(worse) = worse.filter(|_| !prepared.load.findings.too_fast.iter().any(matters)) {
        return Err(worse);
    }
    if let Some(line) = jump(task, &points) {
        return Err(RunError::Jump { line });
    }
    let sites = || sites_of_written(task, load, &written);
    let steps = || {
        let any = written.pieces.iter().any(|piece| piece.turn.is_some());
        any.then(sites).into_iter().flatten()
    };
    let checked = Checked {
        speed_percent: 100.0 * check.largest_speed_error,
        if_turns_mm: by_the_other_reading(task, CornerLoad::Turns, steps, watch)?,
        if_follows_mm: by_the_other_reading(task, CornerLoad::FollowsFeed, steps, watch)?,
        force_band: force_band(task, &mut points, sites, watch)?,
        places: places(task, &points, sites, how),
        divided_again: match within_before {
            true => None,
            false => again.description(allowed_mm),
        },
        within_before: within_before || as_it_is,
        changes: changes(task.path(), &written, &task.writing, |line| {
            task.load_on(line).largest_step
        }),
        ramps: prepared.load.findings.clone(),
    };
    Ok(conclude(task, load, points, Some(written), &checked))
}

/// True if the uncorrected program keeps its tolerance.
fn within_before(points: &[PointResult], tolerance_mm: f64, allowed_mm: f64) -> bool {
    let largest =
        |error: fn(&PointResult) -> f64| most(points, error).map_or(0.0, |(largest, _)| largest);
    let before = largest(|p| size(&p.error_before_mm));
    let after = largest(|p| size(&p.error_after_mm));
    keeps_as_it_is(before, after, tolerance_mm, allowed_mm)
}

/// The compensated program and what its own reader says of it.
fn write_and_read_again(
    task: &Task<'_>,
    field: &dyn CorrectionField,
    watch: &dyn Watch,
) -> Result<(Corrected, Verification), RunError> {
    watch.stage("corrections", 0);
    let monitor = Forward(watch);
    let written = task.program.write(field, &task.writing, &monitor)?;
    watch.stage("check of the written program", 0);
    let check = task.program.verify(&written, &task.writing)?;
    Ok((written, check))
}

/// Passes the writer's progress on.
struct Forward<'w>(&'w dyn Watch);

impl Monitor for Forward<'_> {
    fn progress(&self, done: usize, _so_far: usize) {
        // Every division asks for more points.
        self.0.stage("corrections", 0);
        self.0.advance(done);
    }
    fn cancelled(&self) -> bool {
        self.0.cancelled()
    }
}
