//! `kinetostat place`: where does the part lie best?
//!
//! It takes a job and where the part may lie, and gives the best placement with the next best ones, a map and a table. The
//! search is in the crate `kinetostat-placing`.

mod answer;
pub(crate) mod arguments;
mod part;
mod picture;
mod text;

use std::path::{Path, PathBuf};

use kinetostat_analysis::placing::{
    Effort, Fixture, Objective, Obstacle, PartBox, Placed, Question, Range, Space, Variable, place,
};
use kinetostat_diagnostic::ErrorCode;
use kinetostat_machining::{Placement, Task, Warning, WarningCode, analyse};
use serde_spanned::Spanned;

use crate::convert::for_run::refuse_unconvertible;
use crate::files::input_files::InputFiles;
use crate::files::outputs::{self, Existing, Outputs};
use crate::job::arguments::{ProgramArgs, WritingFlags};
use crate::job::job_file::JobFile;
use crate::job::of_model::machine_of;
use crate::job::place_table::{ObjectiveWord, PlaceTable};
use crate::job::program::read_program;
use crate::job::run_warnings;
use crate::job::setting::setting;
use crate::options::finite;
use crate::place::query::FARTHEST;
use crate::placing::answer::{AtBest, PlaceAnswer};
use crate::placing::arguments::PlacingArgs;
use crate::placing::part::beside_the_part;
use crate::program::aim::Aim;
use crate::program::solve::{forces_of, with_task};
use crate::ui::failure::{Answer, Failing};
use crate::ui::given::Given;
use crate::ui::json;
use crate::ui::progress::Progress;
use crate::ui::result_form::ResultForm;
use crate::ui::threads::in_threads;

/// Figures below this, mm or deg or shares, are none.
const NOTHING: f64 = 1e-9;

/// Upper limit of the placements that may fill the ranges.
const MOST_SAMPLES: usize = 1_000_000;

/// Results that the command gives as JSON.
pub(crate) const RESULTS: &[ResultForm] = &[ResultForm::of::<PlaceAnswer>("placements of a part")];

pub(crate) fn run(args: &PlacingArgs, given: &Given) -> Answer<()> {
    let files = InputFiles::default();
    let job = args.job.as_deref().map(|path| JobFile::read(&files, path));
    let job = job.transpose()?;
    let job = job.as_ref();
    let named = args.model.as_deref();
    refuse_what_says_nothing(&args.program)?;
    given.refuse(
        &["--load-at-corners", "--chord-tolerance-um", "--limit"],
        "is about a program that is compensated, and place writes none: leave it out",
    )?;
    if let Some(samples) = args.samples
        && !(1..=MOST_SAMPLES).contains(&samples)
    {
        return Err(ErrorCode::Value.failure(format!(
            "--samples {samples}: 1 to {MOST_SAMPLES} placements can fill the ranges"
        )));
    }
    let question = question(job, args)?;
    let mut setting = setting(&files, job, &args.program, &WritingFlags::default())?;
    let (machine, model) = machine_of(&mut setting, &files, job, named, &args.program)?;
    let read = read_program(&setting)?;
    refuse_unconvertible(&files, job, &args.program, &model, &machine)?;
    let states_orientation = read.path().moves.iter().any(|m| m.tool_turn.is_some());
    let space = space(job, args, machine.placement, states_orientation)?;

    let to_screen = args.json.as_deref() == Some(Path::new("-"));
    let existing = Existing::forced(args.program.force_overwrite);
    let mut claimed = Outputs::new(existing, setting.inputs.clone());
    let mut claim =
        |what, path: Option<&PathBuf>| path.map(|path| claimed.claim(what, path)).transpose();
    let json_out = claim("result", args.json.as_ref().filter(|_| !to_screen))?;
    let csv_out = claim("table of placements", args.csv.as_ref())?;
    let plot_out = claim("map", args.plot.as_ref())?;

    let progress = Progress::new();
    let forces = forces_of(&machine, &setting, read.path(), &progress)?;
    let effort = Effort {
        samples: args.samples,
        maps: args.plot.is_some() || args.csv.is_some(),
        ..Effort::default()
    };
    let search = |task: &Task<'_>| {
        let placed = place(task, &space, &question, effort, &progress)?;
        let at_best = placed.best.as_ref().map(|best| {
            let mut there = task.clone();
            there.placement = space.placement(&best.place);
            analyse(&there, &progress)
        });
        Ok((task.run_inputs.clone(), placed, at_best.transpose()?))
    };
    let found = with_task(
        Aim::Analyse,
        &machine,
        &setting,
        &read,
        forces.as_ref(),
        |task| in_threads(args.program.threads, || search(task)),
    )??;
    progress.finish();
    let (inputs, placed, at_best) =
        found.map_err(|error: kinetostat_machining::RunError| setting.within(error.into()))?;
    refuse_nowhere(&placed, &space)?;
    let mut warnings = at_best
        .as_ref()
        .map_or_else(Vec::new, |run| run.result.warnings.clone());
    warnings.extend(run_warnings::of_run(&model, job, &args.program));
    let part = question.part.as_ref();
    warnings.extend(part.and_then(|part| beside_the_part(part, read.path())));
    let figure = placed.best.as_ref().and_then(|best| best.figure);
    warnings.extend(figure.filter(|figure| figure.abs() < NOTHING).map(|_| {
        let text = "there is nothing to minimise: the figure is zero, for no load and no weight that counts is stated; state the load ([load], --force, --milling)";
        Warning::new(WarningCode::LoadNeverActs, text.to_owned())
    }));
    let result = at_best.as_ref().map(|run| &run.result);
    let answer = PlaceAnswer {
        schema: 1,
        kinetostat_version: env!("CARGO_PKG_VERSION"),
        model: inputs.model,
        program: setting.program_name.clone(),
        load: result.map_or_else(String::new, |result| result.run_inputs.load.clone()),
        files: inputs.files,
        objective: question.objective,
        unit: question.objective.unit(),
        placed,
        at_best: result.map(AtBest::of),
        warnings,
    };
    if let Some(index) = json_out {
        claimed.fill(index, json::json(&answer)?.as_bytes())?;
    }
    if let Some(index) = csv_out {
        claimed.fill(index, &picture::table(&answer.placed, &space)?)?;
    }
    if let Some(index) = plot_out {
        let drawing = picture::drawing(&answer, &space).ok_or_else(|| {
            ErrorCode::Unused.failure(
                "--plot: there is nothing to draw where only fixtures are compared: leave it out",
            )
        })?;
        claimed.fill(index, drawing.as_bytes())?;
    }
    let paths = claimed.commit()?;
    let text = text::answer_text(&answer, &space);
    let text = format!("{text}{}", outputs::written(&paths));
    json::print_answer(&text, &answer, to_screen)
}

/// Refuses a result without a feasible placement.
fn refuse_nowhere(placed: &Placed, space: &Space) -> Answer<()> {
    match &placed.nowhere {
        Some(nowhere) => Err(ErrorCode::NoAnswer.failure(text::nowhere_text(nowhere, space))),
        None => Ok(()),
    }
}

/// Options of other commands along a program that mean nothing here.
fn refuse_what_says_nothing(given: &ProgramArgs) -> Answer<()> {
    let turn = &given.turn;
    let writes = [&given.report, &given.pdf, &given.points, &given.vtk];
    let what = if writes.iter().any(|path| path.is_some()) {
        "--report, --pdf, --points and --vtk: give them to `kinetostat deflect` with the best placement"
    } else if given.language.is_some() || given.all_points || given.restart {
        "--language, --all-points and --restart: it writes no report and no table of points, and begins anew each time"
    } else if turn.free_turn || turn.stiff_turn || turn.turn_plot.is_some() {
        "--free-turn, --stiff-turn and --turn-plot: it turns the tool by --turn-tool-deg, the same along the whole program"
    } else if given.uncertain.uncertain.is_some() || given.uncertain.machines.is_some() {
        "--uncertain and --machines: one machine is solved, as the model says"
    } else {
        return Ok(());
    };
    Err(ErrorCode::Unused.failure(format!("place has no use for {what}")))
}

/// Largest turn allowed either way, degrees.
const MOST_DEG: f64 = 360.0;

fn written(table: &PlaceTable, variable: Variable) -> Option<&Spanned<[f64; 2]>> {
    match variable {
        Variable::X => table.x_mm.as_ref(),
        Variable::Y => table.y_mm.as_ref(),
        Variable::Z => table.z_mm.as_ref(),
        Variable::TurnX => table.turn_x_deg.as_ref(),
        Variable::TurnY => table.turn_y_deg.as_ref(),
        Variable::TurnZ => table.turn_z_deg.as_ref(),
        Variable::TurnTool => table.turn_tool_deg.as_ref(),
    }
}

fn option(args: &PlacingArgs, variable: Variable) -> Option<&Vec<f64>> {
    match variable {
        Variable::X => args.x_mm.as_ref(),
        Variable::Y => args.y_mm.as_ref(),
        Variable::Z => args.z_mm.as_ref(),
        Variable::TurnX => args.turn_x_deg.as_ref(),
        Variable::TurnY => args.turn_y_deg.as_ref(),
        Variable::TurnZ => args.turn_z_deg.as_ref(),
        Variable::TurnTool => args.turn_tool_deg.as_ref(),
    }
}

/// The ends of a range that are nonsense, in words.
fn fault(variable: Variable, [from, to]: [f64; 2]) -> Option<String> {
    let most = match variable.unit() {
        "mm" => 1e3 * FARTHEST,
        _ => MOST_DEG,
    };
    let far = [from, to]
        .into_iter()
        .find(|end| end.is_nan() || end.abs() > most);
    match far {
        Some(end) if variable.unit() == "mm" => Some(format!(
            "{end} mm leads more than 10 km away; coordinates are in mm"
        )),
        Some(end) => Some(format!(
            "{end} deg: turns from -360 to 360 degrees are allowed"
        )),
        None if from >= to => Some(format!(
            "the range from {from} to {to} is empty: the second number must be above the first"
        )),
        None => None,
    }
}

/// Search space of the part's placement.
fn space(
    job: Option<&JobFile>,
    args: &PlacingArgs,
    given: Placement,
    states_orientation: bool,
) -> Answer<Space> {
    let table = job.and_then(|j| j.job.place.as_ref());
    let table = table.map(Spanned::get_ref);
    let mut ranges = Vec::new();
    for variable in Variable::ALL {
        let ends = if let Some(values) = option(args, variable) {
            let name = format!("--{}", variable.name().replace('_', "-"));
            finite(&name, values)?;
            let ends = [values[0], values[1]];
            if let Some(fault) = fault(variable, ends) {
                return Err(ErrorCode::Value.failure(format!("{name}: {fault}")));
            }
            ends
        } else if let (Some(j), Some(ends)) = (job, table.and_then(|t| written(t, variable))) {
            if let Some(fault) = fault(variable, *ends.get_ref()) {
                let help = "write the smallest and the largest value, as in x_mm = [-40, 40]";
                return Err(j.error(ends, &fault, help));
            }
            *ends.get_ref()
        } else {
            continue;
        };
        let [from, to] = ends;
        ranges.push(Range { variable, from, to });
    }
    let fixtures = fixtures(job, table)?;
    Space::new(given, ranges, fixtures, states_orientation)
        .map_err(|error| ErrorCode::Value.failure(error.to_string()))
}

fn fixtures(job: Option<&JobFile>, table: Option<&PlaceTable>) -> Answer<Vec<Fixture>> {
    let (Some(job), Some(table)) = (job, table) else {
        return Ok(Vec::new());
    };
    let one = |written: &Spanned<crate::job::place_table::FixtureTable>| {
        let own = written.get_ref();
        let far = |x: &f64| x.is_nan() || x.abs() > 1e3 * FARTHEST;
        if own.part_origin_mm.iter().any(far) {
            let what = format!("the fixture '{}' lies more than 10 km away", own.name);
            return Err(job.error(written, &what, "coordinates are in mm"));
        }
        let orientation = own.part_orientation.as_ref().map(|table| {
            let pose = table.get_ref().pose();
            let pose = pose.map_err(|(message, help)| job.error(table, &message, &help))?;
            Answer::Ok(pose.rotation)
        });
        Ok(Fixture {
            name: own.name.clone(),
            origin_mm: own.part_origin_mm,
            orientation: orientation.transpose()?,
        })
    };
    table.fixtures.iter().map(one).collect()
}

/// Objective and obstacles.
fn question(job: Option<&JobFile>, args: &PlacingArgs) -> Answer<Question> {
    let table = job.and_then(|j| j.job.place.as_ref());
    let Some((job, table)) = job.zip(table.map(Spanned::get_ref)) else {
        return Ok(Question {
            objective: objective(args.objective),
            ..Question::default()
        });
    };
    let turned_round = |from: &[f64; 3], to: &[f64; 3]| {
        let grows = |k: usize| from[k] < to[k];
        !(0..3).all(grows)
    };
    let mut obstacles = Vec::new();
    for written in &table.obstacles {
        let own = written.get_ref();
        if turned_round(&own.from_mm, &own.to_mm) {
            let what = format!("the obstacle '{}' has no inside", own.name);
            let help = "write its smallest and its largest coordinates, each of from_mm below that of to_mm";
            return Err(job.error(written, &what, help));
        }
        obstacles.push(Obstacle {
            name: own.name.clone(),
            from_mm: own.from_mm,
            to_mm: own.to_mm,
        });
    }
    let mut part = None;
    if let Some(written) = &table.part_box_mm {
        let [from_mm, to_mm] = *written.get_ref();
        if turned_round(&from_mm, &to_mm) {
            let help = "write the smallest and the largest coordinates of the part, as in [[0, 0, -40], [200, 100, 0]]";
            return Err(job.error(written, "the box around the part has no inside", help));
        }
        part = Some(PartBox { from_mm, to_mm });
    }
    Ok(Question {
        objective: objective(args.objective.or(table.objective)),
        obstacles,
        part,
    })
}

fn objective(word: Option<ObjectiveWord>) -> Objective {
    match word {
        None | Some(ObjectiveWord::Error) => Objective::Error,
        Some(ObjectiveWord::Correction) => Objective::Correction,
        Some(ObjectiveWord::Tilt) => Objective::Tilt,
        Some(ObjectiveWord::Drive) => Objective::Drive,
        Some(ObjectiveWord::Buckling) => Objective::Buckling,
    }
}
