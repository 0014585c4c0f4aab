//! A table of tools as it is written.

use std::ops::Range;

use serde::Deserialize;
use serde_spanned::Spanned;

use crate::tool::Tool;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct File {
    #[serde(default)]
    pub(crate) tool: Vec<Spanned<WrittenTool>>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum ShapeName {
    Flat,
    Ball,
    Bull,
    Face,
}

/// A tool as it is written in TOML, with the keys of a table of tools: for files that hold one among other things.
///
/// [`crate::ToolEntry::written`] makes a tool of it.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WrittenTool {
    pub(crate) number: Option<Spanned<u32>>,
    #[serde(default)]
    pub(crate) name: String,
    pub(crate) shape: Spanned<ShapeName>,
    pub(crate) diameter_mm: Option<Spanned<f64>>,
    pub(crate) teeth: Spanned<u32>,
    pub(crate) helix_deg: Option<Spanned<f64>>,
    pub(crate) corner_radius_mm: Option<Spanned<f64>>,
    pub(crate) lead_angle_deg: Option<Spanned<f64>>,
    pub(crate) stick_out_mm: Option<Spanned<f64>>,
    pub(crate) flute_length_mm: Option<Spanned<f64>>,
    pub(crate) run_out_um: Option<Spanned<f64>>,
    pub(crate) run_out_angle_deg: Option<Spanned<f64>>,
    pub(crate) rake_deg: Option<Spanned<f64>>,
    pub(crate) max_chip_mm: Option<Spanned<f64>>,
    pub(crate) length_mm: Option<Spanned<f64>>,
}

impl WrittenTool {
    /// A key that has a meaning in a table of tools alone (`number`, `length_mm`), with its place in the text.
    ///
    /// ```
    /// use kinetostat_cutting::WrittenTool;
    ///
    /// let text = "shape = \"flat\"\nteeth = 2\nlength_mm = 60";
    /// let written: WrittenTool = toml::from_str(text)?;
    /// assert_eq!(written.key_of_a_table(), Some(("length_mm", 37..39)));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn key_of_a_table(&self) -> Option<(&'static str, Range<usize>)> {
        let number = self.number.as_ref().map(|n| ("number", n.span()));
        number.or_else(|| self.length_mm.as_ref().map(|l| ("length_mm", l.span())))
    }
}

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
