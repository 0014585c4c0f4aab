//! `[place]` of a job file: where the part may lie.

use kinetostat_model::schema::Placement as PoseTable;
use serde::Deserialize;
use serde_spanned::Spanned;

/// Objective that is minimised.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, clap::ValueEnum)]
#[serde(rename_all = "snake_case")]
pub(crate) enum ObjectiveWord {
    /// The largest error before compensation
    Error,
    /// The largest correction that compensation commands
    Correction,
    /// The largest tilt of the tool, which stays where only its place is compensated
    Tilt,
    /// The largest drive load as a share of its rating
    Drive,
    /// The largest share of the way to buckling
    Buckling,
}

/// Range of the part's placement: smallest and largest values, mm and degrees.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct PlaceTable {
    /// Objective to be minimised.
    pub objective: Option<ObjectiveWord>,
    /// Range of the program's zero point, base axes.
    pub x_mm: Option<Spanned<[f64; 2]>>,
    pub y_mm: Option<Spanned<[f64; 2]>>,
    pub z_mm: Option<Spanned<[f64; 2]>>,
    /// Range of the part's turns, about axes of the base through the program's zero.
    pub turn_x_deg: Option<Spanned<[f64; 2]>>,
    pub turn_y_deg: Option<Spanned<[f64; 2]>>,
    pub turn_z_deg: Option<Spanned<[f64; 2]>>,
    /// Range of the tool's turn about its own axis.
    pub turn_tool_deg: Option<Spanned<[f64; 2]>>,
    /// A box around the part, program axes: smallest and largest coordinates.
    pub part_box_mm: Option<Spanned<[[f64; 3]; 2]>>,
    /// Places where the part can be clamped.
    #[serde(default)]
    pub fixtures: Vec<Spanned<FixtureTable>>,
    /// Boxes that neither path nor part may enter.
    #[serde(default)]
    pub obstacles: Vec<Spanned<ObstacleTable>>,
}

/// A place where the part can be clamped.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct FixtureTable {
    pub name: String,
    /// Position of the program's zero point, base axes, mm.
    pub part_origin_mm: [f64; 3],
    /// Orientation of the program's axes in the base.
    pub part_orientation: Option<Spanned<PoseTable>>,
}

/// A box along the axes of the base.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ObstacleTable {
    pub name: String,
    /// Smallest coordinates, base axes, mm.
    pub from_mm: [f64; 3],
    /// Largest coordinates.
    pub to_mm: [f64; 3],
}
