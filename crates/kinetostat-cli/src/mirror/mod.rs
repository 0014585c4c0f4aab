//! `kinetostat mirror`: a program corrected by what was measured of its last trial.
//!
//! It takes the program as it is drawn, measured points and the state of the trials before, and gives the program of the next
//! trial with the new state, a plot and a result. What it knows of points and trials is in the crate `kinetostat-mirror`.
//!
//! The file of the state: what `mirror` has written, and nothing else.
//!
//! Its first line is a digest of all others. A number that was changed by hand would be taken for a correction that the machine
//! was given, and every trial after it would mirror the difference.

mod answer;
pub(crate) mod arguments;
mod asked;
mod measured;
mod text;
mod written;

use std::path::{Path, PathBuf};

use kinetostat_diagnostic::ErrorCode;
use kinetostat_machining::{FieldCorrection, RunError, of_accounting};
use kinetostat_mirror::{
    MeasuredFile, Measurement, MirrorError, MirrorField, MirrorState, NominalPath, Outcome,
    Repeatability,
};
use kinetostat_program::Accounting;
use kinetostat_report::{Plot, PlotLine, PlotMark};
use nalgebra::Vector3;
use serde::Deserialize;

use crate::files::hash::sha256;
use crate::files::input_files::InputFiles;
use crate::files::outputs::{self, Existing, Outputs};
use crate::job::job_file::JobFile;
use crate::job::limits::{OF_CORRECTIONS, refuse_limits_but};
use crate::job::machine::{MachineSetup, machine_setup};
use crate::job::output_paths::BESIDE;
use crate::job::program::read_program;
use crate::job::setting::Setting;
use crate::long::checkpoint::Manifest;
use crate::mirror::answer::{MeasurementResult, MirrorAnswer, largest_correction_mm, of_features};
use crate::mirror::arguments::MirrorArgs;
use crate::mirror::asked::{asked, flags_of, hash_of, names_model, settings_of};
use crate::mirror::measured::{measurements, repeatability};
use crate::mirror::written::written;
use crate::ui::failure::{Answer, Failing, Failure};
use crate::ui::json;
use crate::ui::numbers::{number, short};
use crate::ui::result_form::ResultForm;

impl From<MirrorError> for Failure {
    fn from(error: MirrorError) -> Self {
        ErrorCode::FileForm.failure(error)
    }
}

/// Results that the command gives as JSON.
pub(crate) const RESULTS: &[ResultForm] = &[ResultForm::of::<MirrorAnswer>(
    "a program corrected by measured errors",
)];

pub(crate) fn run(args: &MirrorArgs) -> Answer<()> {
    let files = InputFiles::default();
    let job = args.job.as_deref().map(|path| JobFile::read(&files, path));
    let job = job.transpose()?;
    let mut setting = asked(&files, job.as_ref(), args, &args.program)?;
    let machine = machine_of_job(&files, job.as_ref(), args, &mut setting)?;
    let read = read_program(&setting)?;
    let nominal =
        NominalPath::new(read.path()).map_err(|e| setting.within(MirrorError::from(e).into()))?;
    let before = args.state.as_ref().filter(|path| path.exists());
    let before = before.map(|path| read_state(&files, path)).transpose()?;
    let settings = settings_of(args, &nominal, before.as_ref())?;
    let hash = hash_of(&setting);
    let compensation = Manifest::of_machine(machine.as_ref());
    let mut state = match before {
        Some(state) => state,
        None => MirrorState {
            compensation: Some(compensation.0.clone()),
            ..MirrorState::new(&nominal, &hash, settings)?
        },
    };
    let of_state = |failure: Failure| {
        let name = args.state.as_ref().map(|path| path.display().to_string());
        failure.within(&name.unwrap_or_default())
    };
    let fits = state.fits(&nominal, &hash, &settings);
    fits.map_err(|error| of_state(error.into()))?;
    let kept = state.compensation.clone().map(Manifest);
    if let Some(field) = kept.and_then(|kept| kept.differs_in(&compensation)) {
        return Err(of_state(ErrorCode::Conflict.failure(format!(
                "its trials were made on top of another compensation by a model, and what differs now is {field}: go on with the same --job, or begin with a new state"
            ),
        )));
    }
    let claimed = Claimed::of(args, &setting)?;

    let tolerance_mm = setting.writing.tolerance_mm;
    if !names_model(job.as_ref()) {
        let why = "without a model nothing is known of loads, tools and places";
        refuse_limits_but(&OF_CORRECTIONS, &args.limits, why)?;
    }
    let measured = measurements(
        &files,
        job.as_ref(),
        args,
        &nominal,
        &settings,
        &hash,
        tolerance_mm,
    )?;
    let relaxation = args.relaxation.unwrap_or(1.0);
    let known = repeatability(args, &measured)?;
    let outcome = match args.was_run {
        true => state.take_of_last_program(&nominal, &measured, relaxation, known),
        false => state.take(&nominal, &measured, relaxation, known),
    };
    let outcome = outcome.map_err(Failure::from)?;
    let field = MirrorField::new(&nominal, &state).map_err(|error| of_state(error.into()))?;
    let made = written(machine.as_ref(), &setting, &read, &field)?;
    refuse_beyond_limits(&setting, &state, &made)?;

    let model = machine.map(|machine| machine.run_inputs.model);
    let trial = Trial {
        setting: &setting,
        nominal: &nominal,
        state: &state,
        outcome,
        relaxation,
        was_run: args.was_run,
        measured: &measured,
        known,
    };
    let answer = trial.answer(model, &made);
    let to_screen = claimed.to_screen;
    let first = measured.first().map(|(_, first)| first);
    let paths = claimed.filled(&setting, &made, &answer, &state, first)?;
    let text = format!("{}{}", text::answer_text(&answer), outputs::written(&paths));
    json::print_answer(&text, &answer, to_screen)
}

/// Corrections by measurement beyond the limits of `compensate`; a model's part has limits of its own.
fn refuse_beyond_limits(
    setting: &Setting,
    state: &MirrorState,
    made: &FieldCorrection,
) -> Answer<()> {
    let accounting = Accounting {
        largest_correction_mm: largest_correction_mm(state),
        largest_correction_line: None,
        ..made.written.accounting.clone()
    };
    match of_accounting(&setting.limits, &accounting) {
        beyond if beyond.is_empty() => Ok(()),
        beyond => Err(setting.within(Failure::from(RunError::BeyondLimits(beyond)))),
    }
}

/// The machine of a job that names a model.
fn machine_of_job(
    files: &InputFiles,
    job: Option<&JobFile>,
    args: &MirrorArgs,
    setting: &mut Setting,
) -> Answer<Option<MachineSetup>> {
    if !names_model(job) {
        return Ok(None);
    }
    let frames = setting.robot_frames()?;
    let flags = flags_of(args, &args.program);
    let (machine, _) = machine_setup(
        files,
        job,
        None,
        &flags,
        frames.as_ref(),
        &mut setting.inputs,
    )?;
    setting.turned_by(machine.rotary.clone());
    Ok(Some(machine))
}

/// Outputs that have been found writable.
struct Claimed {
    outputs: Outputs,
    program: usize,
    /// Indices of the program's additional files.
    beside: Vec<usize>,
    json: Option<usize>,
    plot: Option<usize>,
    state: Option<usize>,
    to_screen: bool,
}

impl Claimed {
    fn of(args: &MirrorArgs, setting: &Setting) -> Answer<Self> {
        let inputs = setting.inputs.iter().chain(&args.measured);
        let existing = Existing::forced(args.force_overwrite);
        let mut outputs = Outputs::new(existing, inputs.cloned().collect());
        let to_screen = args.json.as_deref() == Some(Path::new("-"));
        let program = outputs.claim("corrected program", &args.out)?;
        let further = setting.targets.beside.iter();
        let beside = further.map(|path| outputs.claim(BESIDE, path));
        let beside = beside.collect::<Answer<_>>()?;
        let mut claim =
            |what, path: Option<&PathBuf>| path.map(|path| outputs.claim(what, path)).transpose();
        let json = claim("result", args.json.as_ref().filter(|_| !to_screen))?;
        let plot = claim("plot", args.plot.as_ref())?;
        let state = args
            .state
            .as_ref()
            .map(|path| outputs.claim_to_go_on("state", path));
        Ok(Self {
            state: state.transpose()?,
            program,
            beside,
            json,
            plot,
            to_screen,
            outputs,
        })
    }

    /// All of them written and put in place.
    fn filled(
        mut self,
        setting: &Setting,
        made: &FieldCorrection,
        answer: &MirrorAnswer,
        state: &MirrorState,
        first: Option<&Measurement>,
    ) -> Answer<Vec<PathBuf>> {
        let files = setting.as_files(&made.written)?;
        self.outputs.fill(self.program, &files.program)?;
        for (index, bytes) in self.beside.iter().zip(&files.beside) {
            self.outputs.fill(*index, bytes)?;
        }
        if let Some(index) = self.json {
            self.outputs.fill(index, json::json(answer)?.as_bytes())?;
        }
        if let (Some(index), Some(first)) = (self.plot, first) {
            let title = format!(
                "{}, trial {}: deviation along the path",
                answer.program, answer.trial
            );
            let picture = drawing(title, first, state);
            self.outputs.fill(index, picture.as_bytes())?;
        }
        if let Some(index) = self.state {
            self.outputs.fill(index, state_text(state)?.as_bytes())?;
        }
        self.outputs.commit()
    }
}

/// A trial: the measured program and the correction that follows from it.
struct Trial<'a> {
    setting: &'a Setting,
    nominal: &'a NominalPath<'a>,
    state: &'a MirrorState,
    outcome: Outcome,
    relaxation: f64,
    was_run: bool,
    measured: &'a [(MeasuredFile, Measurement)],
    known: Option<Repeatability>,
}

impl Trial<'_> {
    fn answer(self, model: Option<String>, made: &FieldCorrection) -> MirrorAnswer {
        let Self {
            setting,
            nominal,
            state,
            outcome,
            relaxation,
            was_run,
            measured,
            known,
        } = self;
        let last = state.trials.last();
        let smoothing_mm = state.settings.smoothing_mm;
        MirrorAnswer {
            schema: 1,
            kinetostat_version: env!("CARGO_PKG_VERSION"),
            program: setting.program_name.clone(),
            model,
            trial: state.trials.len(),
            relaxation,
            smoothing_mm,
            register: state.settings.register,
            outcome,
            measurements: measured
                .iter()
                .map(|(file, found)| {
                    let features = of_features(&setting.features, nominal, found, smoothing_mm);
                    MeasurementResult::of(&file.name, found, known, features)
                })
                .collect(),
            left_mm: last.map_or(f64::NAN, |trial| trial.left_mm),
            floor_mm: last.and_then(|trial| trial.floor_mm),
            left_in_trials_mm: state.trials.iter().map(|trial| trial.left_mm).collect(),
            convergence: last.and_then(|trial| trial.convergence),
            shows_correction: last.and_then(|trial| trial.shows_correction),
            was_run,
            largest_correction_mm: largest_correction_mm(state),
            accounting: made.written.accounting.clone(),
        }
    }
}

const AXES: [&str; 3] = ["x", "y", "z"];

/// Points that a picture holds; of more, every so many.
const MOST: usize = 4000;

fn drawing(title: String, measured: &Measurement, state: &MirrorState) -> String {
    let x_label = "length along the feed moves, mm".to_owned();
    let along = |k: usize, name: String, all: &mut dyn Iterator<Item = (f64, Vector3<f64>)>| {
        let points = all.map(|(at, v)| (at, 1e3 * v[k])).collect();
        PlotLine::solid(name, k, points)
    };
    let every = measured.points.len().div_ceil(MOST).max(1);
    let mut lines = Vec::new();
    for (k, axis) in AXES.iter().enumerate() {
        let points = measured.points.iter().step_by(every);
        let mut raw = points.map(|p| (p.along_mm, p.deviation_mm));
        // Readings scatter: joined, they would hide the smoothed line.
        lines.push(PlotLine {
            dots: true,
            ..along(k, format!("{axis}, measured"), &mut raw)
        });
        let places = state.along_mm.iter().copied();
        let mut smoothed = places.zip(&measured.at_stations).map(|(at, s)| {
            let lost = Vector3::repeat(f64::NAN);
            (
                at,
                if s.effective_points > 0.0 {
                    s.deviation_mm
                } else {
                    lost
                },
            )
        });
        lines.push(along(k, format!("{axis}, smoothed"), &mut smoothed));
    }
    let marks = measured.outliers.iter().map(|outlier| {
        let axis = outlier.deviation_mm.iamax();
        PlotMark {
            at: (outlier.along_mm, 1e3 * outlier.deviation_mm[axis]),
            name: String::new(),
            detail: format!(
                "outlier, row {}: {} um from the path at {} mm",
                outlier.row,
                number(1e3 * outlier.distance_mm, 3),
                short(outlier.along_mm)
            ),
        }
    });
    let deviation = Plot {
        title,
        x_label: x_label.clone(),
        y_label: "deviation across the path, um".into(),
        lines,
        marks: marks.collect(),
    };
    let correction = Plot {
        title: "Correction of the next trial".into(),
        x_label,
        y_label: "correction, um".into(),
        lines: (0..3)
            .map(|k| {
                let places = state.along_mm.iter().copied();
                let mut all = places.zip(state.correction_mm.iter().copied());
                along(k, AXES[k].to_owned(), &mut all)
            })
            .collect(),
        marks: Vec::new(),
    };
    deviation.svg_above(&[correction])
}

/// Name of the digest in the file.
const DIGEST: &str = "content_sha256";

/// A state with the digest that it was written with, if any: states of earlier versions have none.
#[derive(Deserialize)]
struct Digest {
    content_sha256: Option<String>,
}

fn read_state(files: &InputFiles, path: &Path) -> Answer<MirrorState> {
    let text = files.state(path)?;
    let of_file = |error: toml::de::Error| {
        let before = error.span().map_or(0, |span| span.start);
        let line = 1 + text.as_bytes()[..before]
            .iter()
            .filter(|b| **b == b'\n')
            .count();
        ErrorCode::FileForm.failure(format!(
                "'{}', line {line}: this is no state of trials: {}; name the file that an earlier run wrote with --state",
                path.display(),
                error.message()
            ),
        )
    };
    let digest: Digest = toml::from_str(&text).map_err(of_file)?;
    let state = toml::from_str(&text).map_err(of_file)?;
    match digest.content_sha256 {
        Some(written) if written != digest_of(&text) => Err(ErrorCode::FileForm.failure(format!(
                "'{}': the file was changed after it was written ({DIGEST} is not that of its content), and corrections would no longer be those of the programs that were run; take a copy of it as it was, or begin with a new state (another --state, and the program without a correction as trial 1)",
                path.display()
            ),
        )),
        _ => Ok(state),
    }
}

/// Digest of all lines but its own, whatever ends them: tools that copy a text change that.
fn digest_of(text: &str) -> String {
    let content = text.lines().filter(|line| !line.starts_with(DIGEST));
    let content: Vec<&str> = content.collect();
    sha256(content.join("\n").as_bytes())
}

fn state_text(state: &MirrorState) -> Answer<String> {
    let content = toml::to_string(state).map_err(|error| {
        ErrorCode::Internal.failure(format!("the state cannot be written: {error}"))
    })?;
    Ok(format!("{DIGEST} = \"{}\"\n{content}", digest_of(&content)))
}
