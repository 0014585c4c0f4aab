//! The figures of a map, gathered block by block.

use kinetostat::number::larger;
use kinetostat_machining::{
    Grid, MapPlace, PlaceState, Solving, Warning, WarningCode, folds_at, is_large,
};
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::Serialize;

use crate::machine::displacement_warnings::not_stable;
use crate::map::arguments::Quantity;
use crate::map::columns::Column;

/// The answer, stable names with units.
#[derive(Serialize, JsonSchema)]
pub(crate) struct MapAnswer {
    pub(crate) schema: u32,
    pub(crate) kinetostat_version: &'static str,
    pub(crate) model: String,
    pub(crate) model_source: String,
    pub(crate) tool: String,
    /// Orientation of the tool, everywhere, base axes.
    pub(crate) rotation_vector_deg: [f64; 3],
    /// Largest turn of the tool from that one, if the orientation follows.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) max_tool_turn_deg: Option<f64>,
    pub(crate) grid: GridAnswer,
    pub(crate) loaded: bool,
    pub(crate) force_n: [f64; 3],
    pub(crate) moment_n_m: [f64; 3],
    /// Orientations times loads; the first of them stand above, and figures are the worst of all.
    #[serde(skip_serializing_if = "is_one")]
    pub(crate) cases: usize,
    pub(crate) deviations: Vec<String>,
    pub(crate) places: Places,
    pub(crate) figures: Vec<FigureAnswer>,
    /// Unusual methods by which the equilibria were found.
    #[serde(flatten)]
    pub(crate) solving: Solving,
    pub(crate) warnings: Vec<Warning>,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "as serde calls it")]
fn is_one(count: &usize) -> bool {
    *count == 1
}

#[derive(Serialize, JsonSchema)]
pub(crate) struct GridAnswer {
    pub(crate) from_mm: [f64; 3],
    pub(crate) to_mm: [f64; 3],
    pub(crate) places: [usize; 3],
}

impl From<Grid> for GridAnswer {
    fn from(grid: Grid) -> Self {
        Self {
            from_mm: grid.from_mm,
            to_mm: grid.to_mm,
            places: grid.counts,
        }
    }
}

/// Number of places by answer.
#[derive(Clone, Copy, Debug, Default, Serialize, JsonSchema)]
pub(crate) struct Places {
    #[serde(rename = "asked")]
    pub(crate) requested: usize,
    pub(crate) regular: usize,
    pub(crate) singular: usize,
    pub(crate) unstable: usize,
    pub(crate) outside_limits: usize,
    pub(crate) unreachable: usize,
    pub(crate) no_answer: usize,
}

impl Places {
    fn count(&mut self, state: PlaceState) {
        self.requested += 1;
        *match state {
            PlaceState::Regular => &mut self.regular,
            PlaceState::Singular => &mut self.singular,
            PlaceState::Unstable => &mut self.unstable,
            PlaceState::OutsideLimits => &mut self.outside_limits,
            PlaceState::Unreachable => &mut self.unreachable,
            PlaceState::Unanswered => &mut self.no_answer,
        } += 1;
    }

    fn add(&mut self, other: &Self) {
        self.requested += other.requested;
        self.regular += other.regular;
        self.singular += other.singular;
        self.unstable += other.unstable;
        self.outside_limits += other.outside_limits;
        self.unreachable += other.unreachable;
        self.no_answer += other.no_answer;
    }

    /// Places that have figures.
    pub(crate) fn with_figures(&self) -> usize {
        self.regular + self.singular + self.unstable
    }
}

/// Extremes and mean of one figure over all places where it is a number.
#[derive(Serialize, JsonSchema)]
pub(crate) struct FigureAnswer {
    pub(crate) name: String,
    pub(crate) unit: &'static str,
    pub(crate) least: Option<Extreme>,
    pub(crate) most: Option<Extreme>,
    pub(crate) mean: Option<f64>,
}

/// A value and where it is.
#[derive(Clone, Copy, Debug, Serialize, JsonSchema)]
pub(crate) struct Extreme {
    pub(crate) value: f64,
    pub(crate) position_mm: [f64; 3],
}

impl Quantity {
    pub(crate) const UNLOADED: [Self; 4] = [Self::Softest, Self::X, Self::Y, Self::Z];
    pub(crate) const LOADED: [Self; 6] = [
        Self::Softest,
        Self::X,
        Self::Y,
        Self::Z,
        Self::Displacement,
        Self::Rotation,
    ];

    pub(crate) fn of(self, place: &MapPlace) -> f64 {
        let size = |v: [f64; 3]| Vector3::from(v).norm();
        match self {
            Self::Softest => place.smallest_stiffness_n_per_mm,
            Self::X => place.stiffness_n_per_mm[0],
            Self::Y => place.stiffness_n_per_mm[1],
            Self::Z => place.stiffness_n_per_mm[2],
            Self::Displacement => size(place.displacement_mm),
            Self::Rotation => size(place.rotation_deg),
        }
    }

    /// Name in the JSON.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Softest => "smallest_stiffness_n_per_mm",
            Self::X => "stiffness_x_n_per_mm",
            Self::Y => "stiffness_y_n_per_mm",
            Self::Z => "stiffness_z_n_per_mm",
            Self::Displacement => "displacement_mm",
            Self::Rotation => "rotation_deg",
        }
    }

    pub(crate) fn unit(self) -> &'static str {
        match self {
            Self::Softest | Self::X | Self::Y | Self::Z => "N/mm",
            Self::Displacement => "mm",
            Self::Rotation => "deg",
        }
    }

    pub(crate) fn description(self) -> &'static str {
        match self {
            Self::Softest => "smallest stiffness against a force",
            Self::X => "stiffness against a force along x",
            Self::Y => "stiffness against a force along y",
            Self::Z => "stiffness against a force along z",
            Self::Displacement => "displacement",
            Self::Rotation => "rotation",
        }
    }
}

/// Statistics of a figure.
#[derive(Clone, Copy, Debug, Default)]
struct Gathered {
    least: Option<Extreme>,
    most: Option<Extreme>,
    sum: f64,
    count: usize,
}

impl Gathered {
    fn take(&mut self, value: f64, position_mm: [f64; 3]) {
        if !value.is_finite() {
            return;
        }
        let own = Extreme { value, position_mm };
        self.add(&Self {
            least: Some(own),
            most: Some(own),
            sum: value,
            count: 1,
        });
    }

    /// Takes what came after; of equal values the first place is kept.
    fn add(&mut self, other: &Self) {
        if let Some(least) = other.least
            && self.least.is_none_or(|own| least.value < own.value)
        {
            self.least = Some(least);
        }
        if let Some(most) = other.most
            && self.most.is_none_or(|own| most.value > own.value)
        {
            self.most = Some(most);
        }
        self.sum += other.sum;
        self.count += other.count;
    }
}

/// Figures of some places; blocks are added in the order of the grid.
#[derive(Clone, Debug, Default)]
pub(crate) struct Figures {
    pub(crate) places: Places,
    /// Largest turn of the tool if the orientation follows.
    pub(crate) largest_turn_deg: f64,
    pub(crate) solving: Solving,
    /// Places where the displacement is no deflection any more.
    folded: usize,
    figures: [Gathered; Quantity::LOADED.len()],
    further: Vec<Gathered>,
}

impl Figures {
    /// Gathers the figures of places of a machine of this size, m.
    pub(crate) fn of(places: &[MapPlace], size: f64, further: usize) -> Self {
        let mut own = Self {
            further: vec![Gathered::default(); further],
            ..Self::default()
        };
        for place in places {
            own.places.count(place.state);
            own.solving.note(place.found_by, 1);
            let far = 1e-3 * Quantity::Displacement.of(place);
            own.folded += usize::from(is_large(far, size));
            // Places without figures have none.
            own.largest_turn_deg = larger(own.largest_turn_deg, place.tool_turn_deg);
            for (figure, quantity) in own.figures.iter_mut().zip(Quantity::LOADED) {
                figure.take(quantity.of(place), place.position_mm);
            }
            for (figure, value) in own.further.iter_mut().zip(&place.values) {
                figure.take(*value, place.position_mm);
            }
        }
        own
    }

    pub(crate) fn add(&mut self, other: &Self) {
        self.places.add(&other.places);
        self.solving.add(&other.solving);
        self.folded += other.folded;
        self.largest_turn_deg = larger(self.largest_turn_deg, other.largest_turn_deg);
        for (own, other) in self.figures.iter_mut().zip(&other.figures) {
            own.add(other);
        }
        self.further
            .resize(other.further.len(), Gathered::default());
        for (own, other) in self.further.iter_mut().zip(&other.further) {
            own.add(other);
        }
    }

    /// Warnings of `deflect` at a place, once for the whole grid, of a machine of this size, m.
    pub(crate) fn warnings(&self, size: f64) -> Vec<Warning> {
        let all = self.places.requested;
        let at = |n: usize| match (n, all) {
            (_, 1) => String::new(),
            (n, all) => format!(" at {n} of the {all} places"),
        };
        let mut list = Vec::new();
        if self.places.singular > 0 {
            list.push(Warning::new(
                WarningCode::FreeDirection,
                format!(
                    "the machine has a direction without any stiffness{}: see `kinetostat stiffness`",
                    at(self.places.singular)
                ),
            ));
        }
        if self.places.unstable > 0 {
            list.push(not_stable(&at(self.places.unstable)));
        }
        let most = Quantity::LOADED
            .iter()
            .zip(&self.figures)
            .find(|(quantity, _)| **quantity == Quantity::Displacement)
            .and_then(|(_, gathered)| gathered.most);
        if let Some(most) = most {
            let places = match all {
                1 => String::new(),
                _ => format!(" at worst, and by too much{}", at(self.folded)),
            };
            list.extend(folds_at(1e-3 * most.value, size, &places));
        }
        list
    }

    pub(crate) fn answer(&self, loaded: bool, further: &[Column]) -> Vec<FigureAnswer> {
        let shown = if loaded {
            &Quantity::LOADED[..]
        } else {
            &Quantity::UNLOADED[..]
        };
        let row = |own: &Gathered, name: &str, unit: &'static str| FigureAnswer {
            name: name.to_owned(),
            unit,
            least: own.least,
            most: own.most,
            mean: (own.count > 0).then(|| own.sum / own.count as f64),
        };
        let usual = self.figures.iter().zip(shown);
        let usual = usual.map(|(own, quantity)| row(own, quantity.name(), quantity.unit()));
        let further = self.further.iter().zip(further);
        usual
            .chain(further.map(|(own, column)| row(own, &column.name, column.unit)))
            .collect()
    }
}
