//! A run over a program: deflections along it, the compensated program, and the proof from the
//! written bytes.

use kinetostat::batch::{AlongPath, BatchEquilibrium};
use kinetostat::number;
use kinetostat::{Error, Mechanism, MechanismEquilibrium, MotionKind, Pose, Posture, Wrench};
use kinetostat_program::{
    Corrected, CorrectionField, Curve, Monitor, MoveKind, NoCorrection, Path, Program, ReadOptions,
    Verification, WriteError, WriteOptions, verify_written, write_corrected,
};
use nalgebra::{UnitQuaternion, Vector3};

use crate::again::Again;
use crate::corners::by_the_other_reading;
use crate::field::{ModelField, in_words};
use crate::following::{following, jump, turn_deg};
use crate::judge::{self, Bounds};
use crate::limits::Beyond;
use crate::load::{CornerLoad, LoadAlongPath, ProgramLoad};
use crate::near::{natural_length, near_singular};
use crate::placement::Placement;
use crate::result::{
    ActuatorColumn, NearSingularPlace, PointKind, PointResult, Question, RESULT_SCHEMA, RunResult,
    Summary, ToleranceVerdict, ToolAtCorners, bound_mm,
};
use crate::sites::{Site, of_path, of_written};
use crate::solve::{Neighbour, Orientation, in_chunks};
use crate::thin::thinned;
use crate::tool::{Machines, Tool, tool_on};
use crate::verdict::keeps_as_it_is;
use crate::warning::{Warning, WarningCode};

/// Everything that decides a run.
#[derive(Clone, Debug)]
pub struct Task<'a> {
    /// Machine with its tool: the platform's reference point is the tool's tip.
    pub mechanism: &'a Mechanism,
    /// The program as read.
    pub program: &'a Program,
    /// How it was read.
    pub reading: ReadOptions,
    /// Its motion.
    pub path: &'a Path,
    /// Where it lies.
    pub placement: Placement,
    /// What acts on the tool.
    pub load: ProgramLoad,
    /// Tools that the program takes by number, each with its own machine and load; empty where there is
    /// one tool. `mechanism` and `load` are those of blocks without one of these.
    pub tools: &'a [Tool<'a>],
    /// How the compensated program is written.
    pub writing: WriteOptions,
    /// Names and words for the result; figures are filled in by the run.
    pub question: Question,
    /// What its figures are judged by.
    pub bounds: Bounds,
}

impl<'a> Task<'a> {
    /// Machine with the tool that the block on a line is made with.
    pub(crate) fn mechanism_on(&self, line: usize) -> &'a Mechanism {
        tool_on(self.tools, self.path, line).map_or(self.mechanism, |tool| tool.mechanism)
    }

    /// What acts on the tool that the block on a line is made with.
    pub(crate) fn load_on(&self, line: usize) -> &ProgramLoad {
        tool_on(self.tools, self.path, line).map_or(&self.load, |tool| &tool.load)
    }
}

/// Who watches a run and may stop it.
pub trait Watch: Sync {
    /// A stage begins; `total` points, 0 where nobody knows how many there will be.
    fn stage(&self, name: &str, total: usize);
    /// Points done in this stage.
    fn advance(&self, done: usize);
    /// Whether to stop.
    fn cancelled(&self) -> bool;
}

/// Watches nothing.
#[derive(Clone, Copy, Debug, Default)]
pub struct Unwatched;

impl Watch for Unwatched {
    fn stage(&self, _: &str, _: usize) {}
    fn advance(&self, _: usize) {}
    fn cancelled(&self) -> bool {
        false
    }
}

/// Why a run has no answer.
#[derive(Clone, Debug, thiserror::Error)]
pub enum RunError {
    /// The program cannot be written.
    #[error("{0}")]
    Write(#[from] WriteError),
    /// A point has no answer.
    #[error("line {line}: at X{:.4} Y{:.4} Z{:.4} mm: {message}", position_mm[0], position_mm[1], position_mm[2])]
    Point {
        /// Line of the program, from 1.
        line: usize,
        /// Program coordinates, mm.
        position_mm: [f64; 3],
        /// What is wrong and what to do.
        message: String,
        /// The core's error.
        cause: Box<Error>,
    },
    /// The written program would be worse somewhere.
    #[error(
        "line {line}: compensated, this block would end {} off, more than the {} without compensation; nothing was written. Tighten the path tolerance, allow more decimals, or report this with the job",
        number::against(*after_mm, *before_mm).0, number::against(*after_mm, *before_mm).1
    )]
    Worse {
        /// Line of the program, from 1.
        line: usize,
        /// Error without compensation, mm.
        before_mm: f64,
        /// Error with it, mm.
        after_mm: f64,
    },
    /// Figures that no sensible question has.
    #[error("{}; nothing was written", in_lines(.0))]
    BeyondLimits(Vec<Beyond>),
    /// The machine would jump to another shape.
    #[error(
        "line {line}: at X{:.4} Y{:.4} Z{:.4} mm the machine is not stable under this load: it would jump to another shape; nothing was written. Reduce the load, move the part, or stiffen the machine; `kinetostat deflect` shows the rest of the path", position_mm[0], position_mm[1], position_mm[2]
    )]
    Unstable {
        /// Line of the program, from 1.
        line: usize,
        /// Program coordinates, mm.
        position_mm: [f64; 3],
    },
    /// The orientation that follows is not continuous.
    #[error(
        "line {line}: the orientation of the tool jumps here: the machine would have to change its branch, or passes close to a singular posture; nothing was written. Move the part, or give an orientation to keep near to (`kinetostat deflect` shows how far the tool turns)"
    )]
    Jump {
        /// Line of the program, from 1.
        line: usize,
    },
    /// The program has no move whose place is known.
    #[error(
        "the program has no motion whose place is known: state X, Y and Z before the first cut, or give the start position"
    )]
    NoMotion,
    /// Stopped on request.
    #[error("stopped on request; nothing was written")]
    Cancelled,
}

fn in_lines(list: &[Beyond]) -> String {
    let lines: Vec<String> = list.iter().map(Beyond::to_string).collect();
    lines.join("\n")
}

/// Refuses what is beyond its limits.
fn refuse(beyond: Vec<Beyond>) -> Result<(), RunError> {
    match beyond.is_empty() {
        true => Ok(()),
        false => Err(RunError::BeyondLimits(beyond)),
    }
}

impl RunError {
    /// Wrong input (exit code 1) or a question that has no answer (2).
    #[must_use]
    pub fn is_unanswered(&self) -> bool {
        match self {
            Self::Point { cause, .. } => cause.is_unanswered(),
            Self::Write(WriteError::Field { .. })
            | Self::Worse { .. }
            | Self::Unstable { .. }
            | Self::Jump { .. } => true,
            _ => false,
        }
    }
}

/// A run's result, all its points, and the written program.
#[derive(Clone, Debug)]
pub struct Run {
    /// Summary and decimated points.
    pub result: RunResult,
    /// All points.
    pub points: Vec<PointResult>,
    /// The compensated program, checked; not yet on disk.
    pub written: Option<Corrected>,
}

/// Deflections along the program as it is.
///
/// # Errors
/// [`RunError`] naming the line.
pub fn analyse(task: &Task<'_>, watch: &dyn Watch) -> Result<Run, RunError> {
    let load = LoadAlongPath::with_tools(task.load, task.path, task.tools);
    let sites = || of_path(task.path, &load, &task.placement, spacing_mm(task));
    let (points, _) = solve(task, sites, false, watch)?;
    Ok(conclude(task, &load, points, None, &Checked::default()))
}

/// The compensated program, with deflections solved again from its bytes.
///
/// # Errors
/// [`RunError`] naming the line; nothing is to be written then.
pub fn compensate_program(task: &Task<'_>, watch: &dyn Watch) -> Result<Run, RunError> {
    refuse(judge::of_question(task))?;
    let load = LoadAlongPath::with_tools(task.load, task.path, task.tools);
    refuse(hopeless(task, &load, watch)?)?;
    let field = ModelField::new(task.mechanism, task.placement, &load);
    let mut again = Again::default();
    let arcs = feed_arcs(task);
    let (mut written, mut check, mut points, mut worse, allowed_mm) = loop {
        let (written, check) = write_and_read_again(task, &again.field(&field), watch)?;
        let (points, worse) = solve(task, || sites(task, &load, &written), true, watch)?;
        let stable = points.iter().all(|p| p.stable);
        let allowed_mm = bound_mm(&task.writing, arcs, &written.accounting);
        if !stable || !again.divides(task.path, &field, &points, allowed_mm) {
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
    let mut beyond = judge::of_accounting(&task.bounds.limits, &written.accounting);
    // Of a machine the correction is judged with its points: what is due to its own weight is known there.
    beyond.retain(|b| b.limit.name != "correction_mm");
    for found in judge::of_points(task, &points) {
        if beyond.iter().all(|b| b.limit != found.limit) {
            beyond.push(found);
        }
    }
    refuse(beyond)?;
    let within_before = written.bytes != task.program.bytes()
        && within_before(&points, task.writing.tolerance_mm, allowed_mm);
    if within_before {
        // As it is, the program keeps what is claimed of a corrected one, which could be farther off.
        (written, check) = write_and_read_again(task, &NoCorrection, watch)?;
        (points, worse) = solve(task, || sites(task, &load, &written), true, watch)?;
    }
    if let Some(worse) = worse {
        return Err(worse);
    }
    if let Some(line) = jump(task, &points) {
        return Err(RunError::Jump { line });
    }
    let sites = || sites(task, &load, &written);
    let checked = Checked {
        speed_percent: 100.0 * check.largest_speed_error,
        if_turns_mm: by_the_other_reading(task, CornerLoad::Turns, sites, watch)?,
        if_follows_mm: by_the_other_reading(task, CornerLoad::FollowsFeed, sites, watch)?,
        divided_again: match within_before {
            true => None,
            false => again.in_words(allowed_mm),
        },
        within_before,
    };
    Ok(conclude(task, &load, points, Some(written), &checked))
}

/// Places of a program at which it is asked, before anything is divided, whether the question makes sense.
const FIRST_LOOKS: usize = 8;

/// A correction beyond its limit by this is refused by the first look: what a wrong unit does takes minutes to be
/// solved everywhere.
const HOPELESS: f64 = 10.0;

/// What is beyond its limits by far at a few places of the program as it is.
///
/// # Errors
/// Where the first of them has no answer. That a later one has none is told where the program is solved, for there
/// may be others before it.
fn hopeless(
    task: &Task<'_>,
    load: &LoadAlongPath<'_>,
    watch: &dyn Watch,
) -> Result<Vec<Beyond>, RunError> {
    let sites = || of_path(task.path, load, &task.placement, spacing_mm(task));
    let every = sites().count().div_ceil(FIRST_LOOKS).max(1);
    let machines = Machines::new(task);
    let mut points = Vec::new();
    for (index, site) in sites().step_by(every).enumerate() {
        if watch.cancelled() {
            return Err(RunError::Cancelled);
        }
        let (machine, orientation) = machines.at(&site);
        let one = std::slice::from_ref(&site);
        let mut memory = Default::default();
        for found in chunk(task, machine, &mut memory, one, (orientation, false)) {
            match found {
                Ok(point) => points.push(point),
                Err(error) if index == 0 => return Err(error),
                Err(_) => {}
            }
        }
    }
    let mut beyond = judge::of_points(task, &points);
    beyond.retain(|b| {
        let of_correction = ["correction_mm", "own_weight_mm"].contains(&b.limit.name);
        of_correction && b.found > HOPELESS * b.allowed
    });
    Ok(beyond)
}

/// Whether the program keeps its tolerance as it is.
fn within_before(points: &[PointResult], tolerance_mm: f64, allowed_mm: f64) -> bool {
    let largest = |error: fn(&PointResult) -> f64| {
        judge::most(points, error).map_or(0.0, |(largest, _)| largest)
    };
    let before = largest(|p| size(&p.error_before_mm));
    let after = largest(|p| size(&p.error_after_mm));
    keeps_as_it_is(before, after, tolerance_mm, allowed_mm)
}

/// Arcs at feed.
fn feed_arcs(task: &Task<'_>) -> usize {
    let moves = task.path.moves.iter();
    moves
        .filter(|m| m.kind == MoveKind::Feed && matches!(m.curve, Curve::Arc(_)))
        .count()
}

/// The compensated program and what its own reader says of it.
fn write_and_read_again(
    task: &Task<'_>,
    field: &dyn CorrectionField,
    watch: &dyn Watch,
) -> Result<(Corrected, Verification), RunError> {
    watch.stage("corrections", 0);
    let monitor = Forward(watch);
    let written = write_corrected(task.program, task.path, field, &task.writing, &monitor)?;
    watch.stage("check of the written program", 0);
    let check = verify_written(
        task.program,
        task.path,
        &written,
        &task.reading,
        &task.writing,
    )?;
    Ok((written, check))
}

/// Where a written program is looked at.
fn sites<'s>(
    task: &'s Task<'_>,
    load: &'s LoadAlongPath<'s>,
    written: &'s Corrected,
) -> impl Iterator<Item = Site> + 's {
    of_written(task.path, written, load, &task.placement, spacing_mm(task))
}

/// Length from which on a block is looked at in more places, mm of the program.
fn spacing_mm(task: &Task<'_>) -> f64 {
    SPACING * 1e3 * natural_length(task.mechanism) / task.placement.scale
}

/// Share of the natural length after which a long piece is looked at in one more place.
const SPACING: f64 = 1.0 / 16.0;

/// What was checked of a written program besides its points.
#[derive(Clone, Debug, Default)]
struct Checked {
    /// Largest error of the speed along the part where the feed was not limited, percent.
    speed_percent: f64,
    /// Largest error on the corner steps that were not read so, if the load turns evenly there, mm.
    if_turns_mm: Option<f64>,
    /// The same, if the load follows the feed there.
    if_follows_mm: Option<f64>,
    /// What was divided again because the tool was found off.
    divided_again: Option<Warning>,
    /// The program as it is keeps the tolerance, and was left so.
    within_before: bool,
}

/// Everything that bends the machine along a program, in words: cutting load and own weight.
#[must_use]
pub fn load_in_words(mechanism: &Mechanism, load: &LoadAlongPath<'_>) -> String {
    let gravity = mechanism.gravity();
    let mass: f64 = mechanism
        .limbs()
        .iter()
        .flat_map(|l| l.actual.bodies())
        .map(|b| b.mass)
        .chain(mechanism.platforms().iter().map(|p| p.mass))
        .sum();
    if gravity.norm() > 0.0 && mass > 0.0 {
        format!(
            "{}; and the machine's own weight, {mass:.0} kg, everywhere",
            load.in_words()
        )
    } else {
        format!("{}; no weight in the model", load.in_words())
    }
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

/// Points between two looks at the watch.
pub(crate) const BATCH: usize = 4096;

/// All points in their order, and the first of a written program that is worse than before. Sites are
/// made as they are needed: a long program has many.
fn solve<S: Iterator<Item = Site>>(
    task: &Task<'_>,
    sites: impl Fn() -> S,
    written: bool,
    watch: &dyn Watch,
) -> Result<(Vec<PointResult>, Option<RunError>), RunError> {
    let total = sites().count();
    if total == 0 {
        return Err(RunError::NoMotion);
    }
    let name = if written {
        "deflections of the written program"
    } else {
        "deflections"
    };
    watch.stage(name, total);
    let mut points: Vec<PointResult> = Vec::with_capacity(total);
    let mut worse = None;
    let machines = Machines::new(task);
    let mut sites = sites();
    loop {
        let batch: Vec<Site> = sites.by_ref().take(BATCH).collect();
        if batch.is_empty() {
            return Ok((points, worse));
        }
        if watch.cancelled() {
            return Err(RunError::Cancelled);
        }
        let of_one_tool = batch.chunk_by(|a, b| machines.same(a, b));
        let solved = of_one_tool.flat_map(|run| {
            let (machine, orientation) = machines.at(&run[0]);
            in_chunks(run, |memory, sites| {
                chunk(task, machine, memory, sites, (orientation, written))
            })
        });
        for (site, point) in batch.iter().zip(solved) {
            let point = point?;
            worse = worse.or_else(|| worse_than_before(task, site, &point));
            points.push(point);
        }
        watch.advance(points.len());
    }
}

/// Points of a chunk, all at once where home leads to the same branch.
fn chunk<'m>(
    task: &Task<'m>,
    machine: &AlongPath<'m>,
    memory: &mut [Neighbour<'m>; 2],
    sites: &[Site],
    (orientation, written): (Orientation, bool),
) -> Vec<Result<PointResult, RunError>> {
    let (place, mechanism) = (&task.placement, machine.mechanism());
    let poses = |of: fn(&Site) -> &Vector3<f64>| -> Vec<Pose> {
        sites.iter().map(|s| place.tool_pose(of(s))).collect()
    };
    let wanted = poses(|s| &s.desired);
    let wrenches: Vec<Wrench> = sites.iter().map(|s| s.wrench).collect();
    let before = written.then(|| machine.rest(&wanted, &wrenches));
    let commanded = match written {
        true => poses(|s| &s.commanded),
        false => wanted.clone(),
    };
    let after = machine.judged(&commanded, &wrenches);
    let [before_memory, after_memory] = memory;
    // One after the other: each starts from its neighbour.
    let mut solved = |i: usize| -> Result<PointResult, Error> {
        let wrench = &wrenches[i];
        let before = match &before {
            None => None,
            Some(Some(found)) => Some((found.commands.row(i).collect(), found.tool_pose(i))),
            Some(None) => {
                let pose = &wanted[i];
                let (posture, tool) = before_memory.rest(mechanism, pose, wrench, orientation)?;
                Some((posture.commands(), tool))
            }
        };
        let after = match &after {
            Some(found) => Loaded::of_batch(found, i, &commanded[i]),
            None => None,
        };
        let after = match after {
            Some(after) => after,
            None => {
                let pose = &commanded[i];
                let found = after_memory.equilibrium(mechanism, pose, wrench, orientation)?;
                Loaded::of_posture(&found.0, &found.1)
            }
        };
        Ok(point(task, &sites[i], &wanted[i], before, after))
    };
    (0..sites.len())
        .map(|i| {
            solved(i).map_err(|cause| RunError::Point {
                line: sites[i].line,
                position_mm: sites[i].desired.into(),
                message: in_words(&cause),
                cause: Box::new(cause),
            })
        })
        .collect()
}

/// What is told of an equilibrium.
struct Loaded {
    tool: Pose,
    rotation: f64,
    /// Orientation of the unloaded tool.
    nominal: UnitQuaternion<f64>,
    commands: Vec<f64>,
    actuator_forces: Vec<f64>,
    stiffness_against_force: f64,
    share_to_buckling: Option<f64>,
    stable: bool,
}

impl Loaded {
    fn of_posture(posture: &Posture<'_>, equilibrium: &MechanismEquilibrium) -> Self {
        let turned = equilibrium.tool.rotation * posture.target().rotation.inverse();
        Self {
            tool: equilibrium.tool,
            rotation: turned.angle(),
            nominal: posture.target().rotation,
            commands: posture.commands(),
            actuator_forces: equilibrium.actuator_forces(),
            stiffness_against_force: equilibrium.stiffness_against_force(),
            share_to_buckling: equilibrium.share_to_buckling(),
            stable: equilibrium.stable(),
        }
    }

    fn of_batch(found: &BatchEquilibrium, i: usize, commanded: &Pose) -> Option<Self> {
        let verdict = found.verdict(i)?;
        let tool = found.tool_pose(i);
        Some(Self {
            rotation: (tool.rotation * commanded.rotation.inverse()).angle(),
            tool,
            nominal: commanded.rotation,
            commands: found.commands.row(i).collect(),
            actuator_forces: found.actuator_forces.row(i).collect(),
            stiffness_against_force: verdict.stiffness_against_force,
            share_to_buckling: verdict.share_to_buckling,
            stable: verdict.stable,
        })
    }
}

/// `before`: commands and pose of the tool without compensation, of a written program.
fn point(
    task: &Task<'_>,
    site: &Site,
    wanted: &Pose,
    before: Option<(Vec<f64>, Pose)>,
    after: Loaded,
) -> PointResult {
    let place = &task.placement;
    let off = |tool: &Pose| -> [f64; 3] {
        let shift = tool.translation.vector - wanted.translation.vector;
        place.to_program(&shift).into()
    };
    let error_after_mm = off(&after.tool);
    let (error_before_mm, actuator_correction) = match before {
        Some((nominal, tool)) => {
            let both = after.commands.iter().zip(&nominal);
            let correction = both
                .zip(kinds(task.mechanism))
                .map(|((after, before), kind)| in_display(kind) * (after - before))
                .collect();
            (off(&tool), correction)
        }
        None => (error_after_mm, vec![0.0; after.commands.len()]),
    };
    PointResult {
        line: site.line,
        output_line: site.output_line,
        end: site.end,
        kind: site.kind,
        share: site.share,
        path_mm: site.path_mm,
        start_mm: site.start_mm,
        programmed: site.programmed,
        position_mm: site.desired.into(),
        error_before_mm,
        error_after_mm,
        correction_mm: (site.commanded - site.desired).into(),
        force_n: place.to_part_axes(&site.wrench.force()).into(),
        residual_rotation_deg: after.rotation.to_degrees(),
        tool_turn_deg: place
            .orientation_follows
            .then(|| turn_deg(&wanted.rotation, &after.nominal)),
        actuator_command: after
            .commands
            .iter()
            .zip(kinds(task.mechanism))
            .map(|(command, kind)| in_display(kind) * command)
            .collect(),
        actuator_force: after.actuator_forces,
        actuator_correction,
        smallest_stiffness_n_per_mm: 1e-3 * after.stiffness_against_force,
        share_to_buckling: after.share_to_buckling.filter(|mu| mu.is_finite()),
        stable: after.stable,
    }
}

pub(crate) fn kinds(mechanism: &Mechanism) -> impl Iterator<Item = MotionKind> + '_ {
    mechanism
        .limbs()
        .iter()
        .flat_map(|l| l.nominal.actuators().iter().map(|a| a.kind))
}

/// Millimetres per metre or degrees per radian.
fn in_display(kind: MotionKind) -> f64 {
    match kind {
        MotionKind::Prismatic => 1e3,
        MotionKind::Revolute => 1_f64.to_degrees(),
    }
}

pub(crate) fn size(v: &[f64; 3]) -> f64 {
    Vector3::from(*v).norm()
}

/// No block may end farther off than without compensation, beyond tolerance and rounding.
fn worse_than_before(task: &Task<'_>, site: &Site, point: &PointResult) -> Option<RunError> {
    let decimals = i32::from(task.writing.decimals.unwrap_or(4));
    let slack =
        task.writing.tolerance_mm + task.writing.chord_tolerance_mm + 10_f64.powi(-decimals);
    let last = site.end && site.share >= 1.0;
    let (before_mm, after_mm) = (size(&point.error_before_mm), size(&point.error_after_mm));
    (last && after_mm > before_mm + slack).then_some(RunError::Worse {
        line: site.line,
        before_mm,
        after_mm,
    })
}

fn conclude(
    task: &Task<'_>,
    load: &LoadAlongPath<'_>,
    points: Vec<PointResult>,
    written: Option<Corrected>,
    checked: &Checked,
) -> Run {
    let mut question = task.question.clone();
    let mechanism = task.mechanism;
    question.load = load_in_words(mechanism, load);
    question.tolerance_mm = task.writing.tolerance_mm;
    question.chord_tolerance_mm = task.writing.chord_tolerance_mm;
    question.decimals = task.writing.decimals.unwrap_or(4);
    question.compensated = written.is_some();
    question.load_at_corners = task.load.at_corners;
    question.tools_at_corners = task
        .tools
        .iter()
        .map(|tool| ToolAtCorners {
            number: tool.number,
            load_at_corners: tool.load.at_corners,
        })
        .collect();
    question.actuators = mechanism
        .actuator_names()
        .into_iter()
        .zip(kinds(mechanism))
        .map(|(name, kind)| {
            let (motion, force) = match kind {
                MotionKind::Prismatic => ("mm", "N"),
                MotionKind::Revolute => ("deg", "N m"),
            };
            ActuatorColumn {
                name,
                motion_unit: motion.into(),
                force_unit: force.into(),
            }
        })
        .collect();
    let feed = || points.iter().filter(|p| p.kind != PointKind::Rapid);
    for k in 0..3 {
        let values = || feed().map(|p| p.position_mm[k]);
        question.box_min_mm[k] = values().fold(f64::INFINITY, f64::min);
        question.box_max_mm[k] = values().fold(f64::NEG_INFINITY, f64::max);
    }
    if feed().next().is_none() {
        (question.box_min_mm, question.box_max_mm) = ([0.0; 3], [0.0; 3]);
    }

    let summary = summarise(task, &points, written.as_ref(), checked);
    let mut warnings = of_program(
        task.path,
        written.as_ref().map(|w| w.accounting.warnings.as_slice()),
    );
    warnings.extend(checked.divided_again.clone());
    if !summary.stable {
        let first = points.iter().find(|p| !p.stable).map_or(0, |p| p.line);
        warnings.push(Warning::at_line(
            WarningCode::NotStable,
            first,
            format!("the machine is not stable under this load, first at line {first}: it would jump to another shape; do not run this program"),
        ));
    }
    if task.placement.scale != 1.0 {
        warnings.push(Warning::new(
            WarningCode::Scaled,
            format!(
                "the program is scaled by {} in the machine: corrections fit only a program of that size, and all lengths here are program millimetres",
                task.placement.scale
            ),
        ));
    }
    if written.is_none() {
        let beyond = judge::of_question(task)
            .into_iter()
            .chain(judge::of_points(task, &points));
        warnings.extend(beyond.map(|b| judge::as_warning(&b)));
    }
    warnings.extend(judge::odd(task, &points, &summary, written.is_some()));
    warnings.extend(following(task, &points, &summary));
    let near_singularity = nearest_singular(task, &points);
    if let Some(near) = &near_singularity {
        let [x, y, z] = near.position_mm;
        warnings.insert(
            0,
            Warning::at_line(
                WarningCode::NearSingular,
                near.line,
                format!("at X{x:.2} Y{y:.2} Z{z:.2} mm: {}", near.posture.in_words),
            ),
        );
    }
    let worst = worst(&points);
    let mut result = RunResult {
        schema: RESULT_SCHEMA,
        kinetostat_version: env!("CARGO_PKG_VERSION").into(),
        tolerance: ToleranceVerdict::default(),
        summary,
        question,
        worst_points: worst.iter().map(|&i| points[i].clone()).collect(),
        warnings,
        near_singularity,
        points: Vec::new(),
    };
    result.tolerance = judge::tolerance(&result, &points, written.as_ref());
    result.points = thinned(&points, &worst, RunResult::MAX_POINTS)
        .into_iter()
        .map(|i| points[i].clone())
        .collect();
    Run {
        result,
        points,
        written,
    }
}

/// What was found while a program was read, and while another was written from it: each once.
#[must_use]
pub fn of_program(path: &Path, writing: Option<&[kinetostat_program::Warning]>) -> Vec<Warning> {
    let made = |code: WarningCode| {
        move |w: &kinetostat_program::Warning| Warning::at_line(code, w.line, w.text.clone())
    };
    let mut warnings: Vec<Warning> = path
        .warnings
        .iter()
        .map(made(WarningCode::Program))
        .collect();
    warnings.extend(
        writing
            .unwrap_or_default()
            .iter()
            // The writer hands on what the reader said.
            .filter(|w| !path.warnings.contains(w))
            .map(made(WarningCode::Writing)),
    );
    warnings.dedup();
    warnings
}

/// The place nearest to a singular posture: ends of moves and places between them, evenly spread.
/// Places are compared by the tool's motion, rotations at the natural length.
fn nearest_singular(task: &Task<'_>, points: &[PointResult]) -> Option<NearSingularPlace> {
    let stride = points.len().div_ceil(RunResult::MAX_POSTURES).max(1);
    let length_mm = 1e3 * natural_length(task.mechanism);
    let orientation = Orientation {
        follows: task.placement.orientation_follows,
        load_turns: false,
    };
    let mut last: Option<Posture<'_>> = None;
    let mut found: Option<(f64, NearSingularPlace)> = None;
    for point in points.iter().step_by(stride) {
        let pose = task.placement.tool_pose(&point.position_mm.into());
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

fn summarise(
    task: &Task<'_>,
    points: &[PointResult],
    written: Option<&Corrected>,
    checked: &Checked,
) -> Summary {
    // Where nothing is cut, an error of the tool harms nothing.
    let cutting: Vec<&PointResult> = match points.iter().any(|p| p.kind != PointKind::Rapid) {
        true => points
            .iter()
            .filter(|p| p.kind != PointKind::Rapid)
            .collect(),
        false => points.iter().collect(),
    };
    // What is no number stays seen.
    let larger = |a: f64, b: f64| if b > a || b.is_nan() { b } else { a };
    let most = |f: &dyn Fn(&PointResult) -> f64| cutting.iter().map(|p| f(p)).fold(0.0, larger);
    // The mean without compensation is that of the program's own places, whether another is written or not.
    let programmed: Vec<&PointResult> = cutting.iter().filter(|p| p.programmed).copied().collect();
    let rms = |points: &[&PointResult], f: &dyn Fn(&PointResult) -> f64| {
        along_path(points, |p| f(p).powi(2)).sqrt()
    };
    let before = |p: &PointResult| size(&p.error_before_mm);
    let after = |p: &PointResult| size(&p.error_after_mm);
    let per_actuator = |f: &dyn Fn(&PointResult) -> &Vec<f64>| {
        let count = points.first().map_or(0, |p| f(p).len());
        (0..count)
            .map(|i| most(&|p: &PointResult| f(p)[i].abs()))
            .collect()
    };
    let mut summary = Summary {
        points: points.len(),
        blocks: task.program.block_count(),
        bytes_in: task.program.bytes().len(),
        feed_length_mm: task
            .path
            .moves
            .iter()
            .filter(|m| m.kind == MoveKind::Feed && m.known == kinetostat_program::Knowledge::Whole)
            .map(kinetostat_program::Move::length_mm)
            .sum(),
        max_position_error_before_mm: most(&|p| match p.kind {
            // Only a written program has steps.
            PointKind::Corner => 0.0,
            _ => before(p),
        }),
        rms_position_error_before_mm: rms(&programmed, &before),
        max_position_error_after_mm: most(&after),
        rms_position_error_after_mm: rms(&cutting, &after),
        max_correction_mm: most(&|p| size(&p.correction_mm)),
        max_residual_rotation_deg: most(&|p| p.residual_rotation_deg),
        max_speed_deviation_percent: checked.speed_percent,
        max_tool_turn_deg: points
            .iter()
            .filter_map(|p| p.tool_turn_deg.as_ref().map(size))
            .max_by(f64::total_cmp),
        smallest_stiffness_n_per_mm: cutting
            .iter()
            .map(|p| p.smallest_stiffness_n_per_mm)
            .fold(f64::INFINITY, f64::min),
        largest_share_to_buckling: cutting
            .iter()
            .filter_map(|p| p.share_to_buckling)
            .max_by(f64::total_cmp),
        largest_share_of_rating: judge::largest_share_of_rating(task, points),
        max_error_by_own_weight_mm: judge::largest_by_own_weight(task, &programmed),
        max_actuator_force: per_actuator(&|p| &p.actuator_force),
        max_actuator_correction: per_actuator(&|p| &p.actuator_correction),
        converged: true,
        stable: points.iter().all(|p| p.stable),
        ..Summary::default()
    };
    if let Some(written) = written {
        of_what_was_written(&mut summary, task, points, written, checked);
    }
    summary
}

/// Blocks, corner steps, feeds, length and time of a written program.
fn of_what_was_written(
    summary: &mut Summary,
    task: &Task<'_>,
    points: &[PointResult],
    written: &Corrected,
    checked: &Checked,
) {
    let a = &written.accounting;
    let corners = || points.iter().filter(|p| p.kind == PointKind::Corner);
    // By one reading for all steps: as it was solved where that reading was chosen, and once more elsewhere.
    let by = |reading: CornerLoad, elsewhere: Option<f64>| {
        corners()
            .filter(|p| task.load_on(p.line).at_corners == reading)
            .map(|p| size(&p.error_after_mm))
            .chain(elsewhere)
            .max_by(f64::total_cmp)
            .filter(|mm| mm.is_finite())
    };
    let turns = by(CornerLoad::Turns, checked.if_turns_mm);
    let follows = by(CornerLoad::FollowsFeed, checked.if_follows_mm);
    summary.blocks_out = a.blocks_out;
    summary.blocks_split = a.blocks_split;
    summary.blocks_unchanged = a.blocks_carried;
    summary.bytes_out = a.bytes_out;
    summary.pieces = a.pieces;
    summary.corner_steps = a.corner_steps;
    summary.largest_corner_step_mm = a.largest_corner_step_mm;
    summary.smallest_piece_mm = a.smallest_piece_mm.unwrap_or(0.0);
    summary.blocks_per_second = a.peak_blocks_per_second;
    summary.max_rounding_error_mm = a.largest_rounding_mm;
    summary.feed_arcs = feed_arcs(task);
    summary.unchanged = written.bytes == task.program.bytes();
    summary.within_tolerance_before = checked.within_before;
    summary.corner_points_percent = 100.0 * corners().count() as f64 / points.len().max(1) as f64;
    summary.max_corner_error_if_load_turns_mm = turns;
    summary.max_corner_error_if_load_follows_feed_mm = follows;
    summary.largest_backward_step_mm = a.largest_backward_mm;
    summary.backward_steps = a.backward_steps;
    summary.backward_step_limit_mm = task.writing.backward_step_mm;
    summary.max_feed_factor = task.writing.max_feed_factor;
    summary.feed_limited_pieces = a.feed_limited_pieces;
    summary.feed_limited_line = a.feed_limited_line;
    summary.slowest_limited_speed_percent = a.slowest_limited_speed.map(|share| 100.0 * share);
    summary.feed_length_before_mm = a.feed_length_in_mm;
    summary.feed_length_after_mm = a.feed_length_out_mm;
    summary.feed_time_before_s = a.feed_time_in_s;
    summary.feed_time_after_s = a.feed_time_out_s;
    summary.mean_blocks_per_second_before = a.mean_blocks_per_second_in;
    summary.mean_blocks_per_second_after = a.mean_blocks_per_second;
    summary.peak_blocks_per_second_before = a.peak_blocks_per_second_in;
    summary.peak_blocks_per_second_after = a.peak_blocks_per_second;
}

/// Mean of a value along the path that is cut, by the trapezoidal rule: a piece counts with its length, so
/// that it does not matter into how many pieces a program is divided, nor where they are looked at. What is
/// cut before the first place of a block counts with that place.
fn along_path(points: &[&PointResult], value: impl Fn(&PointResult) -> f64) -> f64 {
    let (mut sum, mut length) = (0.0, 0.0);
    let first = points.first().filter(|p| p.kind == PointKind::Feed);
    if let Some(first) = first {
        length = first.path_mm - first.start_mm;
        sum = length * value(first);
    }
    for pair in points.windows(2) {
        let [from, to] = [pair[0], pair[1]];
        // A rapid between them is no part of the way.
        let way = to.path_mm - from.path_mm.max(to.start_mm);
        if to.kind != PointKind::Feed || way <= 0.0 {
            continue;
        }
        // A block's own first place is not looked at: the load turns at a corner.
        let mean = if from.line == to.line && from.kind == PointKind::Feed {
            0.5 * (value(from) + value(to))
        } else {
            value(to)
        };
        sum += way * mean;
        length += way;
    }
    if length > 0.0 {
        return sum / length;
    }
    points.iter().map(|p| value(p)).sum::<f64>() / points.len().max(1) as f64
}

/// Indices of the worst points before compensation, at most ten, not two from one line or from
/// neighbouring ones.
fn worst(points: &[PointResult]) -> Vec<usize> {
    let programmed = |i: &usize| points[*i].kind != PointKind::Corner;
    let cutting = |i: &usize| points[*i].kind == PointKind::Feed;
    let mut order: Vec<usize> = (0..points.len()).filter(cutting).collect();
    if order.is_empty() {
        order = (0..points.len()).filter(programmed).collect();
    }
    order.sort_by(|&i, &j| {
        size(&points[j].error_before_mm)
            .total_cmp(&size(&points[i].error_before_mm))
            .then(i.cmp(&j))
    });
    let mut chosen: Vec<usize> = Vec::new();
    let reach = points.last().map_or(0.0, |p| p.path_mm) / 50.0;
    for i in order {
        let apart = chosen.iter().all(|&j| {
            points[i].line != points[j].line
                && (points[i].path_mm - points[j].path_mm).abs() > reach
        });
        if apart {
            chosen.push(i);
        }
        if chosen.len() == 10 {
            break;
        }
    }
    chosen
}
