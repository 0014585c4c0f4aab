//! The result of a run: its inputs, figures, warnings and points.

use kinetostat::number::{larger, largest, largest_length, smaller};
use kinetostat::{Directions, Mechanism, MotionKind, Posture};
use kinetostat_program::{Corrected, MachineProgram, Path};

use crate::checks::own_weight::every;
use crate::checks::refused::{as_warning, of_points, of_task};
use crate::checks::unusual::unusual;
use crate::joints::JointFigures;
use crate::load::along_path::LoadAlongPath;
use crate::load::ramp_findings::TooFast;
use crate::measured_frame::PartPlace;
use crate::near::{natural_length, near_singular};
use crate::postures::neighbour::Orientation;
use crate::result::assessment::{Assumption, AssumptionKind};
use crate::result::envelope::Envelope;
use crate::result::joints::JointsResult;
use crate::result::kept_points::KeptPoints;
use crate::result::point::{PointKind, PointResult, ProgramPlace};
use crate::result::run_result::{
    ActuatorColumn, NearSingularPlace, RESULT_SCHEMA, RunInputs, RunResult, ToolAtCorners,
};
use crate::result::summary::Summary;
use crate::run::cutting::cutting_result;
use crate::run::joints::{following, joints_result, posture_warning};
use crate::run::summary::{Checked, changes_faster_than_stated, summarise};
use crate::run::tolerance::tolerance;
use crate::run::whole_turns::whole_turns;
use crate::task::Task;
use crate::warning::{Warning, WarningCode};

/// A run's result, all its points, and the written program.
#[derive(Clone, Debug)]
pub struct Run {
    /// Summary and decimated points.
    pub result: RunResult,
    /// All points in the order of the path; `result` holds a part of them.
    pub points: Vec<PointResult>,
    /// The envelope of all points: what is drawn along the path, in constant memory.
    pub envelope: Envelope,
    /// The compensated program, checked; not yet on disk.
    pub written: Option<Corrected>,
    /// Some of the places on cutting moves, as many as the task asks for: for other machines to be solved there.
    pub places: Vec<ProgramPlace>,
}

/// Everything that bends the machine along a program, in words: cutting load and own weight.
#[must_use]
pub fn load_description(mechanism: &Mechanism, load: &LoadAlongPath<'_>) -> String {
    let gravity = mechanism.gravity();
    let mass = mechanism.moving_mass();
    if gravity.norm() > 0.0 && mass > 0.0 {
        format!(
            "{}; and the machine's own weight, {mass:.0} kg, everywhere",
            load.description()
        )
    } else {
        format!("{}; no weight in the model", load.description())
    }
}

/// The result of a run. The tolerance is compared last: it needs the figures and the inputs that the result states.
pub(crate) fn conclude(
    task: &Task<'_>,
    load: &LoadAlongPath<'_>,
    points: Vec<PointResult>,
    written: Option<Corrected>,
    checked: &Checked,
) -> Run {
    let summary = summarise(task, &points, written.as_ref(), checked);
    let near_singularity = nearest_singular(task, &points);
    let joints = joints_result(task, &points);
    let mut warnings = warnings(task, load, &points, &summary, written.as_ref(), checked);
    warnings.splice(0..0, posture_warning(task, &points, &joints));
    // Said first: near a singular posture every other figure is larger than elsewhere.
    if let Some(near) = &near_singularity {
        warnings.insert(0, near_singular_warning(near));
    }
    let mut result = RunResult {
        schema: RESULT_SCHEMA,
        kinetostat_version: env!("CARGO_PKG_VERSION").into(),
        summary,
        cutting: task.cut.map(|forces| cutting_result(forces, task.path())),
        force_band: checked.force_band.clone(),
        run_inputs: run_inputs_of(task, load, &points, written.is_some()),
        warnings,
        near_singularity,
        ..RunResult::default()
    };
    result.tolerance = tolerance(
        &result,
        &points,
        written.as_ref(),
        &checked.ramps.too_fast,
        task.path(),
    );
    let mut run = Run {
        result,
        points,
        envelope: Envelope::default(),
        written,
        places: checked.places.clone(),
    };
    run.keep(task, joints);
    let result = &mut run.result;
    result.assess();
    if let Some(line) = task.path().units_assumed_on {
        let text = format!(
            "The program states no unit (G20 or G21): its lengths are taken for millimetres, the first on line {line}."
        );
        result.assume(Assumption::new(AssumptionKind::Units, None, text));
    }
    let calls = task.path().outside_calls.iter();
    let calls: Vec<(String, usize)> = calls.map(|(n, line)| (format!("O{n}"), *line)).collect();
    if let Some(assumed) = Assumption::of_calls(&calls) {
        result.assume(assumed);
    }
    if let Some(line) = task.path().unjudged_feed_on {
        let text = format!(
            "Feeds whose start or way is not known, the first on line {line}, cut nothing that counts: no error is computed along them. In G-code the places of the machine say where they start (--machine-zero-mm)."
        );
        result.assume(Assumption {
            is_critical: true,
            ..Assumption::new(AssumptionKind::UnjudgedFeeds, None, text)
        });
    }
    run
}

impl Run {
    /// Takes turning joints of a part on from their values at the point before it, as those of a whole program go on; says
    /// whether one changed.
    pub(crate) fn go_on_from(&mut self, task: &Task<'_>, before: &[f64]) -> bool {
        let figures = JointFigures::new(task.mechanism, &task.bounds.ratings);
        let mut before = before.to_vec();
        for (index, point) in self.points.iter_mut().enumerate() {
            let own = point.actuator_command.clone();
            figures.unwind(&before, point);
            // All that follow are next to the first.
            if index == 0 && own == point.actuator_command {
                return false;
            }
            figures.fill(point);
            before.clone_from(&point.actuator_command);
        }
        let joints = joints_result(task, &self.points);
        self.keep(task, joints);
        !self.points.is_empty()
    }

    /// States what rests on the joint values of the points, and keeps points of a long path.
    fn keep(&mut self, task: &Task<'_>, joints: JointsResult) {
        let (mut envelope, mut kept) =
            (Envelope::default(), KeptPoints::new(RunResult::MAX_POINTS));
        envelope.extend(&self.points);
        kept.extend(&self.points);
        self.envelope = envelope;
        let result = &mut self.result;
        result.joints = joints;
        result.worst_points = kept.worst_before();
        if self.written.is_some() {
            result.worst_points_after = kept.worst_after();
        }
        result.points = kept.points();
        let first = [WarningCode::NearSingular, WarningCode::PostureChanges];
        let warnings = &mut result.warnings;
        warnings.retain(|w| w.code != WarningCode::JointTurnsOn);
        let at = warnings
            .iter()
            .take_while(|w| first.contains(&w.code))
            .count();
        warnings.splice(at..at, whole_turns(task, &self.points));
    }
}

/// The inputs as the result repeats them: what the task states, with the load in words and the box of the feed path.
fn run_inputs_of(
    task: &Task<'_>,
    load: &LoadAlongPath<'_>,
    points: &[PointResult],
    compensated: bool,
) -> RunInputs {
    let (box_min_mm, box_max_mm) = feed_box(points);
    let tools = task.tools.iter();
    let corners_stated = match task.tools {
        [] => task.load.corners_stated,
        tools => tools.iter().all(|tool| tool.load.corners_stated),
    };
    RunInputs {
        load: load_description(task.mechanism, load),
        weight: task.weight.clone(),
        tolerance_mm: task.writing.tolerance_mm,
        chord_tolerance_mm: task.writing.chord_tolerance_mm,
        decimals: task.writing.decimals.unwrap_or(4),
        compensated,
        states_orientation: task.path().moves.iter().any(|m| m.tool_turn.is_some()),
        orientation_corrected: compensated && task.corrected == Directions::ALL,
        load_at_corners: task.load.at_corners,
        corners_stated,
        tools_at_corners: tools
            .map(|tool| ToolAtCorners {
                number: tool.number,
                load_at_corners: tool.load.at_corners,
            })
            .collect(),
        actuators: actuator_columns(task),
        has_configuration: points.iter().any(|p| p.configuration.is_some()),
        box_min_mm,
        box_max_mm,
        ..task.run_inputs.clone()
    }
}

/// Names, units, limits and ratings of the actuators.
fn actuator_columns(task: &Task<'_>) -> Vec<ActuatorColumn> {
    let figures = JointFigures::new(task.mechanism, &task.bounds.ratings);
    let names = task.mechanism.actuator_names().into_iter();
    let ratings = task.bounds.ratings.iter().copied();
    names
        .zip(figures.kinds().zip(figures.limits()))
        .zip(ratings.chain(std::iter::repeat(None)))
        .map(|((name, (kind, limits)), rating)| {
            let (motion, force) = match kind {
                MotionKind::Prismatic => ("mm", "N"),
                MotionKind::Revolute => ("deg", "N m"),
            };
            ActuatorColumn {
                name,
                motion_unit: motion.into(),
                force_unit: force.into(),
                limits,
                rating,
            }
        })
        .collect()
}

/// Lower and upper corner of the places that are cut, program coordinates, mm; zero where nothing is cut.
fn feed_box(points: &[PointResult]) -> ([f64; 3], [f64; 3]) {
    let feed = || points.iter().filter(|p| p.kind != PointKind::Rapid);
    if feed().next().is_none() {
        return ([0.0; 3], [0.0; 3]);
    }
    let values = |k: usize| feed().map(move |p| p.position_mm[k]);
    let lower = [0, 1, 2].map(|k| values(k).fold(f64::INFINITY, smaller));
    let upper = [0, 1, 2].map(|k| values(k).fold(f64::NEG_INFINITY, larger));
    (lower, upper)
}

/// Everything to warn of but a singular posture. A program that is only analysed is warned of what would refuse a
/// compensated one.
fn warnings(
    task: &Task<'_>,
    load: &LoadAlongPath<'_>,
    points: &[PointResult],
    summary: &Summary,
    written: Option<&Corrected>,
    checked: &Checked,
) -> Vec<Warning> {
    let of_writer = written.map(|w| w.accounting.warnings.as_slice());
    let mut warnings = of_program(task.path(), of_writer);
    warnings.extend(checked.divided_again.clone());
    warnings.extend(changes_fast(task, checked));
    warnings.extend(changes_faster_than_stated(task, load, points, checked));
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
        warnings.extend(marked_as_compensated(task.program));
        let beyond = of_task(task).into_iter().chain(of_points(task, points));
        warnings.extend(beyond.map(|b| as_warning(&b)));
    }
    warnings.extend(unusual(task, points, summary, written.is_some()));
    warnings.extend(following(task, points, summary));
    warnings
}

fn near_singular_warning(near: &NearSingularPlace) -> Warning {
    let [x, y, z] = near.position_mm;
    Warning::at_line(
        WarningCode::NearSingular,
        near.line,
        format!("at X{x:.2} Y{y:.2} Z{z:.2} mm: {}", near.posture.in_words),
    )
}

/// Warnings of reading a program, and of writing another from it: each once.
#[must_use]
pub fn of_program(path: &Path, writing: Option<&[kinetostat_program::Warning]>) -> Vec<Warning> {
    let reading = path.warnings.iter();
    let reading = reading.map(|w| Warning::of_program(WarningCode::Program, w));
    let mut warnings: Vec<Warning> = reading.collect();
    warnings.extend(
        writing
            .unwrap_or_default()
            .iter()
            // The writer hands on what the reader said.
            .filter(|w| !path.warnings.contains(w))
            .map(|w| Warning::of_program(WarningCode::Writing, w)),
    );
    warnings.dedup();
    warnings
}

/// A program with corrections, to a question about the program as it was drawn.
#[must_use]
pub fn marked_as_compensated(program: &dyn MachineProgram) -> Option<Warning> {
    let line = program.mark_line()?;
    let text = "the program is marked as compensated: every figure here is that of its corrected path, on which the corrections count as if they were drawn; take the original program".to_owned();
    Some(Warning::at_line(WarningCode::Program, line, text))
}

/// Warning of a force that changes faster in a cut than the correction may, if that matters for the tolerance.
fn changes_fast(task: &Task<'_>, checked: &Checked) -> Option<Warning> {
    let matters = |found: &&TooFast| found.matters(task.writing.tolerance_mm);
    let all = || checked.ramps.too_fast.iter().filter(matters);
    let found = all().max_by(|a, b| a.off_mm.total_cmp(&b.off_mm))?;
    let more = match all().count() {
        1 => String::new(),
        n => format!(" (the worst of {n} lines)"),
    };
    let text = format!(
        "the force changes here by {} N more than the correction can follow with {} mm per mm of path (largest_step_mm_per_mm): up to about {} are left{more}; a softer entry into the cut, or a larger step, leaves less",
        largest(found.force_n, ""),
        task.load_on(found.line).largest_step,
        largest_length(found.off_mm)
    );
    let code = WarningCode::ForceChangesFast;
    Some(Warning::at_line(code, found.line, text))
}

/// The place nearest to a singular posture: ends of moves and places between them, evenly spread.
/// Places are compared by the tool's motion, rotations at the natural length.
fn nearest_singular(task: &Task<'_>, points: &[PointResult]) -> Option<NearSingularPlace> {
    let length_mm = 1e3 * natural_length(task.mechanism);
    let orientation = Orientation {
        follows: task.placement.orientation_follows,
        load_turns: false,
    };
    let mut last: Option<Posture> = None;
    let mut found: Option<(f64, NearSingularPlace)> = None;
    for point in points.iter().step_by(every(task, points.len())) {
        let pose = PartPlace::of_point(task, point).pose();
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
