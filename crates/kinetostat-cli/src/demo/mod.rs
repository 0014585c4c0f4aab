//! `kinetostat demo`: a circular groove on a machine that bends and was not built quite right.
//!
//! It takes a directory and writes a whole example into it: model, job, program, and what `compensate` makes of
//! them.

use std::path::{Path, PathBuf};

use clap::Args;
use kinetostat_diagnostic::ErrorCode;
use kinetostat_machining::RunResult;
use kinetostat_model::preset_text;

use crate::files::input_files::InputFiles;
use crate::files::made_folder::in_folder;
use crate::files::outputs::Existing;
use crate::job::arguments::{ProgramArgs, WritingFlags};
use crate::job::job_file::JobFile;
use crate::job::machine::machine_setup;
use crate::job::setting::setting;
use crate::options::{EXIT_CODES, whole};
use crate::program::aim::Aim;
use crate::program::outputs::RunOutputs;
use crate::program::{report, solve, summary};
use crate::shown::in_report;
use crate::ui::failure::{Answer, Failing};
use crate::ui::layout::{listed, wrapped};
use crate::ui::result_form::ResultForm;
use crate::ui::safe_text::safe;

const PROGRAM: &str = "\
(circular groove, radius 25 mm, depth 2 mm)
G21 G90 G17 G94
T1 M6 (end mill, 8 mm)
S8000 M3
G0 X25 Y0 Z10
G0 Z2
G1 Z-2 F200 (plunge)
G3 X-25 Y0 I-25 J0 F600
G3 X25 Y0 I25 J0
G0 Z10
M5
M30
";

const JOB: &str = r#"# A circular groove on an Orthoglide whose legs were assembled one degree askew.
# From this directory:  kinetostat compensate job.toml --force-overwrite
schema = 1
model = "model.toml"
program = "original.ngc"

[placement]
part_origin_mm = [20, 20, 120]  # program zero in base axes; part axes parallel to the base

[tool]
length_mm = 100                 # tip along z of the platform

[load]                          # on feed moves; turns with the feed direction
milling = { radial_n = 215, tangential_n = -10, axial_n = -25 }
at_corners = "turns"            # in this example; unstated, it is an assumption

[tolerances]
path_um = 0.5                   # pieces against the corrected path
chord_um = 0.4                  # pieces of arcs, besides
decimals = 4

[output]
program = "compensated.ngc"
report = "report.html"
json = "result.json"
points = "points.csv"
"#;

const DEVIATIONS: &str = r#"
# One degree of assembly error: every leg is turned about the line of its own actuator.
[[deviation]]
limb = "leg x"
at = "line"
moved_by = { rotation_vector_deg = [1, 0, 0] }

[[deviation]]
limb = "leg y"
at = "line"
moved_by = { rotation_vector_deg = [1, 0, 0] }

[[deviation]]
limb = "leg z"
at = "line"
moved_by = { rotation_vector_deg = [1, 0, 0] }
"#;

/// Results that the command gives as JSON.
pub(crate) const RESULTS: &[ResultForm] = &[ResultForm::of::<RunResult>(
    "a program corrected by a model (result.json)",
)];

pub(crate) fn run(args: &DemoArgs) -> Answer<()> {
    in_folder(&args.out, || in_directory(args))
}

fn in_directory(args: &DemoArgs) -> Answer<()> {
    let preset = preset_text("orthoglide")
        .ok_or_else(|| ErrorCode::Internal.failure("the preset orthoglide is missing"))?;
    let model_text = format!("{preset}{DEVIATIONS}");
    let at = |name: &str| args.out.join(name);
    let sources = [
        ("model", at("model.toml"), model_text.as_str()),
        ("job file", at("job.toml"), JOB),
        ("program", at("original.ngc"), PROGRAM),
    ];
    let mut files = InputFiles::default();
    for (_, path, text) in &sources {
        files.insert(path.clone(), *text);
    }
    let flags = ProgramArgs::default();
    let job = JobFile::read(&files, &at("job.toml"))?;
    let mut setting = setting(&files, Some(&job), &flags, &WritingFlags::default())?;
    let mut inputs = Vec::new();
    let (machine, model) = machine_setup(&files, Some(&job), None, &flags, None, &mut inputs)?;
    // The demo's own inputs are written together with its results.
    setting.inputs.clear();
    let existing = if args.force_overwrite {
        Existing::Replace
    } else {
        Existing::KeepSame
    };
    let mut outputs = RunOutputs::claim(Aim::Compensate, &setting.targets, existing, &[])?;
    for (what, path, text) in &sources {
        let index = outputs.files.claim(what, path)?;
        outputs.files.fill(index, text.as_bytes())?;
    }
    let mut run = solve::solve(Aim::Compensate, &machine, &model, &setting, args.threads)?;
    // The demo may run again on another day and finds its own files.
    run.result.run_inputs.date = None;
    outputs.list(false, &model);
    let shown = in_report::of_run(&outputs, &setting, &machine, &model, &run)?;
    outputs.fill(&run, &setting, None, shown.as_ref())?;
    outputs.files.commit()?;
    let mut text = wrapped(
        "An Orthoglide mills a circular groove, radius 25 mm. Its links bend under the milling force (215 N to the right of the feed, -10 N along it, -25 N along z), and each of its legs was assembled one degree askew.",
        0,
    );
    text.push('\n');
    text.push_str(&summary::of_run(&run.result));
    text.push_str(&next(&args.out));
    report::print_run(&text, args.json.then_some(&run.result))?;
    report::refuse_missed_tolerance(&run.result.tolerance, &setting)?;
    report::refuse_doubtful(&run.result, &setting)
}

fn next(out: &Path) -> String {
    let name = |file: &str| safe(&PathBuf::from(out).join(file).display().to_string());
    let rows = [
        ("report.html", "the report: open it in a browser"),
        ("original.ngc", "the program as it was"),
        ("compensated.ngc", "the program that cuts where it should"),
        ("points.csv", "the points, for a spreadsheet"),
        ("result.json", "the figures, for other programs"),
        ("model.toml", "the machine, with its deviations"),
        ("job.toml", "the question: load, placement, tolerances"),
    ]
    .map(|(file, what)| vec![name(file), what.to_owned()]);
    format!(
        "\nWritten\n{}\nNext\n  open {}\n  cd {} && kinetostat compensate job.toml --force-overwrite\n      change job.toml or model.toml and see what follows\n  kinetostat check orthoglide\n      what is that machine?\n",
        listed(&rows, 2),
        name("report.html"),
        safe(&out.display().to_string()),
    )
}

/// Mill a circular groove on a bending machine: the first look
///
/// Writes the program, the compensated program, the report, the result and the points, and the
/// model and job files that repeat the run.
#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES)]
pub(crate) struct DemoArgs {
    /// Directory for the files; it is made if it does not exist
    #[arg(long, value_name = "DIR", default_value = "kinetostat-demo")]
    pub(crate) out: PathBuf,
    /// Overwrite files of the same names in it
    #[arg(long)]
    pub(crate) force_overwrite: bool,
    /// Print the result as JSON; the text goes to the standard error
    #[arg(long)]
    pub(crate) json: bool,
    /// Number of threads; all cores without it
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = whole)]
    pub(crate) threads: Option<usize>,
}
