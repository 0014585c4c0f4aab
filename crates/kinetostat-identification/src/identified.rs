//! A number as it was identified, and a posture as it fits.

use schemars::JsonSchema;
use serde::Serialize;

use crate::geometry::is_geometry;
use crate::identifiability::Knowledge;

/// A number of the model as it was identified.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct IdentifiedNumber {
    /// Path of the number in the model file.
    pub number: String,
    /// Unit of its key; empty without one.
    pub unit: String,
    /// What the model said.
    pub before: f64,
    /// What the readings say; null where its compliance vanishes.
    pub identified: Option<f64>,
    /// Standard deviation relative to the value, percent; of an entry of a matrix relative to the geometric mean of its diagonal entries.
    /// Null where nothing is known, and for errors of the geometry and places of markers, which have their size in `deviation` only.
    pub deviation_percent: Option<f64>,
    /// Standard deviation in the unit of the number; null where nothing is known.
    pub deviation: Option<f64>,
    /// Bounds with a confidence of 95 %, none of an entry of a matrix; the upper one of a stiffness is null where it may be rigid.
    pub interval: Option<[Option<f64>; 2]>,
    /// It is zero, its bound: the compliance of a spring that the readings do not tell from rigid.
    pub at_bound: bool,
    /// A number of the model file; friction and places of markers are none.
    pub is_of_model: bool,
    /// A spring that acts as a load beside the joints (a gravity compensator).
    pub acts_beside_joints: bool,
    /// How well the readings know it.
    pub knowledge: Knowledge,
    /// Part of the displacements that was read which comes from it, root mean square, mm.
    pub explains_mm: f64,
    /// The combination that is known where the number alone is not.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub known_combination: Option<String>,
}

impl IdentifiedNumber {
    /// True for an error of the geometry and for the place of a marker: one of many that say only together where the tool is.
    #[must_use]
    pub fn is_geometry(&self) -> bool {
        is_geometry(&self.number)
    }
}

/// Readings of one posture.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct PostureResiduals {
    /// Name.
    pub posture: String,
    /// Readings.
    pub readings: usize,
    /// Root mean square of what was read less what the model as it was says, in standard deviations.
    pub before: f64,
    /// The same for the identified model.
    pub after: f64,
    /// The same for a model identified from all other postures; null where these do not determine it.
    pub left_out: Option<f64>,
}

/// Displacements along an axis of the base, root mean squares.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct DirectionResiduals {
    /// Axis: x, y or z.
    pub axis: String,
    /// What was read, mm.
    pub reading_mm: f64,
    /// What the model as it was leaves of it, mm.
    pub before_mm: f64,
    /// What the identified model leaves of it, mm.
    pub after_mm: f64,
}
