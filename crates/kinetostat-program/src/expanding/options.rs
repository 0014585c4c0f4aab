//! What a program does not say and its expansion needs.

use std::collections::BTreeMap;

use crate::reading::options::ReadOptions;

/// Most blocks of a flat program, if nothing else is said.
const MOST_BLOCKS: usize = 5_000_000;

/// Settings of the expansion.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct ExpandOptions {
    /// How the flat program is read.
    pub reading: ReadOptions,
    /// Most blocks of the flat program: loops that do not end are refused by their line.
    pub most_blocks: usize,
    /// Values of numbered parameters before the program, as a controller keeps them.
    pub parameters: BTreeMap<u32, f64>,
}

impl Default for ExpandOptions {
    fn default() -> Self {
        Self {
            reading: ReadOptions::default(),
            most_blocks: MOST_BLOCKS,
            parameters: BTreeMap::new(),
        }
    }
}
