//! `kinetostat plan-measurement`: the postures in which a machine is measured.
//!
//! It takes a model, loads, markers and what the measurement is for, and gives the postures as a table that `identify` reads when the
//! readings are filled in, and as a sheet for the shop.

mod answer;
mod text;

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use kinetostat_diagnostic::ErrorCode;
use kinetostat_identification::{
    Axes, Body, BodyPoint, DEVIATION, Observation, Plan, PlanError, PlanTask, PlannedMeasurement,
    Purpose, Reading, Room, TestLoad, Theory, Unknowns, plan, read_postures,
};
use kinetostat_model::Model;
use kinetostat_report::{Plot, PlotLine};
use nalgebra::Vector3;

use crate::files::answer_files::{AnswerFiles, ClaimedFiles, Shown};
use crate::files::input_files::InputFiles;
use crate::identify::of_table;
use crate::machine::units::unit;
use crate::options::{number, vector, whole};
use crate::place::joints::{self, JointValue, Named};
use crate::plan_measurement::answer::{PlanAnswer, PlanRow, PlannedNumber};
use crate::program::work::work_of_job;
use crate::ui::csv_table::{cell, written};
use crate::ui::failure::{Answer, Failing, Failure};
use crate::ui::result_form::ResultForm;

/// What is made small.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Aim {
    /// The mean variance of the numbers, relative to their sizes
    Average,
    /// The volume of their region of confidence
    Determinant,
    /// The variance of the worst combination of them
    WorstDirection,
}

/// Postures and loads in which to measure a machine for `identify`
///
/// Of many postures that the machine can take, those are chosen whose readings leave the least error after compensation at a place
/// under a load, or, without one, know the numbers best; with how good the choice is beside the best possible. The table is the one
/// that `identify` reads: fill in what was read.
#[derive(Debug, Args)]
#[command(after_help = crate::options::EXIT_CODES, after_long_help = HELP)]
pub(crate) struct PlanMeasurementArgs {
    /// Preset or model file
    #[arg(value_name = "MODEL")]
    pub(crate) model: String,
    /// Numbers to identify, as of `identify`
    #[arg(long, value_name = "NUMBER", num_args = 1.., default_value = "joints")]
    pub(crate) numbers: Vec<String>,
    /// Number of measurements [default: 15]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = whole)]
    pub(crate) count: Option<usize>,
    /// Mass that hangs on the tool, kg
    #[arg(long, value_name = "KG", allow_negative_numbers = true, value_parser = number, help_heading = "Loads")]
    pub(crate) mass_kg: Option<f64>,
    /// Force of a string or cylinder, N, which pulls along x, along y and down
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = number, help_heading = "Loads")]
    pub(crate) pull_n: Option<f64>,
    /// Direction in which it may pull, base axes; once for each, instead of these three
    #[arg(long, num_args = 3, action = clap::ArgAction::Append, value_names = ["X", "Y", "Z"], allow_negative_numbers = true, value_parser = number, requires = "pull_n", help_heading = "Loads")]
    pub(crate) pull_direction: Vec<f64>,
    /// Node or body of a limb on which the load acts, as NODE or LIMB:NODE [default: the tool]
    #[arg(long, value_name = "NODE", help_heading = "Loads")]
    pub(crate) load_on: Option<String>,
    /// Where the load acts, mm, in the frame of the tool or node [default: its origin]
    #[arg(long, num_args = 3, value_names = ["X", "Y", "Z"], allow_negative_numbers = true, value_parser = number, help_heading = "Loads")]
    pub(crate) load_at: Option<Vec<f64>>,
    /// Marker that is read, mm, in the tool's frame; once for each [default: its origin]
    #[arg(long, num_args = 3, action = clap::ArgAction::Append, value_names = ["X", "Y", "Z"], allow_negative_numbers = true, value_parser = number, help_heading = "Readings")]
    pub(crate) marker: Vec<f64>,
    /// Standard deviation of a reading, mm [default: 0.02]
    #[arg(long, value_name = "MM", allow_negative_numbers = true, value_parser = number, help_heading = "Readings")]
    pub(crate) sigma_mm: Option<f64>,
    /// Place of a laser tracker, mm, base axes: markers that the machine hides from it are no choice
    #[arg(long, num_args = 3, value_names = ["X", "Y", "Z"], allow_negative_numbers = true, value_parser = number, help_heading = "Readings")]
    pub(crate) tracker: Option<Vec<f64>>,
    /// Where the tool may be along x, mm, base axes
    #[arg(long, num_args = 2, value_names = ["FROM", "TO"], allow_negative_numbers = true, value_parser = number, help_heading = "Room")]
    pub(crate) x: Option<Vec<f64>>,
    /// The same along y
    #[arg(long, num_args = 2, value_names = ["FROM", "TO"], allow_negative_numbers = true, value_parser = number, help_heading = "Room")]
    pub(crate) y: Option<Vec<f64>>,
    /// The same along z
    #[arg(long, num_args = 2, value_names = ["FROM", "TO"], allow_negative_numbers = true, value_parser = number, help_heading = "Room")]
    pub(crate) z: Option<Vec<f64>>,
    /// Where the machine will work: a job, or joints as in A1=10,A2=-90 (once for each posture). The error left there is made small
    #[arg(
        long,
        value_name = "JOB|NAME=VALUE,...",
        help_heading = "What it is for"
    )]
    pub(crate) work: Vec<String>,
    /// Force on the tool at these joints, N, base axes; a job has its own
    #[arg(long, num_args = 3, value_names = ["FX", "FY", "FZ"], allow_negative_numbers = true, value_parser = number, requires = "work", help_heading = "What it is for")]
    pub(crate) force: Option<Vec<f64>>,
    /// Without --work: what is made small [default: average]
    #[arg(
        long,
        value_enum,
        value_name = "AIM",
        conflicts_with = "work",
        help_heading = "What it is for"
    )]
    pub(crate) aim: Option<Aim>,
    /// Postures to choose from, as a table with the axes (A1_deg, ...; CSV, XLSX or Parquet); without it they are drawn
    #[arg(long, value_name = "FILE", conflicts_with_all = ["candidates", "seed"])]
    pub(crate) postures: Option<PathBuf>,
    /// Number of postures that are drawn to choose from [default: 300]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = whole)]
    pub(crate) candidates: Option<usize>,
    /// Other seeds draw other postures to choose from [default: 0]
    #[arg(long, value_name = "SEED", allow_negative_numbers = true, value_parser = whole)]
    pub(crate) seed: Option<usize>,
    /// The sheet for the shop, as text
    #[arg(long, value_name = "FILE", help_heading = "Outputs")]
    pub(crate) sheet: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) outputs: AnswerFiles,
}

const HELP: &str = "\
Examples:
  kinetostat plan-measurement my_robot.toml --mass-kg 150 --z 400 2500 \\
      --csv measure.csv --sheet measure.txt
  kinetostat plan-measurement my_robot.toml --pull-n 1000 --count 12 \\
      --tracker 4000 -3000 1000 --work A1=0,A2=-90,A3=90,A4=0,A5=90,A6=0 \\
      --force 300 0 -500 --csv measure.csv
  kinetostat plan-measurement my_robot.toml --mass-kg 150 --work milling.toml \\
      --csv measure.csv
  kinetostat identify my_robot.toml --measured measure.csv -o identified.toml

Exit codes:
  0    answered
  1    wrong input: a file, a number or an option; the message says which
  2    no answer: no posture that can be taken, or loads that show nothing
  130  stopped with Ctrl-C; nothing was written";

/// Results that the command gives as JSON.
pub(crate) const RESULTS: &[ResultForm] = &[ResultForm::of::<PlanAnswer>("planned measurements")];

impl From<PlanError> for Failure {
    fn from(error: PlanError) -> Self {
        match error {
            PlanError::Identification(error) => error.into(),
            PlanError::NoLimits(_) => ErrorCode::ModelUnsuited.failure(error),
            PlanError::Design(error) => ErrorCode::Value.failure(error),
            other => ErrorCode::NoAnswer.failure(other),
        }
    }
}

pub(crate) fn run(args: &PlanMeasurementArgs) -> Answer<()> {
    let (model, path) = InputFiles::default().model(&args.model, Path::new(""))?;
    model.require_stiffness()?;
    let mut inputs: Vec<PathBuf> = path.into_iter().collect();
    inputs.extend(job_of_work(args)?.map(Path::to_owned));
    inputs.extend(args.postures.clone());
    let mut claimed = ClaimedFiles::claim(&args.outputs, &inputs)?;
    let sheet = args
        .sheet
        .as_ref()
        .map(|path| claimed.claim_also("sheet", path))
        .transpose()?;
    let patterns: Vec<&str> = args.numbers.iter().map(String::as_str).collect();
    let unknowns = Unknowns::matching(&model, &patterns)?;
    let task = task(args, &model, &unknowns)?;
    let found = plan(&task)?;
    let answer = answer_of(args, &task, &found);
    if let Some(index) = sheet {
        claimed.fill(index, text::sheet(&answer, &task).as_bytes())?;
    }
    let shown = Shown {
        text: text::answer_text(&answer),
        csv: table(&task, args.load_on.as_deref(), &found)?,
        svg: picture(&answer).svg(),
        failure: None,
    };
    claimed.finish(&shown, &answer)
}

fn task<'a>(
    args: &PlanMeasurementArgs,
    model: &'a Model,
    unknowns: &'a Unknowns,
) -> Answer<PlanTask<'a>> {
    let millimetres = |name: &str, values: &[f64]| Ok::<_, Failure>(vector(name, values)? * 1e-3);
    let markers: Vec<Vector3<f64>> = match args.marker.is_empty() {
        true => vec![Vector3::zeros()],
        false => args
            .marker
            .chunks(3)
            .map(|m| millimetres("--marker", m))
            .collect::<Answer<_>>()?,
    };
    let range = |option: &str, values: &Option<Vec<f64>>| match values.as_deref() {
        Some([low, high]) if low < high => Ok(Some((1e-3 * low, 1e-3 * high))),
        Some(_) => Err(ErrorCode::Value.failure(format!(
            "{option}: the first number has to be the smaller one"
        ))),
        None => Ok(None),
    };
    let deviation = 1e-3 * args.sigma_mm.unwrap_or(1e3 * DEVIATION);
    let count = args.count.unwrap_or(15);
    if !(deviation > 0.0 && (1..=1000).contains(&count)) {
        return Err(
            ErrorCode::Value.failure("--sigma-mm has to be above 0, and --count from 1 to 1000")
        );
    }
    let candidates = args.candidates.unwrap_or(300);
    if !(count..=5000).contains(&candidates) {
        return Err(ErrorCode::Value.failure(format!(
            "--candidates is {candidates}; at least as many as --count ({count}) and at most 5000 are needed"
        )));
    }
    Ok(PlanTask {
        model,
        unknowns,
        loads: loads(args, model)?,
        markers: markers.clone(),
        deviation,
        count,
        given: given(args, model)?,
        candidates,
        seed: seed(args)?,
        room: Room {
            bounds: [
                range("--x", &args.x)?,
                range("--y", &args.y)?,
                range("--z", &args.z)?,
            ],
            tracker: args
                .tracker
                .as_deref()
                .map(|t| millimetres("--tracker", t))
                .transpose()?,
        },
        purpose: purpose(args, model)?,
        theory: Theory::Loaded,
    })
}

/// The postures of a table.
fn given(args: &PlanMeasurementArgs, model: &Model) -> Answer<Vec<Vec<f64>>> {
    let Some(path) = &args.postures else {
        return Ok(Vec::new());
    };
    let text = InputFiles::default().table("table of postures", path)?;
    let found = read_postures(&text, &Axes::of(model));
    found.map_err(|faults| of_table(&path.display().to_string(), &faults))
}

fn seed(args: &PlanMeasurementArgs) -> Answer<u32> {
    let seed = args.seed.unwrap_or(0);
    u32::try_from(seed).map_err(|_| {
        ErrorCode::Value.failure(format!(
            "--seed is {seed}; at most {} is possible",
            u32::MAX
        ))
    })
}

/// Numbers of the postures, from 1: measurements without a motion between them are in one.
fn postures(found: &Plan) -> Vec<usize> {
    let mut number = 0;
    let mut before: Option<&[f64]> = None;
    let each = found.measurements.iter().map(|m| {
        if before != Some(&m.shown) {
            number += 1;
        }
        before = Some(&m.shown);
        number
    });
    each.collect()
}

/// The loads that can be put on.
fn loads(args: &PlanMeasurementArgs, model: &Model) -> Answer<Vec<TestLoad>> {
    let at = BodyPoint {
        on: match &args.load_on {
            Some(name) => Body::named(&model.mechanism, name).map_err(|reason| {
                ErrorCode::UnknownName.failure(format!("--load-on '{name}': {reason}"))
            })?,
            None => Body::Tool,
        },
        at: match &args.load_at {
            Some(at) => vector("--load-at", at)? * 1e-3,
            None => Vector3::zeros(),
        },
    };
    for (option, load) in [("--mass-kg", args.mass_kg), ("--pull-n", args.pull_n)] {
        if let Some(load) = load.filter(|load| *load <= 0.0) {
            return Err(
                ErrorCode::Value.failure(format!("{option} is {load}; a load above 0 is needed"))
            );
        }
    }
    let mut forces = Vec::new();
    if let Some(mass) = args.mass_kg {
        let own = model.mechanism.gravity();
        // A model without weights says nothing of where down is: z is up in every base.
        let down = if own.norm() > 0.0 {
            own
        } else {
            Vector3::new(0.0, 0.0, -9.81)
        };
        forces.push(down * mass);
    }
    if let Some(pull) = args.pull_n {
        let directions: Vec<Vector3<f64>> = match args.pull_direction.is_empty() {
            true => vec![Vector3::x(), Vector3::y(), -Vector3::z()],
            false => args
                .pull_direction
                .chunks(3)
                .map(|d| vector("--pull-direction", d))
                .collect::<Answer<_>>()?,
        };
        for direction in directions {
            let unit = direction.try_normalize(1e-12).ok_or_else(|| {
                ErrorCode::Value.failure("--pull-direction: the direction has no length")
            })?;
            forces.push(unit * pull);
        }
    }
    let loads = forces.into_iter().filter(|f| f.norm() > 0.0);
    let loads: Vec<TestLoad> = loads.map(|force| TestLoad::force_at(at, force)).collect();
    match loads.is_empty() {
        true => {
            Err(ErrorCode::Missing.failure("nothing loads the tool: give --mass-kg, or --pull-n"))
        }
        false => Ok(loads),
    }
}

/// The job of `--work`; joints have `=`.
fn job_of_work(args: &PlanMeasurementArgs) -> Answer<Option<&Path>> {
    match args.work.iter().find(|words| !words.contains('=')) {
        Some(_) if args.work.len() > 1 || args.force.is_some() => Err(ErrorCode::Conflict.failure(
            "--work with a job states postures and loads itself: leave out --force and other --work",
        )),
        found => Ok(found.map(Path::new)),
    }
}

fn purpose(args: &PlanMeasurementArgs, model: &Model) -> Answer<Purpose> {
    if args.work.is_empty() {
        return Ok(match args.aim {
            None | Some(Aim::Average) => Purpose::Average,
            Some(Aim::Determinant) => Purpose::Determinant,
            Some(Aim::WorstDirection) => Purpose::WorstDirection,
        });
    }
    if let Some(job) = job_of_work(args)? {
        let work = work_of_job(job, &args.model, model)?;
        let places = work.into_iter().map(|place| place.observation);
        return Ok(Purpose::Compensation(places.collect()));
    }
    let force = args
        .force
        .as_deref()
        .ok_or_else(|| ErrorCode::Missing.failure("--work needs the load there: give --force"))?;
    let load = TestLoad::force_at(Vector3::zeros(), vector("--force", force)?);
    let axes = Axes::of(model);
    let test = args.work.iter().enumerate().map(|(i, words)| {
        Ok(Observation {
            posture: format!("work {}", i + 1),
            commands: commands(words, &axes, model)?,
            load,
            branch: None,
            readings: Reading::displacement(Vector3::zeros(), &Vector3::zeros(), 1.0).into(),
        })
    });
    Ok(Purpose::Compensation(test.collect::<Answer<_>>()?))
}

/// `A1=10,A2=-90`: degrees and millimetres; what is not named stays at home.
fn commands(words: &str, axes: &Axes<'_>, model: &Model) -> Answer<Vec<f64>> {
    let home = joints::home(&model.mechanism);
    let start = axes.shown(&home).unwrap_or_default();
    let names = axes.names().iter();
    let names: Vec<Named> = names
        .map(|(name, kind)| (name.clone(), *kind, unit(*kind).1))
        .collect();
    let words: Vec<String> = words.split(',').map(str::to_owned).collect();
    let shown = joints::read("--work", &words, &names, start)?;
    let commands = axes.commands(&shown);
    let commands = commands
        .ok_or_else(|| ErrorCode::Value.failure("--work: the axes do not fit the model"))?;
    match axes.beyond_limits(&commands).into_iter().next() {
        Some(beyond) => {
            Err(ErrorCode::OutsideLimits.failure(format!("--work '{}': {beyond}", words.join(","))))
        }
        None => Ok(commands),
    }
}

fn answer_of(args: &PlanMeasurementArgs, task: &PlanTask<'_>, found: &Plan) -> PlanAnswer {
    let axes = Axes::of(task.model);
    let numbers_of_postures = postures(found);
    let row = |(i, m): (usize, &PlannedMeasurement)| PlanRow {
        posture: numbers_of_postures[i].to_string(),
        axes: axes
            .names()
            .iter()
            .zip(&m.shown)
            .map(|((name, kind), x)| {
                let (unit, size) = unit(*kind);
                JointValue {
                    name: name.clone(),
                    value: x / size,
                    unit,
                }
            })
            .collect(),
        position_mm: (m.position * 1e3).into(),
        force_n: m.load.force.into(),
        expected_displacement_mm: 1e3 * m.expected,
    };
    let numbers = task.unknowns.list().iter().zip(&found.deviations);
    PlanAnswer {
        schema: 1,
        kinetostat_version: env!("CARGO_PKG_VERSION"),
        model: task.model.name().to_owned(),
        model_source: args.model.clone(),
        candidates: found.candidates,
        passed_over: found.passed_over,
        load_on: args.load_on.clone(),
        efficiency: found.efficiency,
        variance_of_random_plans: found.gain,
        left_error_mm: found.left_error.map(|e| 1e3 * e),
        numbers: numbers
            .map(|(unknown, deviation)| PlannedNumber {
                number: unknown.parameter.path.clone(),
                deviation_percent: deviation.map(|d| 100.0 * d),
            })
            .collect(),
        measurements: found.measurements.iter().enumerate().map(row).collect(),
    }
}

/// The way of the tool from posture to posture, seen from above.
fn picture(answer: &PlanAnswer) -> Plot {
    let places = answer
        .measurements
        .iter()
        .map(|m| (m.position_mm[0], m.position_mm[1]));
    Plot {
        title: format!(
            "{}: {} measurements from above",
            answer.model,
            answer.measurements.len()
        ),
        x_label: "x of the tool, mm".to_owned(),
        y_label: "y of the tool, mm".to_owned(),
        lines: vec![PlotLine::solid("way of the tool", 0, places.collect())],
        marks: Vec::new(),
    }
}

/// The table that `identify` reads: one row for each marker, readings empty.
fn table(task: &PlanTask<'_>, load_on: Option<&str>, found: &Plan) -> Answer<Vec<u8>> {
    let axes = Axes::of(task.model);
    let mut head = vec!["posture".to_owned()];
    head.extend(
        axes.names()
            .iter()
            .map(|(name, kind)| format!("{name}_{}", unit(*kind).0)),
    );
    for name in [
        "fx_n",
        "fy_n",
        "fz_n",
        "load_x_mm",
        "load_y_mm",
        "load_z_mm",
        "marker_x_mm",
        "marker_y_mm",
        "marker_z_mm",
        "dx_mm",
        "dy_mm",
        "dz_mm",
        "note",
    ] {
        head.push(name.to_owned());
    }
    head.extend(load_on.map(|_| "load_on".to_owned()));
    let mut rows = vec![head];
    for (posture, m) in postures(found).into_iter().zip(&found.measurements) {
        for marker in &task.markers {
            let mut row = vec![posture.to_string()];
            // A thousandth of a degree or of a millimetre is what a controller takes.
            let shown = axes.names().iter().zip(&m.shown);
            row.extend(shown.map(|((_, kind), x)| format!("{:.3}", x / unit(*kind).1)));
            // Zero has no sign.
            row.extend(m.load.force.iter().map(|f| cell(*f + 0.0)));
            row.extend(
                (m.load.at.at * 1e3)
                    .iter()
                    .chain((marker * 1e3).iter())
                    .map(|x| cell(*x)),
            );
            row.extend(["", "", "", ""].map(str::to_owned));
            row.extend(load_on.map(str::to_owned));
            rows.push(row);
        }
    }
    written(&rows)
}
