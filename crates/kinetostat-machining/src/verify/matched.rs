//! Match of a program with the original that it is verified against.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Match of a program with its original.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema, Deserialize)]
#[non_exhaustive]
pub struct Matched {
    /// Largest distance of the program from the original as the model compensates it, mm.
    pub largest_distance_mm: f64,
    /// Line of the program where that is.
    pub largest_distance_line: usize,
    /// Parts of the original that the program does not cut, in their order.
    pub uncut: Vec<Uncut>,
    /// Rapids that go elsewhere than those of the original, one of each way from cut to cut.
    #[serde(default)]
    pub rapids: Vec<RapidElsewhere>,
    /// Moves at feed that the original does not make.
    #[serde(default)]
    pub extra_cuts: Vec<ExtraCut>,
    /// Cuts of both with another feed or another speed of the spindle.
    #[serde(default)]
    pub conditions: Vec<OtherCondition>,
    /// Moves of cuts that both make: of the program, and of the original, by their indices.
    #[serde(skip)]
    pub cuts: Vec<[usize; 2]>,
    /// Largest difference of the tool's orientation from that of the original, if both state any.
    #[serde(default)]
    pub turned: Option<Turned>,
}

/// An orientation that the original does not state there.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema, Deserialize)]
pub struct Turned {
    /// Line of the program.
    pub line: usize,
    /// Line of the original.
    pub line_of_original: usize,
    /// Angle between both, deg, beyond what they may differ by along a move that turns the tool.
    pub angle_deg: f64,
}

/// Kind of a difference between cuts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Condition {
    /// F, or how it counts.
    Feed,
    /// Speed of the spindle, or that it turns where the original does not say so.
    Spindle,
    /// The spindle stands still or turns the other way round.
    Rotation,
}

/// Moves that the original makes otherwise than where they go.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema, Deserialize)]
pub struct OtherCondition {
    /// Kind of the difference.
    pub condition: Condition,
    /// Lines of the program, first and last.
    pub lines: [usize; 2],
    /// Line of the original that the first belongs to.
    pub line_of_original: usize,
    /// Value in the original.
    pub of_original: String,
    /// Value in the program.
    pub of_program: String,
}

/// A rapid of a program that goes elsewhere than that of the original.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema, Deserialize)]
pub struct RapidElsewhere {
    /// Line of the program.
    pub line: usize,
    /// Line of the original; `None` if that has no rapid there.
    pub line_of_original: Option<usize>,
    /// Position to which one of them goes, program coordinates, mm.
    pub position_mm: [f64; 3],
    /// Distance of the other one from there, mm.
    pub distance_mm: f64,
}

/// A move at feed of a program that the original does not make.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema, Deserialize)]
pub struct ExtraCut {
    /// Line of the program.
    pub line: usize,
    /// Length of the cut, mm.
    pub length_mm: f64,
}

/// A part of the original that a program does not cut.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema, Deserialize)]
pub struct Uncut {
    /// First and last line of it in the original.
    pub lines: [usize; 2],
    /// Length of the part, mm.
    pub length_mm: f64,
}
