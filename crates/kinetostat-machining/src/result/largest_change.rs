//! Largest rate of change of the written correction along the path. Plain data, units in the name of the list it stands in.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The fastest change of the written correction along feed moves, mm per mm of path: of the written positions less their places
/// on the path, over every stretch of a hundred last digits (0.01 mm with four decimals), which rounding makes at most 0.018
/// larger. Steps, where the tool stands at one place of the path, are no part of it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, JsonSchema, Deserialize)]
#[non_exhaustive]
pub struct LargestChange {
    /// Largest change, mm per mm.
    pub value: f64,
    /// Line of the program on which it is.
    pub line: usize,
    /// Largest change that is stated for the load there ([`ProgramLoad::largest_step`](crate::ProgramLoad::largest_step)), mm per mm;
    /// none where any is allowed.
    pub stated: Option<f64>,
    /// Lines on which the change is larger than what is stated for them, by more than rounding makes of it.
    pub lines_beyond: usize,
}
