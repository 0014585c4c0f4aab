//! `kinetostat identify`: numbers of a model from measured deflections.
//!
//! It takes a model and a table of measurements and gives the numbers with what is known of them, a model file with them, and their
//! uncertainty.

mod answer;
mod report;
mod text;

use std::path::{Path, PathBuf};

use clap::Args;
use kinetostat_diagnostic::{Diagnostic, ErrorCode, Location};
use kinetostat_identification::{
    Axes, DEVIATION, FitOptions, Identification, IdentificationError, MARKER_ERROR, MeasuredRow,
    Observation, Reading, TableFault, Theory, Unknowns, identification, identified_model,
    into_base, observations, places, read_table,
};
use kinetostat_model::Model;

use crate::files::answer_files::{AnswerFiles, ClaimedFiles, Shown};
use crate::files::input_files::InputFiles;
use crate::identify::answer::{IdentifyAnswer, InstrumentPlace, WorkError};
use crate::options::{number, whole};
use crate::program::paper::refuse_without_pdf;
use crate::program::work::work_of_job;
use crate::ui::csv_table::{cell, written};
use crate::ui::failure::{Answer, Failing, Failure};
use crate::ui::result_form::ResultForm;

/// Stiffnesses of a machine from measured deflections
///
/// Pull at the tool with a known force, or hang a known mass on it, in some fifteen postures, and read how far it moves: with a
/// laser tracker, or with a dial gauge. The stiffnesses that fit the readings best are found, with what the readings can and cannot
/// tell of them.
#[derive(Debug, Args)]
#[command(after_help = crate::options::EXIT_CODES, after_long_help = HELP)]
pub(crate) struct IdentifyArgs {
    /// Preset or model file
    #[arg(value_name = "MODEL")]
    pub(crate) model: String,
    /// Table of the measurements (CSV, XLSX or Parquet, see below)
    #[arg(long, value_name = "FILE")]
    pub(crate) measured: PathBuf,
    /// Numbers to identify: paths as in `chain.arm.A2.stiffness_n_m_per_rad`, * for any text;
    /// `joints` for the stiffness of every drive; `geometry` for errors of the links, from places
    #[arg(long, value_name = "NUMBER", num_args = 1.., default_value = "joints")]
    pub(crate) numbers: Vec<String>,
    /// Readings are in the instrument's own frame: find it from places (x_mm, ...) without a load
    #[arg(long)]
    pub(crate) find_frame: bool,
    /// Standard deviation of a reading where the table has none, mm [default: 0.02]
    #[arg(long, value_name = "MM", allow_negative_numbers = true, value_parser = number)]
    pub(crate) sigma_mm: Option<f64>,
    /// Friction of the drives, too, from rows with `branch` loading and unloading
    #[arg(long)]
    pub(crate) friction: bool,
    /// How far the model's numbers are trusted, percent: what the readings do not tell stays near them
    #[arg(long, value_name = "PERCENT", allow_negative_numbers = true, value_parser = number)]
    pub(crate) prior_percent: Option<f64>,
    /// Readings far from the fit count less, so that a few bad ones spoil little
    #[arg(long)]
    pub(crate) robust: bool,
    /// Intervals from fits to N drawings of as many postures (bootstrap), in place of Student's; 1000 are usual
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = whole, conflicts_with = "prior_percent")]
    pub(crate) resamples: Option<usize>,
    /// Displacements in proportion to the load, without weights: as textbooks do
    #[arg(long)]
    pub(crate) small_loads: bool,
    /// Job of the work that the machine is for: what is left along its program before and after
    #[arg(long, value_name = "JOB")]
    pub(crate) work: Option<PathBuf>,
    /// Model file with the identified numbers, their standard deviations and correlations
    #[arg(long, short, value_name = "FILE", help_heading = "Outputs")]
    pub(crate) out: Option<PathBuf>,
    /// The report with pictures, as one HTML file
    #[arg(long, value_name = "FILE", help_heading = "Outputs")]
    pub(crate) report: Option<PathBuf>,
    /// The report as PDF
    #[arg(long, value_name = "FILE", help_heading = "Outputs")]
    pub(crate) pdf: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) outputs: AnswerFiles,
}

const HELP: &str = "\
The table is CSV (commas, semicolons or tabs), XLSX (the first sheet) or
Parquet. Its columns:
  posture              name; rows of the same name share its errors
  A1_deg, A2_deg, ...  axes as the controller shows them, or the model's joints
  fx_n, fy_n, fz_n     force, base axes; mx_n_m, my_n_m, mz_n_m: moment
  mass_kg              mass that hangs on the machine
  load_on              node or body on which they act (the tool without it)
  load_x_mm, ...       where they act, in the frame of the tool or node
  marker_on, marker_x_mm, ...  the point that is read, in the same way
  dx_mm, dy_mm, dz_mm  its displacement by the load, base axes (_um, _m)
  x_mm, y_mm, z_mm     its place, loaded and (loads of zero) unloaded
  rx_mrad, ...         turn of the tool or node by the load (_deg, _rad, _urad)
  gauge_mm, gauge_x, gauge_y, gauge_z  a dial gauge, and where it counts up
  sigma_mm             standard deviation of this row
  branch               loading or unloading (--friction)
  note                 anything

Examples:
  kinetostat identify my_robot.toml --measured pulls.csv -o identified.toml
  kinetostat identify my_robot.toml --measured pulls.xlsx --work milling.toml \\
      --report pulls.html
  kinetostat identify my_robot.toml --measured places.csv \\
      --numbers joints geometry -o identified.toml
  kinetostat identify my_robot.toml --measured pulls.csv --robust \\
      --numbers joints chain.arm.tilt*.stiffness_n_m_per_rad --prior-percent 50

Exit codes:
  0    answered
  1    wrong input: a file, a number or an option; the message says which
  2    no answer: the fit does not settle, or a posture has no equilibrium
  130  stopped with Ctrl-C; nothing was written";

/// Resampled fits between whose percentiles an interval lies.
const FEWEST: usize = 100;
const MOST: usize = 100_000;

/// Postures from which others are drawn, at least.
const FEWEST_POSTURES: usize = 8;

/// Results that the command gives as JSON.
pub(crate) const RESULTS: &[ResultForm] = &[ResultForm::of::<IdentifyAnswer>("identified numbers")];

impl From<IdentificationError> for Failure {
    fn from(error: IdentificationError) -> Self {
        match error {
            IdentificationError::Model(error) => error.into(),
            IdentificationError::NoNumber { .. } => ErrorCode::UnknownName.failure(error),
            IdentificationError::NotIdentified { .. } | IdentificationError::NeedsLoads { .. } => {
                ErrorCode::Value.failure(error)
            }
            IdentificationError::NotConverged { .. } => ErrorCode::NotConverged.failure(error),
            IdentificationError::Free { .. } => ErrorCode::FreeDirection.failure(error),
            other => ErrorCode::NoAnswer.failure(other),
        }
    }
}

pub(crate) fn run(args: &IdentifyArgs) -> Answer<()> {
    let files = InputFiles::default();
    let (model, path) = files.model(&args.model, Path::new(""))?;
    model.require_stiffness()?;
    let name = args.measured.display().to_string();
    let mut inputs: Vec<PathBuf> = path.into_iter().collect();
    inputs.push(args.measured.clone());
    inputs.extend(args.work.clone());
    if args.pdf.is_some() {
        refuse_without_pdf()?;
    }
    if let Some(count) = args.resamples.filter(|n| !(FEWEST..=MOST).contains(n)) {
        return Err(ErrorCode::Value.failure(format!(
            "--resamples {count}: {FEWEST} to {MOST} tell an interval"
        )));
    }
    let mut claimed = ClaimedFiles::claim(&args.outputs, &inputs)?;
    let mut claim = |what, path: &Option<PathBuf>| {
        path.as_ref()
            .map(|path| claimed.claim_also(what, path))
            .transpose()
    };
    let out = claim("model", &args.out)?;
    let report_file = claim("report", &args.report)?;
    let pdf_file = claim("report", &args.pdf)?;
    let Question {
        unknowns,
        observations,
        instrument,
    } = question(args, &files, &model, &name)?;
    let options = FitOptions {
        theory: if args.small_loads {
            Theory::SmallLoads
        } else {
            Theory::Loaded
        },
        robust: args.robust,
        prior: prior(args)?,
    };
    let found = identification(&unknowns, &observations, &options)?;
    let found = match args.resamples {
        Some(_) if found.postures < FEWEST_POSTURES => {
            return Err(ErrorCode::NoAnswer.failure(format!(
                "{name} has {} postures: --resamples needs at least {FEWEST_POSTURES} to draw from",
                found.postures
            )));
        }
        Some(count) => found.with_resampled_intervals(&unknowns, count),
        None => found,
    };
    let work = match &args.work {
        Some(job) => errors_at_work(job, args, &model, &unknowns, &found)?,
        None => Vec::new(),
    };
    if let Some(index) = out {
        let identified = identified_model(&model, &found, &name)?;
        let head = format!(
            "# Numbers of {} identified from {name} by kinetostat {}.\n",
            args.model,
            env!("CARGO_PKG_VERSION")
        );
        claimed.fill(index, format!("{head}{}", identified.text).as_bytes())?;
    }
    let answer = IdentifyAnswer {
        schema: 1,
        kinetostat_version: env!("CARGO_PKG_VERSION"),
        model: model.name().to_owned(),
        model_source: args.model.clone(),
        measurements: name,
        small_loads: args.small_loads,
        robust: args.robust,
        instrument,
        found,
        work,
    };
    if report_file.is_some() || pdf_file.is_some() {
        let document = report::report(&answer, &model.mechanism, &observations);
        if let Some(index) = report_file {
            claimed.fill(index, document.html().as_bytes())?;
        }
        if let Some(index) = pdf_file {
            let bytes = document.pdf();
            let bytes = bytes.map_err(|error| ErrorCode::Internal.failure(error.to_string()))?;
            claimed.fill(index, &bytes)?;
        }
    }
    let shown = Shown {
        text: text::answer_text(&answer),
        csv: table(&answer.found)?,
        svg: report::residuals(&answer).svg(),
        failure: None,
    };
    claimed.finish(&shown, &answer)
}

/// Unknowns and observations of a command.
struct Question {
    unknowns: Unknowns,
    observations: Vec<Observation>,
    /// Frame of the instrument in the base, if it was found.
    instrument: Option<InstrumentPlace>,
}

fn question(
    args: &IdentifyArgs,
    files: &InputFiles,
    model: &Model,
    name: &str,
) -> Answer<Question> {
    let patterns: Vec<&str> = args.numbers.iter().map(String::as_str).collect();
    let unknowns = Unknowns::matching(model, &patterns)?;
    let is_geometry = (args.numbers.iter()).any(|n| n == "geometry" || n.starts_with("deviation."));
    if is_geometry && (args.small_loads || args.find_frame) {
        return Err(ErrorCode::Conflict.failure(
            "geometry is identified from places in the frame of the base: leave --small-loads out, which knows displacements only, and --find-frame, which takes the geometry of the model for right",
        ));
    }
    let unknowns = match args.friction {
        true => unknowns.with_friction(model),
        false => unknowns,
    };
    let mut rows = rows(args, files, model, name)?;
    let instrument = match args.find_frame {
        true => {
            let found = into_base(&mut rows, &model.mechanism);
            let found = found.map_err(|e| ErrorCode::FileForm.failure(format!("{name}: {e}")))?;
            Some(InstrumentPlace::from(found))
        }
        false => None,
    };
    let gravity = model.mechanism.gravity();
    let observations = match is_geometry {
        true => places(&rows, &gravity),
        false => observations(&rows, &gravity),
    };
    let observations = observations.map_err(|faults| of_table(name, &faults))?;
    let unknowns = match is_geometry {
        true if !observations
            .iter()
            .flat_map(|o| &o.readings)
            .any(Reading::is_place) =>
        {
            return Err(ErrorCode::Missing.failure(format!(
                "{name}: geometry is identified from places; the table has no x_mm, y_mm, z_mm"
            )));
        }
        true => unknowns.with_markers(&observations, MARKER_ERROR),
        false => unknowns,
    };
    Ok(Question {
        unknowns,
        observations,
        instrument,
    })
}

/// Errors along the program of a job, before and after.
fn errors_at_work(
    job: &Path,
    args: &IdentifyArgs,
    model: &Model,
    unknowns: &Unknowns,
    found: &Identification,
) -> Answer<Vec<WorkError>> {
    let places = work_of_job(job, &args.model, model)?;
    let (paths, observations): (Vec<f64>, Vec<Observation>) = places
        .into_iter()
        .map(|place| (place.path_mm, place.observation))
        .unzip();
    let errors = found.at_work(unknowns, &observations, Theory::Loaded)?;
    let each = paths.into_iter().zip(errors);
    Ok(each
        .map(|(path_mm, error)| WorkError { path_mm, error })
        .collect())
}

fn prior(args: &IdentifyArgs) -> Answer<Option<f64>> {
    match args.prior_percent {
        Some(percent) if percent <= 0.0 => Err(ErrorCode::Value.failure(format!(
            "--prior-percent is {percent}; a standard deviation above 0 is needed"
        ))),
        percent => Ok(percent.map(|p| 0.01 * p)),
    }
}

fn rows(
    args: &IdentifyArgs,
    files: &InputFiles,
    model: &Model,
    name: &str,
) -> Answer<Vec<MeasuredRow>> {
    let deviation = 1e-3 * args.sigma_mm.unwrap_or(1e3 * DEVIATION);
    if deviation <= 0.0 {
        return Err(ErrorCode::Value.failure(format!(
            "--sigma-mm is {}; a standard deviation above 0 is needed",
            1e3 * deviation
        )));
    }
    let text = files.table("table of measurements", &args.measured)?;
    let mut rows = read_table(&text, &Axes::of(model)).map_err(|faults| of_table(name, &faults))?;
    for row in &mut rows {
        row.deviation.get_or_insert(deviation);
    }
    Ok(rows)
}

/// All faults of a table in one message.
pub(crate) fn of_table(name: &str, faults: &[TableFault]) -> Failure {
    let line = |fault: &TableFault| {
        let column = fault
            .column
            .as_ref()
            .map_or_else(String::new, |c| format!(", column {c}"));
        let found = fault
            .found
            .as_ref()
            .filter(|f| !f.is_empty())
            .map_or_else(String::new, |f| format!(" ('{f}')"));
        format!("{name}:{}{column}{found}: {}", fault.line, fault.message)
    };
    let lines: Vec<String> = faults.iter().map(line).collect();
    let diagnostics = faults.iter().map(|fault| {
        let mut diagnostic = Diagnostic::new(ErrorCode::FileForm, fault.message.clone());
        diagnostic.location = Location {
            file: Some(name.to_owned()),
            line: Some(fault.line),
            name: fault.column.clone(),
            ..Location::default()
        };
        diagnostic.found = fault.found.clone();
        diagnostic
    });
    ErrorCode::FileForm
        .failure(lines.join("\n"))
        .with_faults(diagnostics)
}

/// One row for each posture; residuals in standard deviations.
fn table(found: &Identification) -> Answer<Vec<u8>> {
    let head = [
        "posture",
        "readings",
        "before_sigma",
        "after_sigma",
        "left_out_sigma",
    ];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    rows.extend(found.residuals.iter().map(|r| {
        let left_out = r.left_out.map_or_else(String::new, cell);
        vec![
            r.posture.clone(),
            r.readings.to_string(),
            cell(r.before),
            cell(r.after),
            left_out,
        ]
    }));
    written(&rows)
}
