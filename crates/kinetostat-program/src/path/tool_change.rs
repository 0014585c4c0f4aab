//! Tool of a block.

/// A block from which on another tool is used.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
pub struct ToolChange {
    /// Line of the block, counted from 1.
    pub line: usize,
    /// Number of the tool that is used from this block on.
    pub number: u32,
}
