//! A tool in a material.

use std::sync::Arc;

use kinetostat_cutting::{ForceLaw, Tool};

/// A tool with the law of force of the material that it cuts.
#[derive(Clone, Debug)]
pub struct CuttingTool {
    /// Number in the program's T words; `None` for the tool of blocks whose tool has no entry of its own.
    pub number: Option<u32>,
    /// Cutting edges.
    pub tool: Tool,
    /// Force per length of edge.
    pub law: Arc<dyn ForceLaw>,
    /// Half width of the band in which the force lies, as a share of it.
    pub spread: f64,
    /// Thickest chip that the maker allows, mm per tooth.
    pub max_chip_mm: Option<f64>,
    /// Length of the edges, mm.
    pub flute_length_mm: Option<f64>,
}

impl CuttingTool {
    /// A tool for all blocks, with nothing known but its edges and the law.
    #[must_use]
    pub fn new(tool: Tool, law: Arc<dyn ForceLaw>) -> Self {
        Self {
            number: None,
            tool,
            law,
            spread: 0.0,
            max_chip_mm: None,
            flute_length_mm: None,
        }
    }
}
