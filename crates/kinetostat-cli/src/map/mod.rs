//! `kinetostat map`: stiffness, and deflection under a load, on a grid of places.
//!
//! It takes a model, a grid and perhaps a load, and gives extremes, a table of all places and a drawing of one
//! section.

mod answer;
pub(crate) mod arguments;
mod picture;
mod query;
mod solve;
mod text;
mod unanswered;

use kinetostat_machining::{MapTask, Warning, straight_tool, unusual_load};

use crate::files::input_files::InputFiles;
use crate::files::outputs::{self, Existing, Outputs};
use crate::machine::model_warnings::{deviation_descriptions, no_potential, of_model};
use crate::map::answer::MapAnswer;
use crate::map::arguments::{MapArgs, Quantity};
use crate::map::picture::Picture;
use crate::map::query::{grid, load};
use crate::map::solve::solve;
use crate::map::unanswered::without_figures;
use crate::place::orientation;
use crate::ui::failure::{Answer, Failure};
use crate::ui::numbers::short;
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
    let requested = match &args.rotation {
        Some(text) => Some(orientation::option_or_follows("--rotation", text)?),
        None => None,
    };
    let rotation = requested.flatten().unwrap_or(home.rotation);
    let follows = requested.map_or_else(|| mechanism.turns_as_it_moves(), |a| a.is_none());
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
    warnings.extend(load.iter().flat_map(unusual_load));
    warnings.extend(figures.warnings(task.mechanism.size()));
    let turned = figures.largest_turn_deg;
    if follows {
        warnings.push(orientation::follows(turned, requested.is_some(), true));
    }
    let mut solving = figures.solving.clone();
    solving.one_by_one_because = task.one_by_one_because();
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
        deviations: deviation_descriptions(&model),
        places: figures.places,
        figures: figures.answer(load.is_some()),
        solving,
        warnings,
    };
    if let Some(index) = plot {
        outputs.fill(index, picture.svg(&answer).as_bytes())?;
    }
    let paths = outputs.commit()?;
    let text = text::answer_text(&answer, &rotation);
    let text = format!("{text}{}", outputs::written(&paths));
    json::print_answer(&text, &answer, args.json)
}
