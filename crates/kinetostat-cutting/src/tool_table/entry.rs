//! Entry of a table for one tool.

use crate::tool::Tool;

/// A tool with what a cut needs to know beside its edges.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct ToolEntry {
    /// Number by which the program calls it (T).
    pub number: u32,
    /// Name of the tool; the comment of `tool.tbl` if the table has none, empty if neither has one.
    pub name: String,
    /// Geometry of the tool.
    pub tool: Tool,
    /// Length outside the holder, mm.
    pub stick_out_mm: Option<f64>,
    /// Length of the edges, mm, at most the stick-out.
    pub flute_length_mm: Option<f64>,
    /// Rake angle, degrees.
    pub rake_deg: Option<f64>,
    /// Feed per tooth that the maker allows, mm.
    pub max_chip_mm: Option<f64>,
    /// Length offset of the controller (G43), mm: from a reference of the machine's, so it may be negative.
    pub length_mm: Option<f64>,
}
