//! `kinetostat map`: stiffness, and deflection under a load, on a grid of places.

mod answer;
pub(crate) mod arguments;
mod picture;
mod query;
mod text;

use kinetostat::Wrench;
use kinetostat_machining::{MapPlace, MapTask, Warning, large_load, map, straight_tool};
use kinetostat_report::Cell;

use crate::files::input_files::InputFiles;
use crate::files::outputs::{self, Existing, Outputs};
use crate::machine::model_warnings::{deviations_in_words, no_potential, of_model};
use crate::map::answer::{Figures, MapAnswer, Places};
use crate::map::arguments::{MapArgs, Quantity};
use crate::map::picture::Picture;
use crate::map::query::{grid, load};
use crate::map::text::Columns;
use crate::place::orientation;
use crate::ui::failure::{Answer, Failure};
use crate::ui::numbers::{load_triple, short};
use crate::ui::progress::Progress;
use crate::ui::{json, threads};

pub(crate) fn run(args: &MapArgs) -> Answer<()> {
    let (model, path) = InputFiles::default().model(&args.model, std::path::Path::new(""))?;
    let length = args.tool_length_mm.unwrap_or(0.0);
    if length.abs() > 1e5 {
        return Err(Failure::input(format!(
            "--tool-length-mm is {length}; tools are shorter than 100 m"
        )));
    }
    let mechanism = model.mechanism.with_tool(&straight_tool(1e-3 * length));
    let home = mechanism.platforms()[mechanism.tool()].home;
    let grid = grid(args, (home.translation.vector * 1e3).into())?;
    let asked = match &args.rotation {
        Some(text) => Some(orientation::option_or_follows("--rotation", text)?),
        None => None,
    };
    let rotation = asked.flatten().unwrap_or(home.rotation);
    let follows = asked.map_or_else(|| mechanism.turns_as_it_moves(), |a| a.is_none());
    let load = load(args)?;
    if load.is_none() && matches!(args.show, Quantity::Displacement | Quantity::Rotation) {
        return Err(Failure::input(
            "--show displacement and --show rotation need a load; give --force or --moment",
        ));
    }
    let picture = Picture::new(args, &grid)?;
    let task = MapTask {
        mechanism: &mechanism,
        grid,
        orientation: rotation,
        orientation_follows: follows,
        load,
    };
    let existing = Existing::forced(args.force_overwrite);
    let mut outputs = Outputs::new(existing, path.iter().cloned().collect());
    let csv = args.csv.as_ref().map(|p| outputs.claim("table", p));
    let csv = csv.transpose()?;
    let plot = args.plot.as_ref().map(|p| outputs.claim("plot", p));
    let plot = plot.transpose()?;
    let work = || solve(&task, &mut outputs, csv, picture);
    let (figures, picture) = threads::in_threads(args.threads, work)??;
    if let Some(failure) = without_figures(&task, &figures.places) {
        return Err(failure);
    }
    let mut warnings: Vec<Warning> = of_model(&model).collect();
    warnings.extend(no_potential(&model.mechanism));
    warnings.extend(load.iter().flat_map(large_load));
    let turned = figures.largest_turn_deg;
    if follows {
        warnings.push(orientation::follows(turned, asked.is_some(), true));
    }
    let answer = MapAnswer {
        schema: 3,
        kinetostat_version: env!("CARGO_PKG_VERSION"),
        model: model.name().to_owned(),
        model_source: match &path {
            Some(_) => args.model.clone(),
            None => format!("preset {}", args.model),
        },
        tool: match length {
            0.0 => "none: the platform's own point".to_owned(),
            length => format!("{} mm along z of the flange", short(length)),
        },
        rotation_vector_deg: rotation.scaled_axis().map(f64::to_degrees).into(),
        max_tool_turn_deg: follows.then_some(turned),
        grid: grid.into(),
        loaded: load.is_some(),
        force_n: load.map_or([0.0; 3], |w| w.force().into()),
        moment_n_m: load.map_or([0.0; 3], |w| w.moment().into()),
        deviations: deviations_in_words(&model),
        places: figures.places,
        figures: figures.answer(load.is_some()),
        warnings,
    };
    if let Some(index) = plot {
        outputs.fill(index, picture.svg(&answer).as_bytes())?;
    }
    let paths = outputs.commit()?;
    let text = text::in_words(&answer, &rotation);
    let text = format!("{text}{}", outputs::written(&paths));
    json::print_answer(&text, &answer, args.json)
}

/// Why there is nothing to show, if no place has figures.
fn without_figures(task: &MapTask<'_>, places: &Places) -> Option<Failure> {
    if places.with_figures() > 0 {
        return None;
    }
    if places.no_answer > 0 {
        return Some(no_equilibrium(task, places));
    }
    Some(Failure::unanswered(format!(
        "the machine {} with the tool {} (cannot be reached: {}; outside the limits of an actuator: {}); choose places inside the workspace (`kinetostat check` tells its size), another --rotation, or check the tool's length",
        match places.asked {
            1 => "cannot be put at the place".to_owned(),
            n => format!("can be put at none of the {n} places"),
        },
        orientation::in_words(&task.orientation),
        places.unreachable,
        places.outside_limits
    )))
}

/// No place has an answer, and places are within reach: the load is the reason.
fn no_equilibrium(task: &MapTask<'_>, places: &Places) -> Failure {
    let wrench = task.load.unwrap_or_else(Wrench::zero);
    let counts = match places.asked {
        1 => String::new(),
        _ => format!(
            " (no equilibrium: {}; cannot be reached: {}; outside the limits of an actuator: {})",
            places.no_answer, places.unreachable, places.outside_limits
        ),
    };
    Failure::unanswered(format!(
        "no equilibrium was found {} under the force {} N and the moment {} N m{counts}: the load may be beyond what the machine can carry; check the load and its unit, or try a part of it",
        match places.asked {
            1 => "at the place".to_owned(),
            n => format!("at any of the {n} places"),
        },
        load_triple(wrench.force().into()),
        load_triple(wrench.moment().into()),
    ))
}

/// Goes through the grid: the table is written, figures and picture are gathered.
fn solve(
    task: &MapTask<'_>,
    outputs: &mut Outputs,
    csv: Option<usize>,
    mut picture: Picture,
) -> Answer<(Figures, Picture)> {
    let columns = Columns {
        loaded: task.load.is_some(),
        follows: task.orientation_follows,
    };
    if let Some(index) = csv {
        outputs.append(index, text::header(columns).as_bytes())?;
    }
    let mut figures = Figures::default();
    let progress = Progress::new();
    let shown = picture.clone();
    let block = |places: &[MapPlace]| {
        let lines = csv.map(|_| text::lines(places, columns));
        let cells: Vec<(usize, Cell)> = places.iter().filter_map(|p| shown.cell(p)).collect();
        (Figures::of(places), lines, cells)
    };
    map(task, &progress, block, |(own, lines, cells)| {
        figures.add(&own);
        for (at, cell) in cells {
            picture.cells[at] = cell;
        }
        match (csv, lines) {
            (Some(index), Some(lines)) => outputs.append(index, lines.as_bytes()),
            _ => Ok::<(), Failure>(()),
        }
    })?;
    progress.finish();
    if let Some(index) = csv {
        outputs.complete(index)?;
    }
    Ok((figures, picture))
}
