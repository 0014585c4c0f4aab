//! The answer of `equilibria`: every shape with its energy, stability and forces, and how complete
//! the list is.

use kinetostat::number::{larger, smaller};
use kinetostat_diagnostic::ErrorCode;
use kinetostat_machining::{Warning, folds};
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::Serialize;

use crate::end_condition::coordinates::CoordinateName;
use crate::end_condition::holding::Holding;
use crate::machine::displacement_warnings::{large_reaction, stretches};
use crate::place::query::AnswerHead;
use crate::ui::failure::{Failing, Failure};
use crate::ui::numbers::number;

/// The answer, stable names with units.
#[derive(Serialize, JsonSchema)]
pub(crate) struct EquilibriaAnswer {
    #[serde(flatten)]
    pub(crate) head: AnswerHead,
    pub(crate) question: String,
    pub(crate) tool_held: Holding,
    /// Direction of `stiffness_n_per_mm`; null: the principal one with the smallest stiffness.
    pub(crate) stiffness_along: Option<[f64; 3]>,
    pub(crate) coordinates: Vec<CoordinateName>,
    /// Equilibria by rising energy.
    pub(crate) equilibria: Vec<ShapeAnswer>,
    pub(crate) coverage: Coverage,
    pub(crate) conservative: bool,
    pub(crate) warnings: Vec<Warning>,
    /// Chain's shape per equilibrium, m.
    #[serde(skip)]
    pub(crate) outlines: Vec<Vec<Vector3<f64>>>,
}

/// One equilibrium.
#[derive(Serialize, JsonSchema)]
pub(crate) struct ShapeAnswer {
    pub(crate) number: usize,
    /// Springs and loads, up to a constant; of the springs alone where a load has no potential.
    pub(crate) energy_j: f64,
    /// Stable under the conditions as prescribed.
    pub(crate) stable: bool,
    /// True if it does not diverge under loads without a potential, but may swing with growing
    /// amplitude, depending on the masses.
    pub(crate) may_flutter: bool,
    /// Stable with the tool held.
    pub(crate) shape_stable: bool,
    /// mu; null without inner freedom, and where a passive joint is pushed out of line.
    pub(crate) share_to_buckling: Option<f64>,
    /// Motion of the coordinates in which it would buckle.
    pub(crate) mode_in_words: String,
    /// True at a limit or bifurcation point, or in a family with zero stiffness.
    pub(crate) singular: bool,
    pub(crate) found_by_spread_starts: usize,
    /// Along the requested direction; without one the smallest principal stiffness, rotations at the
    /// natural length. Null if infinite.
    #[schemars(with = "Option<f64>")]
    pub(crate) stiffness_n_per_mm: f64,
    /// Rows: force (N), moment (N m); columns: displacement (m), rotation (rad); at the tool's tip.
    #[schemars(with = "[[Option<f64>; 6]; 6]")]
    pub(crate) stiffness_n_m_rad: [[f64; 6]; 6], // NaN (null) where it is infinite
    pub(crate) force_n: [f64; 3],
    pub(crate) moment_n_m: [f64; 3],
    pub(crate) position_mm: [f64; 3],
    pub(crate) rotation_vector_deg: [f64; 3],
    pub(crate) coordinates: Vec<f64>,
}

/// Completeness of the list.
#[derive(Serialize, JsonSchema)]
pub(crate) struct Coverage {
    pub(crate) starts: usize,
    pub(crate) ended_within_bounds: usize,
    pub(crate) ended_outside_bounds: usize,
    /// Starts since the last new equilibrium.
    pub(crate) fruitless: usize,
    /// Null where every equilibrium was found more than once: only the upper end is known then.
    pub(crate) chance_of_more: Option<f64>,
    pub(crate) chance_of_more_at_most: f64,
    #[serde(rename = "settled")]
    pub(crate) exhausted: bool,
    /// True if more certainly exist: the energy has a minimum, and none of those found is one.
    pub(crate) incomplete: bool,
    /// Equilibria known; more than are listed where there are too many combinations of the limbs' shapes.
    pub(crate) known: usize,
    pub(crate) known_stable: usize,
    /// Limbs of a machine whose tool is held: every combination of their shapes is an equilibrium.
    pub(crate) limbs: Vec<LimbCoverage>,
}

/// Shapes of one limb with the tool held.
#[derive(Serialize, JsonSchema)]
pub(crate) struct LimbCoverage {
    pub(crate) name: String,
    pub(crate) shapes: usize,
    pub(crate) stable: usize,
    pub(crate) starts: usize,
    pub(crate) fruitless: usize,
    pub(crate) chance_of_more_at_most: f64,
    #[serde(rename = "settled")]
    pub(crate) exhausted: bool,
}

/// Energies below are rounding, J: less than what warmth gives a molecule.
const NO_ENERGY: f64 = 1e-20;

impl EquilibriaAnswer {
    /// Adds warnings if even the nearest equilibrium is so far from the commanded place that a load folds a machine of
    /// this size (m) over, or that its springs are stretched; and if holding the tool takes more force in every
    /// equilibrium than any cut has.
    pub(crate) fn with_plausibility_warnings(mut self, size: f64) -> Self {
        let commanded = Vector3::from(self.head.place.position_mm);
        let away = |e: &ShapeAnswer| 1e-3 * (Vector3::from(e.position_mm) - commanded).norm();
        let nearest = self.equilibria.iter().map(away).reduce(smaller);
        self.warnings.extend(nearest.and_then(|far| {
            let by_load = || folds(far, size).filter(|_| self.tool_held.held.is_empty());
            stretches(far, size).or_else(by_load)
        }));
        let reactions = self.equilibria.iter();
        let least = reactions
            .map(|e| Vector3::from(e.force_n).norm())
            .reduce(smaller);
        let held = !self.tool_held.held.is_empty();
        let least = least.filter(|_| held).into_iter();
        self.warnings.extend(least.flat_map(large_reaction));
        self.warnings.dedup();
        self
    }

    /// Returns a failure if nothing was found, which does not prove that there is no equilibrium.
    pub(crate) fn unanswered(&self) -> Option<Failure> {
        self.equilibria.is_empty().then(|| {
            ErrorCode::NotConverged.failure(format!(
                "no equilibrium of the {} was found",
                self.tool_held.subject
            ))
        })
    }

    /// The energy of a shape for people, J: zero where it is rounding beside the others.
    pub(crate) fn energy(&self, shape: &ShapeAnswer, digits: i32) -> String {
        let sizes = self.equilibria.iter().map(|e| e.energy_j.abs());
        let least = larger(NO_ENERGY, 1e-12 * sizes.fold(0.0, larger));
        match shape.energy_j.abs() <= least {
            true => "0".to_owned(),
            false => number(shape.energy_j, digits),
        }
    }
}
