//! A run over a program: deflections along it, the compensated program, and the proof from the
//! written bytes.

use kinetostat::{Error, Mechanism, MotionKind, Posture};
use kinetostat_program::{
    Corrected, Monitor, MoveKind, Path, Program, ReadOptions, WriteError, WriteOptions,
    verify_written, write_corrected,
};
use nalgebra::Vector3;

use crate::field::{ModelField, in_words};
use crate::load::{LoadAlongPath, ProgramLoad};
use crate::near::{natural_length, near_singular};
use crate::placement::Placement;
use crate::result::{
    ActuatorColumn, NearSingularPlace, PointKind, PointResult, Question, RESULT_SCHEMA, RunResult,
    Summary,
};
use crate::sites::{Site, of_path, of_written};
use crate::solve::in_chunks;

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
    /// How the compensated program is written.
    pub writing: WriteOptions,
    /// Names and words for the result; figures are filled in by the run.
    pub question: Question,
}

/// Who watches a run and may stop it.
pub trait Watch: Sync {
    /// A stage begins; `total` points.
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
        "line {line}: compensated, this block would end {after_mm:.6} mm off, more than the {before_mm:.6} mm without compensation; nothing was written. Tighten the path tolerance, allow more decimals, or report this with the job"
    )]
    Worse {
        /// Line of the program, from 1.
        line: usize,
        /// Error without compensation, mm.
        before_mm: f64,
        /// Error with it, mm.
        after_mm: f64,
    },
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
    /// The program has no move whose place is known.
    #[error(
        "the program has no motion whose place is known: state X, Y and Z before the first cut, or give the start position"
    )]
    NoMotion,
    /// Stopped on request.
    #[error("stopped on request; nothing was written")]
    Cancelled,
}

impl RunError {
    /// Wrong input (exit code 1) or a question that has no answer (2).
    #[must_use]
    pub fn is_unanswered(&self) -> bool {
        match self {
            Self::Point { cause, .. } => cause.is_unanswered(),
            Self::Write(WriteError::Field { .. }) | Self::Worse { .. } | Self::Unstable { .. } => {
                true
            }
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
    let load = LoadAlongPath::new(task.load, task.path);
    let sites = of_path(
        task.path,
        &load,
        &task.placement,
        20.0 * task.writing.chord_tolerance_mm,
    );
    let points = solve(task, &sites, false, watch)?;
    Ok(conclude(task, &load, &sites, points, None, 0.0))
}

/// The compensated program, with deflections solved again from its bytes.
///
/// # Errors
/// [`RunError`] naming the line; nothing is to be written then.
pub fn compensate_program(task: &Task<'_>, watch: &dyn Watch) -> Result<Run, RunError> {
    let load = LoadAlongPath::new(task.load, task.path);
    let field = ModelField {
        mechanism: task.mechanism,
        placement: task.placement,
        load: &load,
    };
    watch.stage("corrections", 0);
    let written = write_corrected(
        task.program,
        task.path,
        &field,
        &task.writing,
        &Forward(watch),
    )?;
    watch.stage("check of the written program", 0);
    let check = verify_written(
        task.program,
        task.path,
        &written,
        &task.reading,
        &task.writing,
    )?;
    let sites = of_written(task.path, &written, &load, &task.placement);
    let points = solve(task, &sites, true, watch)?;
    if let Some(point) = points.iter().find(|p| !p.stable) {
        return Err(RunError::Unstable {
            line: point.line,
            position_mm: point.position_mm,
        });
    }
    refuse_worse(task, &sites, &points)?;
    let speed = 100.0 * check.largest_speed_error;
    Ok(conclude(task, &load, &sites, points, Some(written), speed))
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
    fn progress(&self, done: usize, total: usize) {
        self.0.stage("corrections", total);
        self.0.advance(done);
    }
    fn cancelled(&self) -> bool {
        self.0.cancelled()
    }
}

/// Points between two looks at the watch.
const BATCH: usize = 4096;

fn solve(
    task: &Task<'_>,
    sites: &[Site],
    written: bool,
    watch: &dyn Watch,
) -> Result<Vec<PointResult>, RunError> {
    if sites.is_empty() {
        return Err(RunError::NoMotion);
    }
    let name = if written {
        "deflections of the written program"
    } else {
        "deflections"
    };
    watch.stage(name, sites.len());
    let mut points = Vec::with_capacity(sites.len());
    for batch in sites.chunks(BATCH) {
        if watch.cancelled() {
            return Err(RunError::Cancelled);
        }
        for point in in_chunks(batch, |memory, site| point(task, memory, site, written)) {
            points.push(point?);
        }
        watch.advance(points.len());
    }
    Ok(points)
}

fn point<'m>(
    task: &Task<'m>,
    memory: &mut [crate::solve::Neighbour<'m>; 2],
    site: &Site,
    written: bool,
) -> Result<PointResult, RunError> {
    let fail = |cause: Error| RunError::Point {
        line: site.line,
        position_mm: site.desired.into(),
        message: in_words(&cause),
        cause: Box::new(cause),
    };
    let place = &task.placement;
    let [before_memory, after_memory] = memory;
    let wanted = place.tool_pose(&site.desired);
    let off = |tool: &kinetostat::Pose| -> [f64; 3] {
        place
            .to_program(&(tool.translation.vector - wanted.translation.vector))
            .into()
    };
    let mut result = PointResult {
        line: site.line,
        output_line: site.output_line,
        kind: site.kind,
        share: site.share,
        path_mm: site.path_mm,
        position_mm: site.desired.into(),
        correction_mm: (site.commanded - site.desired).into(),
        force_n: place.to_part_axes(&site.wrench.force()).into(),
        ..PointResult::default()
    };
    let (posture, equilibrium) = if written {
        let (nominal, tool) = before_memory
            .rest(task.mechanism, &wanted, &site.wrench)
            .map_err(fail)?;
        result.error_before_mm = off(&tool);
        let commanded = place.tool_pose(&site.commanded);
        let answer = after_memory
            .equilibrium(task.mechanism, &commanded, &site.wrench)
            .map_err(fail)?;
        result.actuator_correction = answer
            .0
            .commands()
            .iter()
            .zip(nominal.commands())
            .zip(kinds(task.mechanism))
            .map(|((after, before), kind)| in_display(kind) * (after - before))
            .collect();
        result.error_after_mm = off(&answer.1.tool);
        answer
    } else {
        let answer = before_memory
            .equilibrium(task.mechanism, &wanted, &site.wrench)
            .map_err(fail)?;
        result.error_before_mm = off(&answer.1.tool);
        result.error_after_mm = result.error_before_mm;
        result.actuator_correction = vec![0.0; answer.0.commands().len()];
        answer
    };
    let turned = equilibrium.tool.rotation * posture.target().rotation.inverse();
    result.residual_rotation_deg = turned.angle().to_degrees();
    result.actuator_force = equilibrium.actuator_forces();
    result.smallest_stiffness_n_per_mm = 1e-3 * equilibrium.stiffness_against_force();
    result.buckling_margin = equilibrium.margin().filter(|mu| mu.is_finite());
    result.stable = equilibrium.stable();
    Ok(result)
}

fn kinds(mechanism: &Mechanism) -> impl Iterator<Item = MotionKind> + '_ {
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

fn size(v: &[f64; 3]) -> f64 {
    Vector3::from(*v).norm()
}

/// No block may end farther off than without compensation, beyond tolerance and rounding.
fn refuse_worse(task: &Task<'_>, sites: &[Site], points: &[PointResult]) -> Result<(), RunError> {
    let decimals = i32::from(task.writing.decimals.unwrap_or(4));
    let slack =
        task.writing.tolerance_mm + task.writing.chord_tolerance_mm + 10_f64.powi(-decimals);
    for (site, point) in sites.iter().zip(points) {
        let last = site.end && site.share >= 1.0;
        let (before_mm, after_mm) = (size(&point.error_before_mm), size(&point.error_after_mm));
        if last && after_mm > before_mm + slack {
            return Err(RunError::Worse {
                line: site.line,
                before_mm,
                after_mm,
            });
        }
    }
    Ok(())
}

fn conclude(
    task: &Task<'_>,
    load: &LoadAlongPath<'_>,
    sites: &[Site],
    points: Vec<PointResult>,
    written: Option<Corrected>,
    speed_percent: f64,
) -> Run {
    let mut question = task.question.clone();
    let mechanism = task.mechanism;
    question.load = load_in_words(mechanism, load);
    question.tolerance_mm = task.writing.tolerance_mm;
    question.chord_tolerance_mm = task.writing.chord_tolerance_mm;
    question.decimals = task.writing.decimals.unwrap_or(4);
    question.compensated = written.is_some();
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
    let feed: Vec<&Site> = sites
        .iter()
        .filter(|s| s.kind != PointKind::Rapid)
        .collect();
    for k in 0..3 {
        let values = || feed.iter().map(|s| s.desired[k]);
        question.box_min_mm[k] = values().fold(f64::INFINITY, f64::min);
        question.box_max_mm[k] = values().fold(f64::NEG_INFINITY, f64::max);
    }
    if feed.is_empty() {
        (question.box_min_mm, question.box_max_mm) = ([0.0; 3], [0.0; 3]);
    }

    let summary = summarise(task, &points, written.as_ref(), speed_percent);
    let mut warnings: Vec<String> = task
        .path
        .warnings
        .iter()
        .chain(written.iter().flat_map(|w| &w.accounting.warnings))
        .map(|w| format!("line {}: {}", w.line, w.text))
        .collect();
    warnings.dedup();
    if !summary.stable {
        let first = points.iter().find(|p| !p.stable).map_or(0, |p| p.line);
        warnings.push(format!(
            "the machine is not stable under this load, first at line {first}: it would jump to another shape; do not run this program"
        ));
    }
    if task.placement.scale != 1.0 {
        warnings.push(format!(
            "the program is scaled by {} in the machine: corrections fit only a program of that size, and all lengths here are program millimetres",
            task.placement.scale
        ));
    }
    let near_singularity = nearest_singular(task, sites);
    if let Some(near) = &near_singularity {
        let [x, y, z] = near.position_mm;
        warnings.insert(
            0,
            format!(
                "line {}, at X{x:.2} Y{y:.2} Z{z:.2} mm: {}",
                near.line, near.posture.in_words
            ),
        );
    }
    let worst = worst(&points);
    let mut result = RunResult {
        schema: RESULT_SCHEMA,
        kinetostat_version: env!("CARGO_PKG_VERSION").into(),
        summary,
        question,
        worst_points: worst.iter().map(|&i| points[i].clone()).collect(),
        warnings,
        near_singularity,
        points: Vec::new(),
    };
    let stride = points
        .len()
        .div_ceil(RunResult::MAX_POINTS - worst.len())
        .max(1);
    result.points = points
        .iter()
        .enumerate()
        .filter(|(i, _)| i % stride == 0 || i + 1 == points.len() || worst.contains(i))
        .map(|(_, p)| p.clone())
        .collect();
    Run {
        result,
        points,
        written,
    }
}

/// The place nearest to a singular posture: ends of moves and places between them, evenly spread.
/// Places are compared by the tool's motion, rotations at the natural length.
fn nearest_singular(task: &Task<'_>, sites: &[Site]) -> Option<NearSingularPlace> {
    let stride = sites.len().div_ceil(RunResult::MAX_POSTURES).max(1);
    let length_mm = 1e3 * natural_length(task.mechanism);
    let mut last: Option<Posture<'_>> = None;
    let mut found: Option<(f64, NearSingularPlace)> = None;
    for site in sites.iter().step_by(stride) {
        let pose = task.placement.tool_pose(&site.desired);
        let posture = match &last {
            Some(near) => task.mechanism.posture_near(&pose, near),
            None => task.mechanism.posture(&pose),
        };
        let Ok(posture) = posture else { continue };
        if let Some(near) = near_singular(&posture) {
            let far = near
                .distance_mm
                .max(near.rotation_deg.to_radians() * length_mm);
            if found.as_ref().is_none_or(|(least, _)| far < *least) {
                found = Some((
                    far,
                    NearSingularPlace {
                        line: site.line,
                        position_mm: site.desired.into(),
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
    speed_percent: f64,
) -> Summary {
    let most = |f: &dyn Fn(&PointResult) -> f64| points.iter().map(f).fold(0.0, f64::max);
    let rms = |f: &dyn Fn(&PointResult) -> f64| {
        (points.iter().map(|p| f(p).powi(2)).sum::<f64>() / points.len().max(1) as f64).sqrt()
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
        max_position_error_before_mm: most(&before),
        rms_position_error_before_mm: rms(&before),
        max_position_error_after_mm: most(&after),
        rms_position_error_after_mm: rms(&after),
        max_correction_mm: most(&|p| size(&p.correction_mm)),
        max_residual_rotation_deg: most(&|p| p.residual_rotation_deg),
        max_speed_deviation_percent: speed_percent,
        smallest_stiffness_n_per_mm: points
            .iter()
            .map(|p| p.smallest_stiffness_n_per_mm)
            .fold(f64::INFINITY, f64::min),
        largest_buckling_margin: points
            .iter()
            .filter_map(|p| p.buckling_margin)
            .max_by(f64::total_cmp),
        max_actuator_force: per_actuator(&|p| &p.actuator_force),
        max_actuator_correction: per_actuator(&|p| &p.actuator_correction),
        converged: true,
        stable: points.iter().all(|p| p.stable),
        ..Summary::default()
    };
    if let Some(written) = written {
        let a = &written.accounting;
        summary.blocks_out = a.blocks_out;
        summary.blocks_split = a.blocks_split;
        summary.blocks_unchanged = a.blocks_carried;
        summary.bytes_out = a.bytes_out;
        summary.pieces = a.pieces;
        summary.corner_steps = a.corner_steps;
        summary.largest_corner_step_mm = a.largest_corner_step_mm;
        summary.smallest_piece_mm = a.smallest_piece_mm.unwrap_or(0.0);
        summary.blocks_per_second = a.peak_blocks_per_second.unwrap_or(0.0);
        summary.max_rounding_error_mm = a.largest_rounding_mm;
    }
    summary
}

/// Indices of the worst points before compensation, at most ten, not two from one line or from
/// neighbouring ones.
fn worst(points: &[PointResult]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..points.len()).collect();
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
