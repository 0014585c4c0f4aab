//! `kinetostat view`: a machine in three dimensions, in the browser.
//!
//! It takes a model or a job, or asks for both, serves a page on this computer and answers what the page asks; or writes the page with
//! its results as one file.

#[cfg(feature = "view")]
mod asked;
#[cfg(feature = "view")]
mod dropped;
#[cfg(feature = "view")]
mod openapi;
#[cfg(feature = "view")]
mod serve;
#[cfg(feature = "view")]
mod served;

use std::path::{Path, PathBuf};

use clap::Args;

use crate::files::outputs::{self, Existing, Outputs};
use crate::options::{EXIT_CODES, number, vector, whole};
use crate::place::arguments::PlaceArgs;
use crate::place::joints;
use crate::shown::answer::{Exported, StateRequest};
use crate::shown::session::Session;
use crate::ui::failure::{Answer, Failure};
use crate::ui::result_form::ResultForm;
use crate::ui::screen::{self, Stream};

/// A machine in three dimensions, in the browser: move it, load it, see it bend
///
/// The page shows the machine with its limbs, joints and platforms, as it is commanded and, larger than it is, as it bends under a
/// load; joints, tool and force are moved by hand, and every figure is computed anew. With a job, the path of its program is coloured
/// by the error of the tool, before and after compensation. Without anything it asks the questions of `kinetostat start` first, and files
/// that are dropped onto it are shown. The page comes from this program and goes to this computer only; Ctrl-C ends it.
#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES, after_long_help = HELP)]
pub(crate) struct ViewArgs {
    /// Preset, model file, or job file; without one the page asks the questions of `kinetostat start`
    #[arg(value_name = "MODEL|JOB")]
    subject: Option<String>,
    /// Start with the tool's tip here, mm, base axes
    #[arg(long, num_args = 3, value_names = ["X", "Y", "Z"], allow_negative_numbers = true, value_parser = number, requires = "subject")]
    at: Option<Vec<f64>>,
    /// Start with these joints, deg and mm, as in shoulder=30 rail=250; others at home
    #[arg(long, num_args = 1.., value_name = "JOINT=VALUE", value_delimiter = ',', conflicts_with = "at", requires = "subject")]
    joints: Vec<String>,
    /// Start with this force on the tool, N, base axes
    #[arg(long, num_args = 3, value_names = ["FX", "FY", "FZ"], allow_negative_numbers = true, value_parser = number, requires = "subject")]
    force: Option<Vec<f64>>,
    /// Start with this moment on the tool, N m, base axes
    #[arg(long, num_args = 3, value_names = ["MX", "MY", "MZ"], allow_negative_numbers = true, value_parser = number, requires = "subject")]
    moment: Option<Vec<f64>>,
    /// Port on this computer [default: any that is free]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = whole, conflicts_with = "export")]
    port: Option<usize>,
    /// Say where the page is and open no browser
    #[arg(long, conflicts_with = "export")]
    no_browser: bool,
    /// Write the page with its results as one file, which needs no server
    #[arg(
        long,
        value_name = "FILE",
        help_heading = "Outputs",
        requires = "subject"
    )]
    export: Option<PathBuf>,
    /// Overwrite an existing file
    #[arg(long, help_heading = "Outputs", requires = "export")]
    force_overwrite: bool,
}

const HELP: &str = "\
Examples:
  kinetostat view
  kinetostat view orthoglide
  kinetostat view my_robot.toml --joints A1=30 --force 0 300 -500
  kinetostat view job.toml
  kinetostat view job.toml --export part.html

Exit codes:
  0    answered
  1    wrong input: a file, a number or an option; the message says which
  2    no answer: a place that cannot be reached, a program that cannot be run
  130  stopped with Ctrl-C";

/// Results that the command gives as JSON: what an exported page holds.
pub(crate) const RESULTS: &[ResultForm] =
    &[ResultForm::of::<Exported>("results in an exported page")];

pub(crate) fn run(args: &ViewArgs) -> Answer<()> {
    let Some(named) = &args.subject else {
        return served(args, None);
    };
    let (session, start) = session(args, named)?;
    match &args.export {
        Some(file) => export(args, file, &session, &start),
        None => served(args, Some((session, start))),
    }
}

/// What is shown, and its first state.
fn session(args: &ViewArgs, named: &str) -> Answer<(Session, StateRequest)> {
    let session = Session::open(named)?;
    let triple = |option: &str, given: &Option<Vec<f64>>| {
        let found = given.as_deref().map(|v| vector(option, v)).transpose()?;
        Ok::<_, Failure>(found.map(Into::into))
    };
    let place = PlaceArgs {
        joints: args.joints.clone(),
        ..PlaceArgs::default()
    };
    let commands = joints::given(&session.model, &place)?;
    let start = StateRequest {
        actuators: commands.map(|own| {
            let values = joints::of_model(&session.model.mechanism, &own);
            values.into_iter().map(|value| value.value).collect()
        }),
        at_mm: triple("--at", &args.at)?,
        place: None,
        force_n: triple("--force", &args.force)?,
        moment_n_m: triple("--moment", &args.moment)?,
    };
    // What cannot be shown is said here rather than in the browser.
    session.state_answer(&start)?;
    Ok((session, start))
}

fn export(args: &ViewArgs, file: &Path, session: &Session, start: &StateRequest) -> Answer<()> {
    let inputs = session.path.iter().cloned().collect();
    let mut outputs = Outputs::new(Existing::forced(args.force_overwrite), inputs);
    let index = outputs.claim("page", file)?;
    let page = session.page(start, false)?;
    outputs.fill(index, page.as_bytes())?;
    let paths = outputs.commit()?;
    screen::print(Stream::Out, &outputs::written(&paths))
}

/// The page with a machine in it, or with the questions of `start`.
#[cfg(feature = "view")]
fn served(args: &ViewArgs, shown: Option<(Session, StateRequest)>) -> Answer<()> {
    use crate::view::served::Served;
    let (served, words, hash) = match shown {
        Some((session, start)) => {
            let words = format!("{} in three dimensions", session.named);
            let state = serde_json::to_string(&start).unwrap_or_default();
            (Served::of(session), words, serve::in_url(&state))
        }
        None => (Served::asking()?, "Questions".to_owned(), String::new()),
    };
    serve::serve(args.port, !args.no_browser, served, &words, &hash)
}

#[cfg(not(feature = "view"))]
fn served(_: &ViewArgs, _: Option<(Session, StateRequest)>) -> Answer<()> {
    use crate::ui::failure::Failing;
    Err(kinetostat_diagnostic::ErrorCode::NotBuiltIn.failure(
        "this build has no server: write the page as a file (--export), or take the command line (cargo install, feature view)",
    ))
}
