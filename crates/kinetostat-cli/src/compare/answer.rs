//! The answer of `compare`, stable names with units.

use kinetostat_machining::Warning;
use schemars::JsonSchema;
use serde::Serialize;

#[derive(Serialize, JsonSchema)]
pub(crate) struct Compared {
    pub(crate) schema: u32,
    pub(crate) kinetostat_version: &'static str,
    pub(crate) a: String,
    pub(crate) b: String,
    pub(crate) places: Vec<AtPlace>,
    /// Over the grid.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) difference: Option<Summary>,
    pub(crate) warnings: Vec<Warning>,
}

#[derive(Serialize, JsonSchema)]
pub(crate) struct AtPlace {
    pub(crate) a: Figures,
    pub(crate) b: Figures,
}

/// Figures of the unloaded machine as drawn.
#[derive(Serialize, JsonSchema)]
pub(crate) struct Figures {
    pub(crate) position_mm: [f64; 3],
    #[schemars(with = "Option<f64>")]
    pub(crate) smallest_stiffness_n_per_mm: f64,
    /// Stiffness against a force along x, y, z, by the motion along it; null if nothing holds or yields.
    pub(crate) stiffness_n_per_mm: [Option<f64>; 3],
    /// Shares of the deflection under a force along x, the largest first.
    pub(crate) shares_x: Vec<Share>,
    pub(crate) shares_y: Vec<Share>,
    pub(crate) shares_z: Vec<Share>,
}

#[derive(Serialize, JsonSchema)]
pub(crate) struct Share {
    pub(crate) limb: Option<String>,
    pub(crate) name: String,
    pub(crate) share: f64,
}

/// The smallest stiffness of B by that of A over a grid.
#[derive(Clone, Serialize, JsonSchema)]
pub(crate) struct Summary {
    pub(crate) places: usize,
    /// Places that both reach within their limits, with a stiffness.
    pub(crate) common: usize,
    pub(crate) only_a: usize,
    pub(crate) only_b: usize,
    /// Share of the common places where B is the stiffer one.
    pub(crate) b_stiffer_share: f64,
    pub(crate) mean_ratio: f64,
    pub(crate) least_ratio: f64,
    pub(crate) least_at_mm: [f64; 3],
    pub(crate) most_ratio: f64,
    pub(crate) most_at_mm: [f64; 3],
}
