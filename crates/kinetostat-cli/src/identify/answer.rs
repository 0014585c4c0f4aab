//! The answer of `identify`, stable names with units.

use kinetostat_identification::{ErrorAtWork, Identification, InstrumentFrame};
use schemars::JsonSchema;
use serde::Serialize;

/// The answer, stable names with units.
#[derive(Serialize, JsonSchema)]
pub(crate) struct IdentifyAnswer {
    pub(crate) schema: u32,
    pub(crate) kinetostat_version: &'static str,
    pub(crate) model: String,
    pub(crate) model_source: String,
    pub(crate) measurements: String,
    /// Loads are small and weights left out.
    pub(crate) small_loads: bool,
    pub(crate) robust: bool,
    /// Frame of the instrument in the base, if it was found.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) instrument: Option<InstrumentPlace>,
    #[serde(flatten)]
    pub(crate) found: Identification,
    /// Errors after compensation along the program of a job, if one was given.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(crate) work: Vec<WorkError>,
}

/// Errors at a place of a program.
#[derive(Serialize, JsonSchema)]
pub(crate) struct WorkError {
    /// Length of the path up to here, mm.
    pub(crate) path_mm: f64,
    #[serde(flatten)]
    pub(crate) error: ErrorAtWork,
}

/// Where the instrument stood.
#[derive(Serialize, JsonSchema)]
pub(crate) struct InstrumentPlace {
    pub(crate) position_mm: [f64; 3],
    pub(crate) rotation_vector_deg: [f64; 3],
    /// Distance of its places without a load from those of the model, root mean square.
    pub(crate) left_mm: f64,
    pub(crate) places: usize,
}

impl From<InstrumentFrame> for InstrumentPlace {
    fn from(frame: InstrumentFrame) -> Self {
        Self {
            position_mm: (frame.origin * 1e3).into(),
            rotation_vector_deg: frame.rotation.scaled_axis().map(f64::to_degrees).into(),
            left_mm: 1e3 * frame.left,
            places: frame.places,
        }
    }
}
