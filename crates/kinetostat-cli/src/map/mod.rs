//! `kinetostat map`: stiffness, and deflection under a load, on a grid of places.
//!
//! It takes a model, a grid and perhaps a load, and gives extremes, a table of all places and a drawing of one
//! section.

mod answer;
pub(crate) mod arguments;
mod columns;
mod fields;
mod files;
mod picture;
mod query;
mod solve;
mod store;
mod text;

use std::path::{Path, PathBuf};

use kinetostat::{Mechanism, MotionKind, Wrench};
use kinetostat_diagnostic::ErrorCode;
use kinetostat_dynamics::check_masses;
use kinetostat_machining::{MapTask, Variable, Warning, WarningCode, straight_tool, unusual_load};
use kinetostat_model::Model;
use nalgebra::UnitQuaternion;

use crate::files::hash::sha256;
use crate::files::input_files::InputFiles;
use crate::files::outputs::{self, Existing, Outputs};
use crate::machine::model_warnings::{deviation_descriptions, no_potential, of_model};
use crate::map::answer::{Figures, MapAnswer, Places};
use crate::map::arguments::MapArgs;
use crate::map::columns::{Column, asked};
use crate::map::fields::Gathering;
use crate::map::files::Files;
use crate::map::picture::Picture;
use crate::map::query::{grid, loads};
use crate::map::solve::{Sinks, solve};
use crate::map::store::{Manifest, Store};
use crate::place::orientation;
use crate::ui::failure::{Answer, Failing, Failure};
use crate::ui::numbers::{load_triple, short};
use crate::ui::result_form::ResultForm;
use crate::ui::{json, threads};
use crate::vibration::subject;

/// Results that the command gives as JSON.
pub(crate) const RESULTS: &[ResultForm] =
    &[ResultForm::of::<MapAnswer>("figures over the workspace")];

pub(crate) fn run(args: &MapArgs) -> Answer<()> {
    let (model, path) = InputFiles::default().model(&args.model, Path::new(""))?;
    let mechanism = with_tool(args, &model)?;
    let home = mechanism.platforms()[mechanism.tool()].home;
    let grid = grid(args, (home.translation.vector * 1e3).into())?;
    let orientations = Orientations::asked(args, &mechanism)?;
    let loads = loads(args)?;
    shown_with_a_load(args, &loads)?;
    let cases = orientations.cases(&loads)?;
    let loaded = !loads.is_empty();
    let limbs = mechanism.limbs().iter();
    let actuators = limbs.flat_map(|limb| limb.nominal.actuators().iter().map(|a| a.kind));
    let actuators: Vec<MotionKind> = actuators.collect();
    let (variables, shown) = asked(args, &actuators, loaded, cases)?;
    if variables.is_empty() || variables.iter().any(|v| v.needs_stiffness()) {
        model.require_stiffness()?;
    }
    masses(&variables, &mechanism, &model.file)?;
    let further = columns::columns(&variables, &actuators);
    let picture = Picture::new(args, &grid, shown)?;
    let mut task = MapTask {
        mechanism: &mechanism,
        grid,
        orientation: orientations.first,
        orientation_follows: orientations.follows,
        load: loads.first().copied(),
        further: orientations.further(&loads),
        variables,
        ratings: model.ratings(),
        first: 0,
    };
    let existing = Existing::forced(args.force_overwrite);
    let mut outputs = Outputs::new(existing, path.iter().cloned().collect());
    let files = Files::claimed(args, &mut outputs)?;
    let manifest = manifest(args, &model, &task);
    let store = store(args, &manifest, &task, &further)?;
    let mut sinks = Sinks {
        outputs: &mut outputs,
        csv: files.csv,
        store,
        gathering: (files.want_fields()).then(|| gathering(&model, manifest, &task, &further)),
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
    let solved = Solved {
        task: &task,
        cases,
        warnings: warnings(&model, &loads, &task, &figures, &orientations),
        figures,
        further,
    };
    let answer = answer(args, &model, path.as_deref(), solved);
    files.draw(&mut outputs, &task, &answer, &picture)?;
    files.write_fields(&mut outputs, gathering)?;
    let paths = outputs.commit()?;
    let text = text::answer_text(&answer, &orientations.first);
    let text = format!("{text}{}", outputs::written(&paths));
    json::print_answer(&text, &answer, args.json)
}

/// The machine with the straight tool of the options.
fn with_tool(args: &MapArgs, model: &Model) -> Answer<Mechanism> {
    let length = args.tool_length_mm.unwrap_or(0.0);
    if length.abs() > 1e5 {
        return Err(ErrorCode::Value.failure(format!(
            "--tool-length-mm is {length}; tools are shorter than 100 m"
        )));
    }
    Ok((model.mechanism).with_tool(&straight_tool(1e-3 * length)))
}

/// Refuses effects of a load without a load.
fn shown_with_a_load(args: &MapArgs, loads: &[Wrench]) -> Answer<()> {
    if loads.is_empty() && matches!(&*args.show, "displacement" | "rotation") {
        return Err(ErrorCode::Missing.failure(
            "--show displacement and --show rotation need a load; give --force or --moment",
        ));
    }
    Ok(())
}

/// Refuses vibration variables for a machine without masses.
fn masses(variables: &[Variable], mechanism: &Mechanism, file: &str) -> Answer<()> {
    match variables.iter().find(|v| v.needs_mass()) {
        Some(own) => check_masses(mechanism).map_err(|e| {
            let name = own.entry().name;
            subject::refused(e).within(&format!("{file}: '{name}'"))
        }),
        None => Ok(()),
    }
}

/// Opens the store of an earlier run of this map.
fn store(
    args: &MapArgs,
    manifest: &Manifest,
    task: &MapTask<'_>,
    further: &[Column],
) -> Answer<Option<Store>> {
    let open =
        |directory: &PathBuf| Store::open(directory, manifest, further.len(), task.grid.len());
    args.resume.as_ref().map(open).transpose()
}

/// Columns for the files of other programs, empty as yet.
fn gathering(
    model: &Model,
    manifest: Manifest,
    task: &MapTask<'_>,
    further: &[Column],
) -> Gathering {
    let facts = manifest.into_iter().collect();
    let title = format!("kinetostat map of {}", model.name());
    Gathering::new(title, facts, &task.grid, task.load.is_some(), further)
}

/// Warnings about the model, the loads and the figures.
fn warnings(
    model: &Model,
    loads: &[Wrench],
    task: &MapTask<'_>,
    figures: &Figures,
    orientations: &Orientations,
) -> Vec<Warning> {
    let mut warnings: Vec<Warning> = of_model(model).collect();
    warnings.extend(no_potential(&model.mechanism));
    warnings.extend(symmetric_part(model, loads, task));
    warnings.extend(loads.iter().flat_map(unusual_load));
    warnings.extend(figures.warnings(task.mechanism.size()));
    if orientations.follows {
        let (turned, stated) = (figures.largest_turn_deg, orientations.are_stated());
        warnings.push(orientation::follows(turned, stated, true));
    }
    warnings
}

/// Frequencies of a map are those of real modes, which are none where loads have no potential.
fn symmetric_part(model: &Model, loads: &[Wrench], task: &MapTask<'_>) -> Option<Warning> {
    let frequencies = task.variables.iter().any(|v| v.needs_mass());
    let of_limbs = no_potential(&model.mechanism).is_some();
    let dead = loads.iter().any(|load| load.moment().norm() > 0.0);
    (frequencies && (of_limbs || dead)).then(|| {
        Warning::new(
            WarningCode::NoPotential,
            "frequencies of this map are those of the symmetric part of the stiffness: loads have no potential (followers, or a moment that does not turn with the tool), and the machine swings in complex pairs. `kinetostat modes` has these at a place, and says whether one grows".to_owned(),
        )
    })
}

/// A map that is solved.
struct Solved<'a> {
    task: &'a MapTask<'a>,
    cases: usize,
    figures: Figures,
    further: Vec<Column>,
    warnings: Vec<Warning>,
}

/// The answer, of the model that the options name, and its file if it is one.
fn answer(args: &MapArgs, model: &Model, path: Option<&Path>, solved: Solved<'_>) -> MapAnswer {
    let (task, figures) = (solved.task, solved.figures);
    let mut solving = figures.solving.clone();
    solving.one_by_one_because = task.one_by_one_because();
    let turned = figures.largest_turn_deg;
    MapAnswer {
        schema: 3,
        kinetostat_version: env!("CARGO_PKG_VERSION"),
        model: model.name().to_owned(),
        model_source: match path {
            Some(_) => args.model.clone(),
            None => format!("preset {}", args.model),
        },
        tool: match args.tool_length_mm.unwrap_or(0.0) {
            0.0 => "none: the platform's own point".to_owned(),
            length => format!("{} mm along z of the flange", short(length)),
        },
        rotation_vector_deg: task.orientation.scaled_axis().map(f64::to_degrees).into(),
        max_tool_turn_deg: task.orientation_follows.then_some(turned),
        grid: task.grid.into(),
        loaded: task.load.is_some(),
        force_n: task.load.map_or([0.0; 3], |w| w.force().into()),
        moment_n_m: task.load.map_or([0.0; 3], |w| w.moment().into()),
        deviations: deviation_descriptions(model),
        figures: figures.answer(task.load.is_some(), &solved.further),
        places: figures.places,
        cases: solved.cases,
        solving,
        warnings: solved.warnings,
    }
}

/// All that the numbers of a map depend on.
fn manifest(args: &MapArgs, model: &Model, task: &MapTask<'_>) -> Manifest {
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
            store::OF_CASES,
            cases.map(case).collect::<Vec<_>>().join("; "),
        ),
        ("variables", names.join(", ")),
    ];
    words
        .map(|(name, text)| (name.to_owned(), text))
        .into_iter()
        .collect()
}

/// Orientations of the tool at every place.
pub(crate) struct Orientations {
    /// Requested orientations; none: it follows.
    requested: Vec<Option<UnitQuaternion<f64>>>,
    /// The first one, at home without any.
    pub(crate) first: UnitQuaternion<f64>,
    /// True if the orientation is the nearest to the first that the machine can have.
    pub(crate) follows: bool,
}

impl Orientations {
    /// Orientations by the options; without them, that at home.
    pub(crate) fn asked(args: &MapArgs, mechanism: &Mechanism) -> Answer<Self> {
        let requested: Vec<Option<UnitQuaternion<f64>>> = (args.rotation.iter())
            .map(|text| orientation::option_or_follows("--rotation", text))
            .collect::<Answer<_>>()?;
        if requested.len() > 1 && requested.iter().any(Option::is_none) {
            return Err(ErrorCode::Conflict
                .failure("--rotation follows is the only orientation, or none of them"));
        }
        let home = mechanism.platforms()[mechanism.tool()].home.rotation;
        let first = requested.first().copied();
        Ok(Self {
            follows: first.map_or_else(|| mechanism.turns_as_it_moves(), |a| a.is_none()),
            first: first.flatten().unwrap_or(home),
            requested,
        })
    }

    /// True if the options state any.
    pub(crate) fn are_stated(&self) -> bool {
        !self.requested.is_empty()
    }

    /// Number of cases of each orientation with each load.
    pub(crate) fn cases(&self, loads: &[Wrench]) -> Answer<usize> {
        let cases = self.requested.len().max(1) * loads.len().max(1);
        if cases > 1 && self.follows {
            return Err(ErrorCode::Missing.failure("several loads are compared where the orientation is held; give --rotation, or one load",
            ));
        }
        Ok(cases)
    }

    /// The cases beside the first orientation with the first load.
    pub(crate) fn further(&self, loads: &[Wrench]) -> Vec<(UnitQuaternion<f64>, Option<Wrench>)> {
        let orientations: Vec<_> = match self.requested.is_empty() {
            true => vec![self.first],
            false => self.requested.iter().flatten().copied().collect(),
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
}

/// Failure if no place has figures.
fn without_figures(task: &MapTask<'_>, places: &Places) -> Option<Failure> {
    if places.with_figures() > 0 {
        return None;
    }
    if places.no_answer > 0 {
        return Some(no_equilibrium(task, places));
    }
    Some(ErrorCode::Unreachable.failure(format!(
            "the machine {} with the tool {} (cannot be reached: {}; outside the limits of an actuator: {}); choose places inside the workspace (`kinetostat check` tells its size), another --rotation, or check the tool's length",
            match places.requested {
                1 => "cannot be put at the place".to_owned(),
                n => format!("can be put at none of the {n} places"),
            },
            orientation::description(&task.orientation),
            places.unreachable,
            places.outside_limits
        ),
    ))
}

/// Failure if places are within reach and none has an answer: the load is the reason.
fn no_equilibrium(task: &MapTask<'_>, places: &Places) -> Failure {
    let wrench = task.load.unwrap_or_else(Wrench::zero);
    let counts = match places.requested {
        1 => String::new(),
        _ => format!(
            " (no equilibrium: {}; cannot be reached: {}; outside the limits of an actuator: {})",
            places.no_answer, places.unreachable, places.outside_limits
        ),
    };
    ErrorCode::NotConverged.failure(format!(
            "no equilibrium was found {} under the force {} N and the moment {} N m{counts}: the load may be beyond what the machine can carry; check the load and its unit, or try a part of it",
            match places.requested {
                1 => "at the place".to_owned(),
                n => format!("at any of the {n} places"),
            },
            load_triple(wrench.force().into()),
            load_triple(wrench.moment().into()),
        ),
    )
}
