//! The machine solved along a program, from the job to the run: shared by `compensate`, `deflect` and `demo`.

use kinetostat::Pose;
use kinetostat::number::{larger, smaller};
use kinetostat_diagnostic::ErrorCode;
use kinetostat_machining::number::{largest, length_setting, setting as setting_of};
use kinetostat_machining::{
    Bounds, CuttingLoad, ForceAlongPath, LoadAlongPath, MeasuredReport, ProgramLoad, Run, RunError,
    Task, Tool, Warning, WarningCode, Watch, analyse, compensate_program, load_description,
    origin_in_metres,
};
use kinetostat_model::Model;
use kinetostat_program::{MachineProgram, Path as ToolPath, WriteError, WriteOptions};

use crate::job::cut::along::{forces, measured, refuse_what_breaks_the_tool, warnings};
use crate::job::free_turn::{FreeTurn, chosen, only_tool};
use crate::job::machine::MachineSetup;
use crate::job::over_part::{is_of_positions, tool_over_part};
use crate::job::program::{ReadProgram, read_program};
use crate::job::robot::configuration::other_configuration;
use crate::job::robot::first_place::of_first_place;
use crate::job::robot::joint_arm::ArmOfTable;
use crate::job::robot::read_program::RobotRead;
use crate::job::setting::Setting;
use crate::job::turn_arguments::FreeTurnWord;
use crate::machine::model_warnings::with_model_warning;
use crate::program::aim::Aim;
use crate::program::chatter::{Judging, put_chatter, refused};
use crate::program::features::put_features;
use crate::program::flat_lines::of_warnings;
use crate::program::uncertainty::{self, PLACES, put_band};
use crate::ui::failure::{Answer, Failing, Failure};
use crate::ui::progress::Progress;
use crate::ui::threads::in_threads;

/// The tools of a job, where it names several.
fn tools<'m>(machine: &'m MachineSetup, forces: Option<&ForceAlongPath>) -> Vec<Tool<'m>> {
    machine
        .tools
        .iter()
        .map(|(number, mechanism, load)| Tool {
            number: *number,
            mechanism,
            load: computed(*load, forces),
        })
        .collect()
}

/// A load, or that of the cut.
pub(crate) fn computed(load: ProgramLoad, forces: Option<&ForceAlongPath>) -> ProgramLoad {
    let cutting = forces.map(|forces| CuttingLoad::FromCut {
        origin: forces.origin(),
        largest: forces.largest(),
    });
    ProgramLoad {
        cutting: cutting.unwrap_or(load.cutting),
        ..load
    }
}

/// The forces along the program of a job that has them measured, or computed from its cuts.
pub(crate) fn forces_of(
    machine: &MachineSetup,
    setting: &Setting,
    path: &ToolPath,
    watch: &dyn Watch,
) -> Answer<Option<ForceAlongPath>> {
    if let Some(forces) = &setting.forces {
        return Ok(Some(forces.clone()));
    }
    if setting.robot.is_some() && (machine.measured.is_some() || machine.cut.is_some()) {
        return Err(ErrorCode::ProgramUnsuited.failure("forces that are computed from the cut or measured are for programs in G-code, whose tool keeps its axis: compensate the G-code with --to krl, rapid or ls, or state the force of a robot's program under [load]",
        ));
    }
    let turned = path.moves.iter().find(|motion| motion.tool_turn.is_some());
    if let Some(motion) = turned.filter(|_| machine.measured.is_some() || machine.cut.is_some()) {
        return Err(setting.within(ErrorCode::ProgramUnsuited.failure(format!(
            "line {}: rotary axes turn the tool in the part: forces that are computed from the cut or measured are for programs whose tool keeps its axis; state the force under [load]",
            motion.line
        ))));
    }
    match &machine.measured {
        Some(setup) => measured(setup, setting, path, watch).map(Some),
        None => forces(machine.cut.as_ref(), setting, path, watch),
    }
}

/// Smallest tolerance that can be stated, mm.
const SMALLEST_MM: f64 = 1e-6;

/// Shares what is asked for in all out among straight pieces, chords of arcs (where there are some) and rounding. Where rounding
/// takes nearly all of it, a fifth is left for the pieces, and the verdict says what comes of it.
fn share_out(writing: &mut WriteOptions, asked_mm: f64, rounding_mm: f64, path: &ToolPath) {
    let chords_mm = smaller(writing.chord_tolerance_mm, 0.4 * asked_mm);
    writing.chord_tolerance_mm = larger(chords_mm, SMALLEST_MM);
    let chords_mm = match kinetostat_machining::feed_arcs(path) {
        0 => 0.0,
        _ => writing.chord_tolerance_mm,
    };
    let left_mm = larger(asked_mm - rounding_mm - chords_mm, 0.2 * asked_mm);
    writing.tolerance_mm = larger(left_mm, SMALLEST_MM);
}

/// Places of a program that its report shows, about.
const SHOWN: usize = 400;

/// Applies `work` to the task of a run over a program that was read.
pub(crate) fn with_task<R>(
    aim: Aim,
    machine: &MachineSetup,
    setting: &Setting,
    read: &ReadProgram<'_>,
    forces: Option<&ForceAlongPath>,
    work: impl FnOnce(&Task<'_>) -> R,
) -> Answer<R> {
    let path = read.path();
    let tools = tools(machine, forces);
    let load = computed(machine.load, forces);
    let mut run_inputs = machine.run_inputs.clone();
    run_inputs.program.clone_from(&setting.program_name);
    run_inputs.flat.clone_from(&setting.flat);
    run_inputs
        .files
        .splice(..0, setting.program_files.iter().cloned());
    run_inputs.files.extend(setting.job_file.clone());
    run_inputs.date = crate::files::origin::day();
    let report = forces.and_then(|forces| forces.measured.as_ref());
    run_inputs
        .cut
        .extend(report.into_iter().flat_map(MeasuredReport::sentences));
    let mut writing = setting.writing.clone();
    run_inputs.tolerance_from = "as stated".to_owned();
    if aim == Aim::Compensate {
        let (usual_mm, from) = &machine.usual_tolerance;
        // The tolerance is a length of the machine; the program may be scaled.
        let usual_mm = usual_mm / machine.placement.scale;
        let [path_stated, chord_stated] = setting.stated;
        if !path_stated {
            // The bounds of a tolerance; of a program without a scale no machine is outside.
            if !(1e-6..=10.0).contains(&usual_mm) {
                return Err(ErrorCode::Value.failure(format!(
                        "the scale {}: with it the machine's tolerance of {} is {} of the program, where 0.000001 to 10 mm are allowed; correct the scale (--scale, or scale under [placement] in the job), or state the tolerance (--tolerance-um, or path_um under [tolerances])",
                        setting_of(machine.placement.scale),
                        length_setting(machine.usual_tolerance.0),
                        length_setting(usual_mm)
                    ),
                ));
            }
            writing.tolerance_mm = usual_mm;
            run_inputs.tolerance_from.clone_from(from);
        }
        if !chord_stated {
            // Never finer than the program of a machine that is not known.
            let in_proportion = 0.8 * usual_mm.min(writing.tolerance_mm);
            writing.chord_tolerance_mm = larger(writing.chord_tolerance_mm, in_proportion);
        }
        if let Some(asked_mm) = setting.asked_mm {
            share_out(&mut writing, asked_mm, setting.rounding_mm(path), path);
            run_inputs.asked_mm = Some(asked_mm);
            run_inputs.tolerance_from = format!(
                "what {} in all leaves beside chords and rounding",
                length_setting(asked_mm)
            );
        }
    }
    if let Some(header) = &mut writing.header {
        *header = vec![
            format!("version {}", env!("CARGO_PKG_VERSION")),
            format!(
                "model {} ({}), fingerprint {:016x}",
                run_inputs.model, run_inputs.model_source, machine.fingerprint
            ),
            format!(
                "load {}",
                load_description(
                    &machine.mechanism,
                    &LoadAlongPath::with_tools(load, path, &tools)
                )
            ),
            format!("tool {}", run_inputs.tool),
            format!("placement {}", run_inputs.placement),
        ];
    }
    let made = |program: &dyn MachineProgram| {
        work(&Task {
            mechanism: &machine.mechanism,
            program,
            corrected: read.corrected(),
            placement: machine.placement,
            load,
            tools: &tools,
            weight: machine.weight.clone(),
            cut: forces,
            writing,
            run_inputs,
            bounds: Bounds {
                limits: setting.limits,
                widest_zone: read.robot().and_then(RobotRead::widest_zone),
                ..machine.bounds.clone()
            },
            places: match setting.uncertain.is_some() || setting.targets.vtk.is_some() {
                true => PLACES,
                false => setting.places,
            },
            compliances: setting.targets.vtk.is_some(),
        })
    };
    Ok(read.with(made))
}

/// The turn of a round tool along the program, where it is to be chosen.
pub(crate) fn turn(machine: &MachineSetup, setting: &Setting) -> Answer<Option<FreeTurn>> {
    if setting.free_turn == FreeTurnWord::AsStated {
        return Ok(None);
    }
    let read = read_program(setting)?;
    let number = only_tool(setting, read.path())?;
    let numbered = machine.tools.iter().find(|tool| number == Some(tool.0));
    let mechanism = numbered.map_or(&machine.mechanism, |(_, with_tool, _)| with_tool);
    chosen(setting, mechanism, read.path(), machine.placement).map(Some)
}

/// Solves the machine, with the model that it is made from, along the program.
pub(crate) fn solve(
    aim: Aim,
    machine: &MachineSetup,
    model: &Model,
    setting: &Setting,
    threads: Option<usize>,
) -> Answer<Run> {
    turned(aim, machine, model, setting, None, threads)
}

/// Solves the machine along the program, with the turn of its tool that was chosen.
pub(crate) fn turned(
    aim: Aim,
    machine: &MachineSetup,
    model: &Model,
    setting: &Setting,
    turn: Option<&FreeTurn>,
    threads: Option<usize>,
) -> Answer<Run> {
    let mut read = read_program(setting)?;
    if let Some(turn) = turn {
        if machine.measured.is_some() || machine.cut.is_some() {
            return Err(ErrorCode::ProgramUnsuited.failure("forces that are computed from the cut or measured are for programs whose tool keeps its orientation: leave --free-turn out, or state the force under [load]",
            ));
        }
        read.go_along(turn.path.clone());
    }
    let path = read.path();
    let stands = tool_over_part(machine, is_of_positions(path));
    let stands = stands.map_err(|failure| setting.within(failure))?;
    let progress = Progress::new();
    let forces = forces_of(machine, setting, path, &progress)?;
    if aim == Aim::Compensate {
        refuse_what_breaks_the_tool(forces.as_ref(), setting)?;
    }
    let uncertain = setting.uncertain.as_ref();
    let uncertain = uncertain.map(|own| Answer::Ok((own, uncertainty::read(own, model, machine)?)));
    let uncertain = uncertain.transpose()?;
    let judging = Judging::of_run(machine, model, setting);
    let judging = judging.map_err(|failure| setting.within(failure))?;
    let (result, parts, found) =
        with_task(aim, machine, setting, &read, forces.as_ref(), |task| {
            let task = &match task.places {
                0 if setting.targets.report.is_some() || setting.targets.pdf.is_some() => Task {
                    places: SHOWN,
                    ..task.clone()
                },
                _ => task.clone(),
            };
            let result = in_threads(threads, || match aim {
                Aim::Analyse => analyse(task, &progress),
                Aim::Compensate => compensate_program(task, &progress),
            })?;
            let parts = match (&uncertain, &result) {
                (Some((_, file)), Ok(run)) => {
                    uncertainty::parts(file, task, &run.places, machine, setting, &progress)?
                }
                _ => None,
            };
            let found = match (&judging, &forces, &result) {
                (Some(judging), Some(forces), Ok(_)) => {
                    let found = in_threads(threads, || judging.along(task, forces, &progress))?;
                    Some(found.map_err(|error| refused(error, setting))?)
                }
                _ => None,
            };
            Ok::<_, Failure>((result, parts, found))
        })??;
    let mut run = result.map_err(|error| failure_of(error, machine, model, setting, path))?;
    if let Some((own, file)) = &uncertain {
        in_threads(threads, || {
            put_band(&mut run, machine, model, own, file, parts, &progress)
        })??;
        let shared = file.shared.iter();
        let shared = shared.map(|s| Warning::new(WarningCode::SharedNumber, s.description()));
        run.result.warnings.extend(shared);
    }
    progress.finish();
    if let Some((judging, found)) = judging.as_ref().zip(found.as_ref()) {
        put_chatter(&mut run, found, judging);
    }
    run.result.warnings.extend(stands);
    run.result.warnings.extend(machine.not_carried.clone());
    run.result.warnings.extend(warnings(forces.as_ref()));
    run.result.warnings.extend(setting.of_expansion());
    if let ReadProgram::Robot(read) = &read {
        if let Some(assumed) = read.assumed_of_calls() {
            run.result.assume(assumed);
        }
        let arm = ArmOfTable::of(model, &Pose::identity());
        let other = other_configuration(read, arm.as_ref(), &run.points);
        run.result.warnings.extend(other);
        let first = of_first_place(read, arm.as_ref(), &run.points);
        run.result.warnings.extend(first);
    }
    let most = run.result.summary.blocks_per_second;
    run.result.warnings.extend(too_many_blocks(setting, most));
    let allowed_mm = match aim {
        Aim::Analyse => setting.writing.tolerance_mm,
        Aim::Compensate => run.result.tolerance.allowed_mm,
    };
    put_features(&mut run, setting, allowed_mm, &[]);
    let found = std::mem::take(&mut run.result.warnings);
    run.result.warnings = of_warnings(found, setting.flat.as_ref());
    Ok(run)
}

/// A program with more blocks per second than a controller takes, as stated.
pub(crate) fn too_many_blocks(setting: &Setting, most: Option<f64>) -> Option<Warning> {
    let (limit, most) = (setting.max_blocks_per_second?, most?);
    (most > limit).then(|| Warning::new(WarningCode::BlocksPerSecond, format!(
        "the written program asks for up to {} blocks per second, more than the {limit} that were stated: the machine may stutter. Widen the tolerance (path_um, chord_um) or cut more slowly",
        largest(most, "")
    )))
}

/// Converts an error of a run to a failure, with a possible reason.
pub(crate) fn failure_of(
    error: RunError,
    machine: &MachineSetup,
    model: &Model,
    setting: &Setting,
    path: &ToolPath,
) -> Failure {
    let of_machine = may_come_from_machine(&error);
    let failure = setting.within(Failure::from(error));
    if !of_machine {
        return failure;
    }
    // A doubtful placement, which alone is no warning, may be the reason of the failure.
    let (place, is_unplaced) = (&machine.placement, machine.bounds.is_unplaced);
    let failure = match origin_in_metres(&machine.mechanism, place, path, is_unplaced) {
        Some(doubt) => failure.with_reason(&doubt.message),
        None => failure,
    };
    with_model_warning(failure, model)
}

/// True if a wrong model or a misplaced part can be the reason of the failure: places that cannot be reached, large or discontinuous
/// deflections. Other errors are those of texts, options and files.
fn may_come_from_machine(error: &RunError) -> bool {
    match error {
        RunError::Point { .. }
        | RunError::ArmStops { .. }
        | RunError::Worse { .. }
        | RunError::BeyondLimits(_)
        | RunError::Unstable { .. }
        | RunError::Jump { .. } => true,
        RunError::Write(error) => matches!(
            error,
            WriteError::Field { .. } | WriteError::TooManyPieces { .. }
        ),
        _ => false,
    }
}
