//! What a program does not say and its expansion needs.

use std::collections::BTreeMap;

use crate::reading::options::ReadOptions;

/// Most blocks of a flat program, if nothing else is said.
const MOST_BLOCKS: usize = 5_000_000;

/// Whether flat blocks say where they came from.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum OriginComments {
    /// Nothing is added; [`crate::Expanded::origins`] knows it.
    #[default]
    Left,
    /// Behind each block, as in `(line 12)` or `(drill, line 3)`.
    Written,
}

/// Settings of the expansion.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct ExpandOptions {
    /// How the flat program is read.
    pub reading: ReadOptions,
    /// Most blocks of the flat program: loops that do not end are refused by their line.
    pub most_blocks: usize,
    /// Whether flat blocks say where they came from.
    pub origin_comments: OriginComments,
    /// Values of numbered parameters before the program, as a controller keeps them.
    pub parameters: BTreeMap<u32, f64>,
    /// Diameters of tools by their numbers, mm: the radius of G41 and G42. A tool that is not named here is refused there. A
    /// negative diameter puts the tool on the other side.
    pub tool_diameters_mm: BTreeMap<u32, f64>,
}

impl Default for ExpandOptions {
    fn default() -> Self {
        Self {
            reading: ReadOptions::default(),
            most_blocks: MOST_BLOCKS,
            origin_comments: OriginComments::default(),
            parameters: BTreeMap::new(),
            tool_diameters_mm: BTreeMap::new(),
        }
    }
}
