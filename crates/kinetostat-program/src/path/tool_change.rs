//! Which tool a block is made with.

/// A block from which on another tool is used.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
pub struct ToolChange {
    /// Line of the block, counted from 1.
    pub line: usize,
    /// Number of the tool.
    pub number: u32,
}
