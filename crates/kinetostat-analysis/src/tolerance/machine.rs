//! A machine as a function of its uncertain numbers: built as drawn by chance, commanded as the drawing says.

use kinetostat::batch::{Batch, BatchEquilibrium, Commanded, Details, LoadedBatch};
use kinetostat::compensation::target_under_load_following;
use kinetostat::nalgebra::{Matrix6, Matrix6x3, Vector3};
use kinetostat::{Directions, Mechanism, Pose, Wrench};
use kinetostat_model::{Model, ModelError, ParametricModel};
use schemars::JsonSchema;
use serde::Serialize;

use crate::tolerance::file::{Source, UncertaintyFile};
use crate::tolerance::near_drawing::{MOST_DERIVATIVES, Margins, with_stability};
use crate::tolerance::uncertain::Uncertainties;

/// Quantities that depend on the equilibrium under the load.
const LOADED: [Quantity; 3] = [
    Quantity::DeflectionByLoad,
    Quantity::Deviation,
    Quantity::Stiffness,
];

/// Quantity requested of a machine at each place.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Quantity {
    /// Displacement from the commanded to the actual place of the unloaded tool (mm): errors of manufacture and assembly, and
    /// the machine's own weight.
    Error,
    /// Displacement of the unloaded tool by the load (mm).
    DeflectionByLoad,
    /// Displacement from the commanded place to that under the load (mm): both together.
    Deviation,
    /// Deviation if the command is compensated with the numbers of the drawing (mm): the residual of compensation.
    Compensated,
    /// Force along x, y and z per motion along it, the tool free to turn, under the load (N/mm).
    Stiffness,
}

impl Quantity {
    /// All of them.
    pub const ALL: [Self; 5] = [
        Self::Error,
        Self::DeflectionByLoad,
        Self::Deviation,
        Self::Compensated,
        Self::Stiffness,
    ];

    /// Columns with units: length and components, or components only.
    #[must_use]
    pub fn columns(self) -> &'static [&'static str] {
        match self {
            Self::Error => &["error_mm", "error_x_mm", "error_y_mm", "error_z_mm"],
            Self::DeflectionByLoad => &[
                "deflection_by_load_mm",
                "deflection_by_load_x_mm",
                "deflection_by_load_y_mm",
                "deflection_by_load_z_mm",
            ],
            Self::Deviation => &[
                "deviation_mm",
                "deviation_x_mm",
                "deviation_y_mm",
                "deviation_z_mm",
            ],
            Self::Compensated => &[
                "compensated_mm",
                "compensated_x_mm",
                "compensated_y_mm",
                "compensated_z_mm",
            ],
            Self::Stiffness => &[
                "stiffness_x_n_per_mm",
                "stiffness_y_n_per_mm",
                "stiffness_z_n_per_mm",
            ],
        }
    }

    /// Word in files and on the command line.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Error => "error",
            Self::DeflectionByLoad => "deflection_by_load",
            Self::Deviation => "deviation",
            Self::Compensated => "compensated",
            Self::Stiffness => "stiffness",
        }
    }
}

/// Errors of a study.
#[derive(Debug, thiserror::Error)]
pub enum TaskError {
    /// The numbers make no machine.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// The machine refuses.
    #[error(transparent)]
    Core(#[from] kinetostat::Error),
    /// The machine as drawn has no answer at a place.
    #[error("as drawn, the machine has no answer at place {place} (counted from 1): {reason}")]
    Unanswered {
        /// Number of the place, from 1.
        place: usize,
        /// Message of the general engine.
        reason: String,
    },
    /// The machine as drawn does not stand as it stood along the program.
    #[error(
        "line {line}: the machine as drawn is {found_mm:.6} mm off there when it is solved for itself, and {stated_mm:.6} mm along the program: it stands otherwise, as an arm in another configuration does"
    )]
    StandsOtherwise {
        /// Line of the program, from 1.
        line: usize,
        /// Error solved here, mm.
        found_mm: f64,
        /// Error along the program, mm.
        stated_mm: f64,
    },
    /// The run was stopped on request.
    #[error(transparent)]
    Stopped(#[from] kinetostat_machining::RunError),
}

/// Function of uncertain numbers.
pub trait DependsOnMachine: Sync {
    /// Numbers of one answer.
    fn width(&self) -> usize;

    /// The answer of the machine with these numbers, NaN where there is none. Returns the places at which it is not stable.
    ///
    /// # Errors
    /// [`TaskError`] where the numbers make no machine.
    fn answer(&self, values: &[f64], room: &mut Room, out: &mut [f64]) -> Result<usize, TaskError>;
}

/// A machine as a function of its uncertain numbers.
#[derive(Clone, Debug)]
pub struct UncertainMachine {
    parametric: ParametricModel,
    sources: Vec<Source>,
    tool: Pose,
    drawn: Mechanism,
    /// Machine as drawn, compiled: the part that all draws share is made once.
    batch: Batch,
    /// Desired poses of the tool, without load and under it.
    places: Commanded,
    loaded: Commanded,
    /// Commands that compensate the load with the numbers of the drawing.
    compensated: Commanded,
    wrench: Wrench,
    quantities: Vec<Quantity>,
    /// Values of the drawing.
    nominal: Vec<f64>,
    /// Stability margins, if the equilibrium under the load is requested.
    margins: Option<Margins>,
}

/// Rooms that a thread uses again and again.
#[derive(Debug, Default)]
pub struct Room {
    pub(crate) unloaded: BatchEquilibrium,
    pub(crate) loaded: BatchEquilibrium,
    pub(crate) compensated: BatchEquilibrium,
    pub(crate) wrenches: Vec<Wrench>,
    pub(crate) deviations: Vec<f64>,
}

impl Room {
    /// Takes by how much values differ from those of the drawing.
    pub(crate) fn deviate(&mut self, values: &[f64], nominal: &[f64]) {
        let each = values.iter().zip(nominal);
        self.deviations.clear();
        self.deviations.extend(each.map(|(x, drawn)| x - drawn));
    }
}

impl UncertainMachine {
    /// A model with the pose of its tool, places of the tool (base from tool) and a load on it (base axes, about its reference point).
    ///
    /// # Errors
    /// What is wrong with the numbers of the drawing, or where the machine as drawn has no answer.
    pub fn new(
        model: &Model,
        tool: &Pose,
        file: &UncertaintyFile,
        places: &[Pose],
        wrench: Wrench,
        quantities: &[Quantity],
    ) -> Result<Self, TaskError> {
        let parametric = model.parametric(&file.parameters())?;
        let nominal: Vec<f64> = parametric.parameters().iter().map(|p| p.value).collect();
        let drawn = parametric.mechanism(&nominal)?.with_tool(tool);
        let batch = Batch::new(&drawn);
        let wrenches = vec![wrench; places.len()];
        let compensated = match quantities.contains(&Quantity::Compensated) {
            true => {
                let targets = compensating(&drawn, &batch, places, &wrench)?;
                batch.commanded_under(&targets, &wrenches)?
            }
            false => batch.commanded(&[]),
        };
        let mut machine = Self {
            parametric,
            sources: file.sources.clone(),
            tool: *tool,
            drawn,
            places: batch.commanded_under(places, &vec![Wrench::zero(); places.len()])?,
            loaded: batch.commanded_under(places, &wrenches)?,
            compensated,
            batch,
            wrench,
            quantities: quantities.to_vec(),
            nominal: file.uncertainties.nominal(),
            margins: None,
        };
        machine.learn(&file.uncertainties)?;
        let mut out = vec![0.0; machine.width()];
        machine.answer(
            &file.uncertainties.nominal(),
            &mut Room::default(),
            &mut out,
        )?;
        if let Some(at) = out.iter().position(|x| !x.is_finite()) {
            let place = at / machine.columns().len();
            let posture = machine.drawn.posture(&places[place]);
            let asked = posture.and_then(|p| p.deflected_by(&wrench));
            let columns = machine.columns();
            let missing = columns[at % columns.len()];
            let reason = asked.err().map_or_else(
                || format!("it stands there under the load, but has no {missing}; leave that out"),
                |e| e.to_string(),
            );
            return Err(TaskError::Unanswered {
                place: place + 1,
                reason,
            });
        }
        Ok(machine)
    }

    /// Names of the numbers of each place.
    #[must_use]
    pub fn columns(&self) -> Vec<&'static str> {
        self.quantities
            .iter()
            .flat_map(|q| q.columns())
            .copied()
            .collect()
    }

    /// Number of places.
    #[must_use]
    pub fn places(&self) -> usize {
        self.places.poses().len()
    }

    /// True if one of these is requested.
    fn asks(&self, some: &[Quantity]) -> bool {
        self.quantities.iter().any(|q| some.contains(q))
    }

    /// The machine with these values, compiled, and the load on it.
    fn built(&self, values: &[f64]) -> Result<(Batch, Wrench), TaskError> {
        let (mut wrench, mut factor) = (self.wrench, 1.0);
        for (source, value) in self.sources.iter().zip(values) {
            match source {
                Source::Load(k) => wrench.0[*k] = *value,
                Source::LoadFactor => factor = *value,
                // The parts of a single wrench are not known: its file has none.
                Source::Parameter(_) | Source::CuttingPart(_) => {}
            }
        }
        wrench.0 *= factor;
        let numbers = Source::of_model(&self.sources, values);
        let mut built = self.parametric.mechanism(&numbers)?;
        if self.tool != Pose::identity() {
            built = built.with_tool(&self.tool);
        }
        Ok((self.batch.built(&built)?, wrench))
    }

    /// Finds out how the machine stands, and how surely, a standard deviation to both sides of the drawing: the search for
    /// the equilibria of every machine starts from derivatives.
    fn learn(&mut self, uncertainties: &Uncertainties) -> Result<(), TaskError> {
        let (count, length) = (self.places(), self.drawn.natural_length());
        let stability = |batch: &Batch, places: &Commanded, load: &Wrench| {
            with_stability(batch, places, &vec![*load; count])
        };
        let mut margins = match self.asks(&LOADED) {
            true => {
                let drawn = stability(&self.batch, &self.loaded, &self.wrench)?;
                Some(Margins::new(&drawn, length))
            }
            false => None,
        };
        for (i, number) in uncertainties.each().iter().enumerate() {
            let step = number.distribution.standard_deviation();
            let at = |by: f64| {
                let mut values = self.nominal.clone();
                values[i] += by;
                self.built(&values)
            };
            // If there is no such machine, others are searched without derivatives from here on.
            let (Ok(more), Ok(less)) = (at(step), at(-step)) else {
                return Ok(());
            };
            if let Some(margins) = &mut margins {
                let [more, less] =
                    [&more, &less].map(|(batch, load)| stability(batch, &self.loaded, load));
                margins.go_along(&more?, &less?, 2.0 * step, length);
            }
            if i >= MOST_DERIVATIVES {
                continue;
            }
            let none = vec![Wrench::zero(); count];
            let [above, below] = [&more, &less].map(|(_, load)| vec![*load; count]);
            let (unloaded, loaded) = (
                [(&more.0, &none), (&less.0, &none)],
                [(&more.0, &above), (&less.0, &below)],
            );
            for (places, quantities, both) in [
                (
                    &mut self.places,
                    &[Quantity::Error, Quantity::DeflectionByLoad][..],
                    unloaded,
                ),
                (&mut self.loaded, &LOADED, loaded),
                (&mut self.compensated, &[Quantity::Compensated], loaded),
            ] {
                if quantities.iter().any(|q| self.quantities.contains(q)) {
                    let [more, less] =
                        both.map(|(batch, wrenches)| LoadedBatch { batch, wrenches });
                    places.go_along(more, less, 2.0 * step)?;
                }
            }
        }
        self.margins = margins;
        Ok(())
    }

    fn put(&self, place: usize, room: &Room, row: &mut [f64]) {
        let target = self.places.poses()[place].translation.vector;
        let mut rest = row;
        for quantity in &self.quantities {
            let (own, after) = std::mem::take(&mut rest).split_at_mut(quantity.columns().len());
            rest = after;
            let moved = match quantity {
                Quantity::Error => at(&room.unloaded, place) - target,
                Quantity::DeflectionByLoad => at(&room.loaded, place) - at(&room.unloaded, place),
                Quantity::Deviation => at(&room.loaded, place) - target,
                Quantity::Compensated => at(&room.compensated, place) - target,
                Quantity::Stiffness => {
                    own.copy_from_slice(&stiffness(&room.loaded, place));
                    continue;
                }
            };
            let mm = moved * 1e3;
            own.copy_from_slice(&[mm.norm(), mm.x, mm.y, mm.z]);
        }
    }
}

impl DependsOnMachine for UncertainMachine {
    /// Places times columns.
    fn width(&self) -> usize {
        self.places() * self.columns().len()
    }

    /// Place after place, column after column; NaN where a place has no answer.
    fn answer(&self, values: &[f64], room: &mut Room, out: &mut [f64]) -> Result<usize, TaskError> {
        let (batch, wrench) = self.built(values)?;
        let count = self.places();
        room.deviate(values, &self.nominal);
        let (wrenches, by) = (&mut room.wrenches, &room.deviations);
        if self.asks(&[Quantity::Error, Quantity::DeflectionByLoad]) {
            refill(wrenches, Wrench::zero(), count);
            let (places, out) = (&self.places, &mut room.unloaded);
            batch.equilibrium_foretold_into(places, by, wrenches, Details::Rest, out)?;
        }
        refill(wrenches, wrench, count);
        let mut unstable = 0;
        if self.asks(&LOADED) {
            let holds = self.margins.as_ref().is_some_and(|m| m.hold(by));
            let details = match (holds, self.asks(&[Quantity::Stiffness])) {
                (true, false) => Details::Rest,
                (true, true) => Details::Stiffness,
                (false, _) => Details::Stability,
            };
            let (places, out) = (&self.loaded, &mut room.loaded);
            batch.equilibrium_foretold_into(places, by, wrenches, details, out)?;
            let stable = (0..count).filter_map(|i| room.loaded.stability(i));
            unstable = stable.filter(|s| !s.stable).count();
        }
        if self.asks(&[Quantity::Compensated]) {
            let (places, out) = (&self.compensated, &mut room.compensated);
            batch.equilibrium_foretold_into(places, by, wrenches, Details::Rest, out)?;
        }
        let each = self.columns().len();
        for (place, row) in out.chunks_exact_mut(each.max(1)).enumerate() {
            self.put(place, room, row);
        }
        Ok(unstable)
    }
}

/// Poses to command so that the machine as drawn has its tool at `places` under the load, with the orientation that it can have there
/// where it turns its tool as it moves; not numbers where there is none.
fn compensating(
    drawn: &Mechanism,
    batch: &Batch,
    places: &[Pose],
    wrench: &Wrench,
) -> kinetostat::Result<Vec<Pose>> {
    if !drawn.turns_as_it_moves() {
        let wrenches = vec![*wrench; places.len()];
        let found = batch.targets_under_load(places, &wrenches, Directions::POSITION)?;
        return Ok(found.targets);
    }
    let target = |place: &Pose| {
        let near = drawn.posture(place)?;
        let (position, rotation) = (&place.translation.vector, &place.rotation);
        let start = near.rest_state();
        target_under_load_following(&near, position, rotation, wrench, start)
    };
    let nowhere = Pose::translation(f64::NAN, f64::NAN, f64::NAN);
    let found = places.iter().map(target);
    Ok(found
        .map(|found| found.map_or(nowhere, |(posture, _)| *posture.target()))
        .collect())
}

fn refill(wrenches: &mut Vec<Wrench>, wrench: Wrench, count: usize) {
    wrenches.clear();
    wrenches.resize(count, wrench);
}

/// Position of the tool, m; NaN without an answer.
pub(crate) fn at(found: &BatchEquilibrium, place: usize) -> Vector3<f64> {
    match found.status[place].is_solved() {
        true => Vector3::from_fn(|k, _| found.tool.get(place, 9 + k)),
        false => Vector3::repeat(f64::NAN),
    }
}

/// Force per motion along x, y and z with the tool free to turn, N/mm; NaN without an answer or where a direction is free.
fn stiffness(found: &BatchEquilibrium, place: usize) -> [f64; 3] {
    if !found.status[place].is_solved() {
        return [f64::NAN; 3];
    }
    let matrix = Matrix6::from_fn(|i, j| found.stiffness.get(place, 6 * i + j));
    // The compliance, of forces alone.
    match matrix.lu().solve(&Matrix6x3::identity()) {
        Some(compliance) => [0, 1, 2].map(|k| 1e-3 / compliance[(k, k)]),
        None => [f64::NAN; 3],
    }
}
