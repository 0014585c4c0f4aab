//! `kinetostat map`: stiffness, and deflection under a load, on a grid of places.
//!
//! It takes a model, a grid and perhaps a load, and gives extremes, a table of all places and a drawing of one
//! section.

mod answer;
pub(crate) mod arguments;
mod columns;
mod fields;
mod over;
mod picture;
mod query;
mod solve;
mod store;
mod text;
mod unanswered;

use kinetostat::Wrench;
use kinetostat_formats::fields::Fields;
use kinetostat_machining::{MapTask, Warning, straight_tool, unusual_load};
use nalgebra::UnitQuaternion;

use crate::files::hash::sha256;
use crate::files::input_files::InputFiles;
use crate::files::outputs::{self, Existing, Outputs};
use crate::machine::model_warnings::{deviation_descriptions, no_potential, of_model};
use crate::map::answer::MapAnswer;
use crate::map::arguments::MapArgs;
use crate::map::columns::asked;
use crate::map::fields::Gathering;
use crate::map::picture::Picture;
use crate::map::query::{grid, loads};
use crate::map::solve::{Sinks, solve};
use crate::map::store::{Manifest, Store};
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
    let requested = args.rotation.iter();
    let requested: Vec<Option<UnitQuaternion<f64>>> = requested
        .map(|text| orientation::option_or_follows("--rotation", text))
        .collect::<Answer<_>>()?;
    if requested.len() > 1 && requested.iter().any(Option::is_none) {
        return Err(Failure::input(
            "--rotation follows is the only orientation, or none of them",
        ));
    }
    let first = requested.first().copied();
    let rotation = first.flatten().unwrap_or(home.rotation);
    let follows = first.map_or_else(|| mechanism.turns_as_it_moves(), |a| a.is_none());
    let loads = loads(args)?;
    let load = loads.first().copied();
    if load.is_none() && matches!(&*args.show, "displacement" | "rotation") {
        return Err(Failure::input(
            "--show displacement and --show rotation need a load; give --force or --moment",
        ));
    }
    let cases = requested.len().max(1) * loads.len().max(1);
    if cases > 1 && follows {
        return Err(Failure::input(
            "several loads are compared where the orientation is held; give --rotation, or one load",
        ));
    }
    let actuators = mechanism.actuator_count();
    let (variables, shown) = asked(args, actuators, load.is_some(), cases)?;
    let further = columns::columns(&variables, actuators);
    let picture = Picture::new(args, &grid, shown)?;
    let mut task = MapTask {
        mechanism: &mechanism,
        grid,
        orientation: rotation,
        orientation_follows: follows,
        load,
        further: others(&requested, rotation, &loads),
        variables,
        ratings: model.ratings(),
        first: 0,
    };
    let existing = Existing::forced(args.force_overwrite);
    let mut outputs = Outputs::new(existing, path.iter().cloned().collect());
    let csv = args.csv.as_ref().map(|p| outputs.claim("table", p));
    let csv = csv.transpose()?;
    let plot = args.plot.as_ref().map(|p| outputs.claim("plot", p));
    let plot = plot.transpose()?;
    let files = [
        ("VTK file", &args.vtk),
        ("NetCDF file", &args.netcdf),
        ("Parquet file", &args.parquet),
    ];
    let files = files.map(|(what, path)| path.as_ref().map(|p| outputs.claim(what, p)).transpose());
    let [vtk, netcdf, parquet] = files;
    let (vtk, netcdf, parquet) = (vtk?, netcdf?, parquet?);
    let manifest = manifest(args, &model, &task);
    let store = match &args.resume {
        Some(directory) => Some(Store::open(
            directory,
            &manifest,
            further.len(),
            grid.len(),
        )?),
        None => None,
    };
    let wanted = vtk.is_some() || netcdf.is_some() || parquet.is_some();
    let gathering = wanted.then(|| {
        let facts = manifest.clone().into_iter().collect();
        let title = format!("kinetostat map of {}", model.name());
        Gathering::new(title, facts, &grid, load.is_some(), &further)
    });
    let mut sinks = Sinks {
        outputs: &mut outputs,
        csv,
        store,
        gathering,
        further,
    };
    let work = || solve(&mut task, &mut sinks, picture);
    let (figures, picture) = threads::in_threads(args.threads, work)??;
    let Sinks {
        gathering, further, ..
    } = sinks;
    if let Some(failure) = without_figures(&task, &figures.places) {
        return Err(failure);
    }
    let mut warnings: Vec<Warning> = of_model(&model).collect();
    warnings.extend(no_potential(&model.mechanism));
    warnings.extend(loads.iter().flat_map(unusual_load));
    warnings.extend(figures.warnings(task.mechanism.size()));
    let turned = figures.largest_turn_deg;
    if follows {
        warnings.push(orientation::follows(turned, !requested.is_empty(), true));
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
        cases,
        figures: figures.answer(load.is_some(), &further),
        solving,
        warnings,
    };
    if let Some(index) = plot {
        let outline = over::outline(&task, &picture);
        let mut lines = over::isolines(&picture);
        lines.extend(outline);
        let marks = over::extremes(&picture);
        outputs.fill(index, picture.svg(&answer, lines, marks).as_bytes())?;
    }
    if let Some(fields) = gathering.map(Gathering::done) {
        if let Some(index) = vtk {
            outputs.fill(index, &fields.vtk())?;
        }
        if let Some(index) = netcdf {
            outputs.fill(index, &fields::netcdf(&fields)?)?;
        }
        if let Some(index) = parquet {
            outputs.fill(index, &parquet_of(&fields)?)?;
        }
    }
    let paths = outputs.commit()?;
    let text = text::answer_text(&answer, &rotation);
    let text = format!("{text}{}", outputs::written(&paths));
    json::print_answer(&text, &answer, args.json)
}

/// Orientations and loads beside the first ones.
fn others(
    requested: &[Option<UnitQuaternion<f64>>],
    first: UnitQuaternion<f64>,
    loads: &[Wrench],
) -> Vec<(UnitQuaternion<f64>, Option<Wrench>)> {
    let orientations: Vec<_> = match requested.is_empty() {
        true => vec![first],
        false => requested.iter().flatten().copied().collect(),
    };
    let loads: Vec<Option<Wrench>> = match loads.is_empty() {
        true => vec![None],
        false => loads.iter().copied().map(Some).collect(),
    };
    let all = orientations
        .iter()
        .flat_map(|o| loads.iter().map(move |l| (*o, *l)));
    all.skip(1).collect()
}

/// All that the numbers of a map depend on.
fn manifest(args: &MapArgs, model: &kinetostat_model::Model, task: &MapTask<'_>) -> Manifest {
    let quaternion = |q: &UnitQuaternion<f64>| format!("{:?}", q.coords.as_slice());
    let case = |(o, l): &(UnitQuaternion<f64>, Option<Wrench>)| {
        let load = l.map_or_else(|| "none".to_owned(), |l| format!("{:?}", l.0.as_slice()));
        format!("{} {load}", quaternion(o))
    };
    let first = (task.orientation, task.load);
    let cases = std::iter::once(&first).chain(&task.further);
    let grid = &task.grid;
    let names: Vec<&str> = task.variables.iter().map(|v| v.entry().name).collect();
    let words = [
        ("kinetostat_version", env!("CARGO_PKG_VERSION").to_owned()),
        ("model", model.name().to_owned()),
        ("model_sha256", sha256(model.text.as_bytes())),
        (
            "tool_length_mm",
            format!("{:?}", args.tool_length_mm.unwrap_or(0.0)),
        ),
        ("grid_from_mm", format!("{:?}", grid.from_mm)),
        ("grid_to_mm", format!("{:?}", grid.to_mm)),
        ("grid_places", format!("{:?}", grid.counts)),
        ("orientation_follows", task.orientation_follows.to_string()),
        (
            "orientations_and_loads",
            cases.map(case).collect::<Vec<_>>().join("; "),
        ),
        ("variables", names.join(", ")),
    ];
    words
        .map(|(name, text)| (name.to_owned(), text))
        .into_iter()
        .collect()
}

#[cfg(feature = "parquet")]
fn parquet_of(fields: &Fields) -> Answer<Vec<u8>> {
    fields.parquet().map_err(Failure::input)
}

#[cfg(not(feature = "parquet"))]
fn parquet_of(_: &Fields) -> Answer<Vec<u8>> {
    Err(Failure::input(
        "--parquet: this program was built without Parquet",
    ))
}
