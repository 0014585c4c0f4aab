//! `kinetostat check`: what a model or a job file says, in words, and what looks wrong.
//!
//! It takes a model, a job, or a model with poses measured on the machine, and gives findings; it solves a model at
//! home only.

pub(crate) mod job;
mod model;
mod poses;

use std::path::{Path, PathBuf};

use clap::Args;
use kinetostat_diagnostic::ErrorCode;

use crate::check::model::findings::{Findings, findings};
use crate::check::model::text::answer_text;
use crate::files::file_kind::FileKind;
use crate::files::input_files::InputFiles;
use crate::options::{EXIT_CODES, number, vector};
use crate::ui::failure::{Answer, Failing};
use crate::ui::json;
use crate::ui::result_form::ResultForm;

/// Results that the command gives as JSON.
pub(crate) const RESULTS: &[ResultForm] = &[
    ResultForm::of::<Findings>("a model"),
    ResultForm::of::<job::JobFindings>("a job"),
    ResultForm::of::<poses::PoseComparison>("a model beside measured poses"),
];

pub(crate) fn run(args: &CheckArgs) -> Answer<()> {
    let file = Path::new(&args.model);
    if FileKind::of_file(file) == Some(FileKind::Job) {
        if args.pose.is_some() || args.force.is_some() {
            return Err(ErrorCode::Unused.failure(
                "--pose and --force check a model, and this is a job file: name its model instead",
            ));
        }
        return job::run(file, args.json);
    }
    let (model, path) = InputFiles::default().model(&args.model, Path::new(""))?;
    let source = match path {
        Some(_) => args.model.clone(),
        None => format!("preset {}", args.model),
    };
    if let Some(file) = &args.pose {
        return poses::run(&model, &source, file, args.pose_tolerance_mm, args.json);
    }
    let force = args.force.as_deref().map(|f| vector("--force", f));
    let force = force.transpose()?;
    let findings = findings(&model, source, force);
    let text = answer_text(&findings, &model, force.is_some());
    json::print_answer(&text, &findings, args.json)
}

/// What a model file or a job file says, in words
///
/// Of a model: platforms, limbs, actuators with units and limits, passive joints, springs, masses;
/// mobility, stiffness at home, effect of deviations, stability under gravity; and everything that
/// looks wrong. Of a job: its model, program, placement, load and outputs, and whether the ends of
/// the program can be reached; the program is read, not run.
#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES, after_long_help = CHECK_HELP)]
pub(crate) struct CheckArgs {
    /// Preset, model file or job file
    #[arg(value_name = "MODEL|JOB")]
    pub(crate) model: String,
    /// Load on the tool by which deflections are judged, N, base axes; 1 kN along each axis without it
    #[arg(long, num_args = 3, value_names = ["FX", "FY", "FZ"], allow_negative_numbers = true, value_parser = number)]
    pub(crate) force: Option<Vec<f64>>,
    /// Compare with poses jogged on the machine instead: a table (CSV) or TOML with joint values and
    /// the measured pose of the tool
    #[arg(long, value_name = "FILE")]
    pub(crate) pose: Option<PathBuf>,
    /// How far apart such poses may be, mm; 0.1 degrees for each millimetre
    #[arg(long, value_name = "MM", default_value = "1", requires = "pose", allow_negative_numbers = true, value_parser = number)]
    pub(crate) pose_tolerance_mm: f64,
    /// Print the findings as JSON; the text goes to the standard error
    #[arg(long)]
    pub(crate) json: bool,
}

const CHECK_HELP: &str = "\
Examples:
  kinetostat check orthoglide
  kinetostat check my_robot.toml --force 0 0 -500
  kinetostat check job.toml

Exit codes:
  0    answered
  1    wrong input: a file, a number or an option; the message says which
  2    no answer: not converged, or a point that cannot be reached
  130  stopped with Ctrl-C; nothing was written";
