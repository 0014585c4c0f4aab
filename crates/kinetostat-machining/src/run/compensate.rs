//! A run over a program: deflections along it, the compensated program, and the proof from the
//! written bytes.
//!
//! Blocks divided again where the last check finds the tool farther off than the written program claims.
//!
//! The division rests on an assumption about the model between the places that it evaluates ([`Course::Smooth`]); the
//! check looks at places of its own. A place that it finds off becomes one at which the block is divided in any case,
//! the program is written once more, and checked as before in every place. Places that are off for another reason (an
//! axis that the program never states, a corner) are not divided again: it would not help.
//!
//! [`Course::Smooth`]: kinetostat_program::Course::Smooth

use std::collections::BTreeMap;

use kinetostat_program::{
    Corrected, Correction, CorrectionField, FieldFailure, Monitor, Move, NoCorrection, Path,
    Request, Structure, Verification,
};
use nalgebra::Vector3;

use crate::checks::refused::{of_accounting, of_points};
use crate::field::ModelField;
use crate::load::law::CornerLoad;
use crate::load::ramp_findings::TooFast;
use crate::number::largest_length;
use crate::result::point::{PointKind, PointResult, most, size};
use crate::result::run_result::bound_mm;
use crate::result::tolerance::keeps_as_it_is;
use crate::run::conclude::{Run, conclude};
use crate::run::joints::jump;
use crate::run::largest_change::changes;
use crate::run::other_load::{by_the_other_reading, force_band};
use crate::run::places::places;
use crate::run::points::solve;
use crate::run::preparation::{OfWhole, Preparation, refuse};
use crate::run::sites::of_path::sites_of_path;
use crate::run::sites::of_written::sites_of_written;
use crate::run::summary::{Checked, feed_arcs};
use crate::run::way_out::with_way_out;
use crate::task::{RunError, Task};
use crate::warning::{Warning, WarningCode};
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

/// Rounds of dividing again, at most. Each halves what is left at a kink of the correction, at least.
const ROUNDS: usize = 8;

/// Additional divisions of blocks.
#[derive(Debug, Default)]
pub(crate) struct Again {
    /// Shares by move at which blocks are divided besides those that the field itself knows.
    breaks: BTreeMap<usize, Vec<f64>>,
    rounds: usize,
    /// Line of the worst place that was found, and how far the tool was off there, mm.
    worst: Option<(usize, f64)>,
}

/// A model's field that is to be evaluated in some more places.
pub(crate) struct Refined<'a> {
    field: &'a ModelField<'a>,
    breaks: &'a BTreeMap<usize, Vec<f64>>,
}

impl CorrectionField for Refined<'_> {
    fn turns_tool(&self) -> bool {
        self.field.turns_tool()
    }

    fn corrections(&self, requests: &[Request]) -> Vec<Result<Correction, FieldFailure>> {
        self.field.corrections(requests)
    }

    fn turns(&self) -> bool {
        self.field.turns()
    }

    fn structure(&self, move_index: usize, motion: &Move) -> Structure {
        let mut own = self.field.structure(move_index, motion);
        own.breaks
            .extend(self.breaks.get(&move_index).into_iter().flatten());
        own
    }
}

impl Again {
    pub fn field<'a>(&'a self, field: &'a ModelField<'a>) -> Refined<'a> {
        Refined {
            field,
            breaks: &self.breaks,
        }
    }

    /// Takes the places of a written program that are off and would not be if they were ends of pieces;
    /// whether there are any, and a round left for them.
    pub fn divides(
        &mut self,
        path: &Path,
        field: &ModelField<'_>,
        points: &[PointResult],
        allowed_mm: f64,
    ) -> bool {
        if self.rounds == ROUNDS {
            return false;
        }
        let off: Vec<(Request, &PointResult)> = points
            .iter()
            .filter(|p| p.kind == PointKind::Feed && size(&p.error_after_mm) > allowed_mm)
            .filter_map(|p| Some((inside(path, p)?, p)))
            .collect();
        let answers = field.corrections(&off.iter().map(|(r, _)| *r).collect::<Vec<_>>());
        let mut found = false;
        for ((request, point), answer) in off.into_iter().zip(answers) {
            let Ok(answer) = answer else { continue };
            let mut missing = answer.shift_mm - Vector3::from(point.correction_mm);
            for axis in (0..3).filter(|axis| !path.stated[*axis]) {
                missing[axis] = 0.0;
            }
            let breaks = self.breaks.entry(request.move_index).or_default();
            if missing.norm() <= allowed_mm || breaks.contains(&request.share) {
                continue;
            }
            breaks.push(request.share);
            found = true;
            let error = size(&point.error_after_mm);
            if self.worst.is_none_or(|(_, most)| error > most) {
                self.worst = Some((point.line, error));
            }
        }
        self.rounds += usize::from(found);
        found
    }

    /// Warning about the additional divisions.
    pub fn description(&self, allowed_mm: f64) -> Option<Warning> {
        let (line, worst) = self.worst?;
        let places: usize = self.breaks.values().map(Vec::len).sum();
        let blocks = self.breaks.values().filter(|list| !list.is_empty()).count();
        let many = |count: usize, what: &str| match count {
            1 => format!("1 {what}"),
            _ => format!("{count} {what}s"),
        };
        Some(Warning::at_line(
            WarningCode::DividedAgain,
            line,
            format!(
                "the check of the written program found the tool up to {} off at {}, beyond the {} that are allowed: {} divided again there, in {}, because the correction changes faster than the size of the machine lets expect",
                largest_length(worst),
                many(places, "place"),
                largest_length(allowed_mm),
                match blocks {
                    1 => "1 block was".to_owned(),
                    _ => format!("{blocks} blocks were"),
                },
                many(self.rounds, "round"),
            ),
        ))
    }
}

/// The place of a point inside a block that can be divided.
fn inside(path: &Path, point: &PointResult) -> Option<Request> {
    let move_index = point.move_index;
    let motion = path.moves.get(move_index)?;
    let divided = motion.is_known_feed();
    (divided && point.share > 0.0 && point.share < 1.0).then(|| Request {
        move_index,
        share: point.share,
        position_mm: motion.point(point.share),
        tangent: motion.tangent(point.share),
        orientation: motion.orientation(point.share),
        turning: None,
    })
}
