//! `kinetostat mirror`: a program corrected by what was measured of its last trial.
//!
//! It takes the program as it is drawn, measured points and the state of the trials before, and gives the program of the next
//! trial with the new state, a plot and a result. What it knows of points and trials is in the crate `kinetostat-mirror`.

mod answer;
pub(crate) mod arguments;
mod plot;
mod text;

use std::path::{Path, PathBuf};

use kinetostat_machining::{FieldCorrection, RunError, correct_by_field, with_model_field};
use kinetostat_mirror::{
    MeasureSettings, MeasuredFile, MeasuredPoints, Measurement, MirrorError, MirrorField,
    MirrorState, NominalPath, Outcome, Repeatability, SumOfFields, measure,
};
use kinetostat_program::{Program, ReadOptions, interpret};

use crate::files::hash::sha256;
use crate::files::input_files::{InputFiles, text_in};
use crate::files::outputs::{self, Existing, Outputs};
use crate::job::arguments::{ProgramArgs, WritingFlags};
use crate::job::job_file::JobFile;
use crate::job::machine::machine_setup;
use crate::job::program::{ReadProgram, read_program};
use crate::job::setting::{Setting, setting};
use crate::mirror::answer::{MeasurementResult, MirrorAnswer, largest_correction_mm};
use crate::mirror::arguments::MirrorArgs;
use crate::program::aim::Aim;
use crate::program::solve::{forces_of, with_task};
use crate::ui::failure::{Answer, Failure};
use crate::ui::json;
use crate::ui::progress::Progress;

impl From<MirrorError> for Failure {
    fn from(error: MirrorError) -> Self {
        Self::input(error.to_string())
    }
}

pub(crate) fn run(args: &MirrorArgs) -> Answer<()> {
    let files = InputFiles::default();
    let job = args.job.as_deref().map(|path| JobFile::read(&files, path));
    let job = job.transpose()?;
    let setting = asked(&files, job.as_ref(), args)?;
    let read = read_program(&setting)?;
    let nominal =
        NominalPath::new(read.path()).map_err(|e| setting.within(MirrorError::from(e).into()))?;
    let settings = settings_of(args);
    let hash = sha256(&setting.program);
    let mut state = match &args.state {
        Some(path) if path.exists() => read_state(&files, path)?,
        _ => MirrorState::new(&nominal, &hash, settings),
    };
    let of_state = |error: MirrorError| {
        let name = args.state.as_ref().map(|path| path.display().to_string());
        Failure::from(error).within(&name.unwrap_or_default())
    };
    state.fits(&nominal, &hash, &settings).map_err(of_state)?;
    let mut outputs = Outputs::new(
        Existing::forced(args.force_overwrite),
        setting
            .inputs
            .iter()
            .chain(&args.measured)
            .cloned()
            .collect(),
    );
    let to_screen = args.json.as_deref() == Some(Path::new("-"));
    let program_out = outputs.claim("corrected program", &args.out)?;
    let json_out = args.json.as_ref().filter(|_| !to_screen);
    let json_out = json_out
        .map(|path| outputs.claim("result", path))
        .transpose()?;
    let plot_out = args
        .plot
        .as_ref()
        .map(|path| outputs.claim("plot", path))
        .transpose()?;
    let state_out = args
        .state
        .as_ref()
        .map(|path| outputs.claim_to_go_on("state", path));
    let state_out = state_out.transpose()?;

    let measured = measurements(&files, args, (&nominal, &settings), &setting.reading)?;
    let relaxation = args.relaxation.unwrap_or(1.0);
    let known = repeatability(args, &measured)?;
    let outcome = state
        .take(&nominal, &measured, relaxation, known)
        .map_err(Failure::from)?;
    let field = MirrorField::new(&nominal, &state).map_err(of_state)?;
    let (made, model) = written(&files, job.as_ref(), args, (&setting, &read), &field)?;

    let answer = answer_of(
        &setting,
        model,
        (&state, outcome, relaxation),
        &measured,
        &made,
    );
    outputs.fill(program_out, &setting.as_files(&made.written)?.program)?;
    if let Some(index) = json_out {
        outputs.fill(index, json::json(&answer)?.as_bytes())?;
    }
    if let (Some(index), Some((_, first))) = (plot_out, measured.first()) {
        let title = format!(
            "{}, trial {}: deviation along the path",
            answer.program, answer.trial
        );
        outputs.fill(index, plot::drawing(title, first, &state).as_bytes())?;
    }
    if let Some(index) = state_out {
        outputs.fill(index, state_text(&state)?.as_bytes())?;
    }
    let paths = outputs.commit()?;
    let text = format!("{}{}", text::answer_text(&answer), outputs::written(&paths));
    json::print_answer(&text, &answer, to_screen)
}

/// The program and how it is read and written.
fn asked(files: &InputFiles, job: Option<&JobFile>, args: &MirrorArgs) -> Answer<Setting> {
    let flags = flags_of(args);
    let writing = WritingFlags {
        tolerance_um: args.tolerance_um,
        decimals: args.decimals,
        no_header: args.no_header,
        out: Some(&args.out),
        ..WritingFlags::default()
    };
    let mut setting = setting(files, job, &flags, &writing)?;
    if setting.robot.is_some() || setting.flat.is_some() {
        return Err(setting.within(Failure::input(
            "mirror takes programs in G-code without macros: expand the program first (`kinetostat expand`), and mirror the flat one",
        )));
    }
    setting.reading.tools = None;
    Ok(setting)
}

fn flags_of(args: &MirrorArgs) -> ProgramArgs {
    ProgramArgs {
        program: Some(args.program.clone()),
        reading: args.reading.clone(),
        force_overwrite: args.force_overwrite,
        ..ProgramArgs::default()
    }
}

fn settings_of(args: &MirrorArgs) -> MeasureSettings {
    let usual = MeasureSettings::default();
    MeasureSettings {
        smoothing_mm: args.smoothing_mm.unwrap_or(usual.smoothing_mm),
        window_mm: args.window_mm.unwrap_or(usual.window_mm),
        align: args.align.map_or(usual.align, Into::into),
        register: !args.no_register,
        scale: args.scale,
    }
}

fn read_state(files: &InputFiles, path: &Path) -> Answer<MirrorState> {
    let text = files.text("state", path)?;
    toml::from_str(&text).map_err(|error| {
        let before = error.span().map_or(0, |span| span.start);
        let line = 1 + text.as_bytes()[..before].iter().filter(|b| **b == b'\n').count();
        Failure::input(format!(
            "'{}', line {line}: this is no state of trials: {}; name the file that an earlier run wrote with --state",
            path.display(),
            error.message()
        ))
    })
}

fn state_text(state: &MirrorState) -> Answer<String> {
    toml::to_string(state)
        .map_err(|error| Failure::input(format!("the state cannot be written: {error}")))
}

/// All measurements of this trial, compared with the path.
fn measurements(
    files: &InputFiles,
    args: &MirrorArgs,
    (nominal, settings): (&NominalPath<'_>, &MeasureSettings),
    reading: &ReadOptions,
) -> Answer<Vec<(MeasuredFile, Measurement)>> {
    let one = |path: &PathBuf| {
        let bytes = files.bytes("measurement", path)?;
        let file = MeasuredFile {
            name: path
                .file_name()
                .map_or_else(String::new, |n| n.to_string_lossy().into_owned()),
            sha256: sha256(&bytes),
        };
        let name = path.display().to_string();
        let is_table = path.extension().is_some_and(|e| e == "csv" || e == "txt");
        let points = match is_table {
            true => MeasuredPoints::read(&name, &text_in("measurement", path, bytes)?)?,
            false => {
                let refuse = |error: kinetostat_program::ProgramError| {
                    Failure::input(error.to_string()).within(&name)
                };
                let program = Program::read(bytes).map_err(refuse)?;
                let path = interpret(&program, reading).map_err(refuse)?;
                MeasuredPoints::along(&path, 0.1 * settings.smoothing_mm)?
            }
        };
        let found = measure(nominal, &points, settings);
        Ok((file, found.map_err(|e| Failure::from(e).within(&name))?))
    };
    args.measured.iter().map(one).collect()
}

/// As given, or from the measurements of this trial where there are several.
fn repeatability(
    args: &MirrorArgs,
    measured: &[(MeasuredFile, Measurement)],
) -> Answer<Option<Repeatability>> {
    match args.repeatability_um {
        Some(um) if um > 0.0 => Ok(Some(Repeatability::OfPoints(1e-3 * um))),
        Some(um) => Err(Failure::input(format!(
            "--repeatability-um {um}: a standard deviation above 0 is needed"
        ))),
        None => Ok(Repeatability::of_repeats(
            measured.iter().map(|(_, found)| found),
        )),
    }
}

/// The program with its correction, on top of a model's where a job has one; the name of the model.
fn written(
    files: &InputFiles,
    job: Option<&JobFile>,
    args: &MirrorArgs,
    (setting, read): (&Setting, &ReadProgram<'_>),
    field: &MirrorField<'_>,
) -> Answer<(FieldCorrection, Option<String>)> {
    let progress = Progress::new();
    let refuse = |error: RunError| setting.within(Failure::from(error));
    let Some(job) = job else {
        let mut writing = setting.writing.clone();
        if let Some(header) = &mut writing.header {
            *header = vec![
                format!("version {}", env!("CARGO_PKG_VERSION")),
                "corrections from measured points".to_owned(),
            ];
        }
        let made = read.with(|program| correct_by_field(program, field, &writing, &progress));
        progress.finish();
        return Ok((made.map_err(|error| refuse(RunError::Write(error)))?, None));
    };
    let (machine, _) = machine_setup(
        files,
        Some(job),
        None,
        &flags_of(args),
        (None, &mut Vec::new()),
    )?;
    let forces = forces_of(&machine, setting, read.path(), &progress)?;
    let made = with_task(
        Aim::Compensate,
        &machine,
        setting,
        read,
        forces.as_ref(),
        |task| {
            with_model_field(task, &progress, |model| {
                let both = SumOfFields {
                    model,
                    mirror: field,
                };
                correct_by_field(task.program, &both, &task.writing, &progress)
            })
        },
    )?;
    progress.finish();
    let made = made
        .map_err(refuse)?
        .map_err(|error| refuse(RunError::Write(error)))?;
    Ok((made, Some(machine.run_inputs.model.clone())))
}

fn answer_of(
    setting: &Setting,
    model: Option<String>,
    (state, outcome, relaxation): (&MirrorState, Outcome, f64),
    measured: &[(MeasuredFile, Measurement)],
    made: &FieldCorrection,
) -> MirrorAnswer {
    let last = state.trials.last();
    MirrorAnswer {
        schema: 1,
        kinetostat_version: env!("CARGO_PKG_VERSION"),
        program: setting.program_name.clone(),
        model,
        trial: state.trials.len(),
        relaxation,
        smoothing_mm: state.settings.smoothing_mm,
        outcome,
        measurements: measured
            .iter()
            .map(|(file, found)| MeasurementResult::of(&file.name, found))
            .collect(),
        left_mm: last.map_or(f64::NAN, |trial| trial.left_mm),
        floor_mm: last.and_then(|trial| trial.floor_mm),
        left_in_trials_mm: state.trials.iter().map(|trial| trial.left_mm).collect(),
        convergence: last.and_then(|trial| trial.convergence),
        largest_correction_mm: largest_correction_mm(state),
        accounting: made.written.accounting.clone(),
    }
}
