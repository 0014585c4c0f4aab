//! `kinetostat map`: stiffness, and deflection under a load, on a grid of places.

mod answer;
pub(crate) mod arguments;
mod text;

use kinetostat::Wrench;
use kinetostat_machining::{
    Grid, MapPlace, MapTask, PlaceState, Warning, large_load, map, straight_tool,
};
use kinetostat_report::{Cell, Plot, PlotLine, Section};
use nalgebra::Vector3;

use crate::files::input::Files;
use crate::files::output::{Existing, Outputs};
use crate::job::machine::{deviations_in_words, no_potential, of_model, short};
use crate::job::setting::vector;
use crate::map::answer::{Figures, MapAnswer, Places};
use crate::map::arguments::{MapArgs, Quantity};
use crate::map::text::Columns;
use crate::place::orientation;
use crate::program::solve;
use crate::ui::failure::{Answer, Failure};
use crate::ui::progress::Progress;
use crate::ui::screen::{self, Stream, load_triple};

/// More places are a slip of the pen: their table would fill a disk.
const MOST_PLACES: usize = 100_000_000;

/// Places along an axis unless said otherwise.
const USUAL: usize = 21;

/// Most cells of a drawing along an axis; a finer grid is thinned.
const MOST_CELLS: usize = 400;

const AXES: [&str; 3] = ["x", "y", "z"];

pub(crate) fn run(args: &MapArgs) -> Answer<()> {
    let (model, path) = Files::default().model(&args.model, std::path::Path::new(""))?;
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
    let existing = match args.force_overwrite {
        true => Existing::Replace,
        false => Existing::Refuse,
    };
    let mut outputs = Outputs::new(existing, path.iter().cloned().collect());
    let csv = args.csv.as_ref().map(|p| outputs.claim("table", p));
    let csv = csv.transpose()?;
    let plot = args.plot.as_ref().map(|p| outputs.claim("plot", p));
    let plot = plot.transpose()?;
    let work = || solve(&task, &mut outputs, csv, picture);
    let (figures, picture) = solve::in_threads(args.threads, work)??;
    if figures.places.with_figures() == 0 {
        let p = &figures.places;
        if p.no_answer > 0 {
            return Err(no_equilibrium(&task, p));
        }
        return Err(Failure::unanswered(format!(
            "the machine {} with the tool {} (cannot be reached: {}; outside the limits of an actuator: {}); choose places inside the workspace (`kinetostat check` tells its size), another --rotation, or check the tool's length",
            match p.asked {
                1 => "cannot be put at the place".to_owned(),
                n => format!("can be put at none of the {n} places"),
            },
            orientation::in_words(&rotation),
            p.unreachable,
            p.outside_limits
        )));
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
    let text = format!("{text}{}", solve::written(&paths));
    if args.json {
        screen::print(Stream::Err, &text)?;
        return screen::print_bytes(solve::json(&answer)?.as_bytes());
    }
    screen::print(Stream::Out, &text)
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

fn grid(args: &MapArgs, home_mm: [f64; 3]) -> Answer<Grid> {
    let mut grid = Grid {
        from_mm: home_mm,
        to_mm: home_mm,
        counts: [1; 3],
    };
    let asked = [&args.x, &args.y, &args.z];
    if asked.iter().all(|a| a.is_none()) {
        return Err(Failure::input(
            "a map needs places; give at least one of --x, --y and --z, as in --x -100 100 21 (from, to in mm, how many)",
        ));
    }
    for (k, values) in asked.into_iter().enumerate() {
        let Some(values) = values else { continue };
        let name = AXES[k];
        if values.iter().take(2).any(|x| x.abs() > 1e7) {
            return Err(Failure::input(format!(
                "--{name} leads more than 10 km away; coordinates are in mm"
            )));
        }
        (grid.from_mm[k], grid.to_mm[k], grid.counts[k]) = match values[..] {
            [at] => (at, at, 1),
            [from, to] if from == to => (from, to, 1),
            [from, to] => (from, to, USUAL),
            [from, to, n] if n.fract() == 0.0 && n >= 1.0 && n <= MOST_PLACES as f64 => {
                if (n == 1.0) != (from == to) {
                    return Err(Failure::input(format!(
                        "--{name} {from} {to} {n}: two places or more lie between different ends, one place where they are the same"
                    )));
                }
                (from, to, n as usize)
            }
            _ => {
                return Err(Failure::input(format!(
                    "--{name}: write one position, or from, to (mm) and a whole number of places, as in --{name} -100 100 21"
                )));
            }
        };
    }
    if grid.len() > MOST_PLACES {
        return Err(Failure::input(format!(
            "the grid has {} places; {MOST_PLACES} are the most",
            grid.len()
        )));
    }
    Ok(grid)
}

fn load(args: &MapArgs) -> Answer<Option<Wrench>> {
    if args.force.is_none() && args.moment.is_none() {
        return Ok(None);
    }
    let part = |name: &str, values: &Option<Vec<f64>>| match values {
        Some(v) => vector(name, v),
        None => Ok(Vector3::zeros()),
    };
    let (force, moment) = (
        part("--force", &args.force)?,
        part("--moment", &args.moment)?,
    );
    Ok(Some(Wrench::new(force, moment)))
}

/// What is drawn: a section of the grid, or a curve along its only axis. Its size is bounded.
#[derive(Clone)]
struct Picture {
    show: Quantity,
    /// Horizontal and vertical axis.
    axes: [usize; 2],
    /// Every so many places along them.
    strides: [usize; 2],
    /// Numbers of the places along them.
    places: [Vec<usize>; 2],
    /// Axis across and the number of the places there.
    across: (usize, usize),
    grid: Grid,
    cells: Vec<Cell>,
    /// Something is drawn.
    wanted: bool,
}

impl Picture {
    fn new(args: &MapArgs, grid: &Grid) -> Answer<Self> {
        let across = across(args.section.as_deref(), grid)?;
        let axes = match across.0 {
            0 => [1, 2],
            1 => [0, 2],
            _ => [0, 1],
        };
        let strides = axes.map(|a| grid.counts[a].div_ceil(MOST_CELLS));
        let places = [0, 1].map(|k| {
            (0..grid.counts[axes[k]])
                .step_by(strides[k])
                .collect::<Vec<_>>()
        });
        Ok(Self {
            show: args.show,
            axes,
            strides,
            cells: vec![Cell::Value(f64::NAN); places[0].len() * places[1].len()],
            places,
            across,
            grid: *grid,
            wanted: args.plot.is_some(),
        })
    }

    /// The cell of a place and its number, if it lies in the section.
    fn cell(&self, place: &MapPlace) -> Option<(usize, Cell)> {
        if !self.wanted || place.index[self.across.0] != self.across.1 {
            return None;
        }
        let [a, b] = [0, 1].map(|k| {
            let own = place.index[self.axes[k]];
            own.is_multiple_of(self.strides[k])
                .then_some(own / self.strides[k])
        });
        let at = a? + b? * self.places[0].len();
        let cell = match place.state {
            PlaceState::Unreachable => Cell::Other(0),
            PlaceState::OutsideLimits => Cell::Other(1),
            PlaceState::Unstable | PlaceState::Unanswered => Cell::Other(2),
            PlaceState::Regular | PlaceState::Singular => Cell::Value(self.show.of(place)),
        };
        Some((at, cell))
    }

    fn along(&self, k: usize) -> Vec<f64> {
        let axis = self.axes[k];
        let places = self.places[k].iter();
        places.map(|i| self.grid.position_mm(axis, *i)).collect()
    }

    fn svg(&self, a: &MapAnswer) -> String {
        let fixed: Vec<String> = (0..3)
            .filter(|k| self.grid.counts[*k] == 1 || *k == self.across.0)
            .map(|k| {
                let index = if k == self.across.0 { self.across.1 } else { 0 };
                let at = self.grid.position_mm(k, index);
                format!("{} = {} mm", AXES[k], short(at))
            })
            .collect();
        let under = match a.loaded {
            true => format!(
                "; force {} N, moment {} N m on the tool",
                load_triple(a.force_n),
                load_triple(a.moment_n_m)
            ),
            false => "; no load".to_owned(),
        };
        let tool = match a.tool.starts_with("none") {
            true => "; no tool".to_owned(),
            false => format!("; tool {}", a.tool),
        };
        let title = format!(
            "{}: {} at {}{under}{tool}",
            a.model,
            self.show.in_words(),
            fixed.join(", ")
        );
        let label = |k: usize| format!("{}, mm", AXES[self.axes[k]]);
        let value_label = format!("{}, {}", self.show.in_words(), self.show.unit());
        let single = (0..2).find(|k| self.places[*k].len() == 1);
        if let Some(single) = single {
            let values = self.cells.iter().map(|c| match c {
                Cell::Value(x) => *x,
                Cell::Other(_) => f64::NAN,
            });
            let points = self.along(1 - single).into_iter().zip(values).collect();
            return Plot {
                title,
                x_label: label(1 - single),
                y_label: value_label,
                lines: vec![PlotLine {
                    points,
                    ..PlotLine::default()
                }],
                marks: Vec::new(),
            }
            .svg();
        }
        Section {
            title,
            x_label: label(0),
            y_label: label(1),
            value_label,
            x: self.along(0),
            y: self.along(1),
            cells: self.cells.clone(),
            others: vec![
                "cannot be reached".into(),
                "outside limits".into(),
                "not stable".into(),
            ],
        }
        .svg()
    }
}

/// The axis across the section and the number of the places in it.
fn across(section: Option<&str>, grid: &Grid) -> Answer<(usize, usize)> {
    let Some(text) = section else {
        // Across an axis with one place, or else across z.
        let axis = (0..3).rev().find(|k| grid.counts[*k] == 1).unwrap_or(2);
        return Ok((axis, (grid.counts[axis] - 1) / 2));
    };
    let refuse = || {
        Failure::input(format!(
            "--section '{text}': write the axis across the section and where it is cut in mm, as in z=150"
        ))
    };
    let (name, value) = text.split_once('=').ok_or_else(refuse)?;
    let axis = AXES.iter().position(|a| *a == name.trim().to_lowercase());
    let axis = axis.ok_or_else(refuse)?;
    let value: f64 = value.trim().parse().map_err(|_| refuse())?;
    let far = |i: usize| (grid.position_mm(axis, i) - value).abs();
    let nearest = (0..grid.counts[axis]).min_by(|a, b| far(*a).total_cmp(&far(*b)));
    nearest
        .filter(|_| value.is_finite())
        .map(|i| (axis, i))
        .ok_or_else(refuse)
}
