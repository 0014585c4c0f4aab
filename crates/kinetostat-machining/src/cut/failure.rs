//! Errors of the computation of cutting forces.

use kinetostat::number::short;
use kinetostat_cutting::CutError;

/// Reason for which no force can be computed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CutFailure {
    /// A value that the force depends on is stated nowhere.
    #[error("line {line}: {what}; {help}")]
    Missing {
        /// Line of the program, from 1.
        line: usize,
        /// Missing value.
        what: &'static str,
        /// Remedy.
        help: &'static str,
    },
    /// The program takes a tool that nobody has described.
    #[error(
        "line {line}: the program cuts with tool {number}, of which nothing is known; describe it in the table of tools, or a tool for all others"
    )]
    UnknownTool {
        /// Line of the first cut with it.
        line: usize,
        /// Number of the tool.
        number: u32,
    },
    /// The program cuts before it takes a tool, and there is none for such blocks.
    #[error(
        "line {line}: the program cuts before it takes a tool (T); describe a tool for all blocks, or add the T word"
    )]
    NoTool {
        /// Line of the first such cut.
        line: usize,
    },
    /// A cut that this tool cannot make.
    #[error("line {line}: {error}")]
    Cut {
        /// Line of the program, from 1.
        line: usize,
        /// Underlying error.
        error: Box<CutError>,
    },
    /// The stock lies beside all feed moves.
    #[error(
        "the stock lies from {} to {} mm, and the tip goes from {} to {} mm beside it: nothing would be cut. Correct the corners of the stock or the zero of the program, or leave the stock out",
        corner(&.stock_mm[0]), corner(&.stock_mm[1]), corner(&.path_mm[0]), corner(&.path_mm[1])
    )]
    BesideStock {
        /// Lowest and highest corner of the stock, mm.
        stock_mm: [[f64; 3]; 2],
        /// Lowest and highest coordinates of the tip in feed moves, mm.
        path_mm: [[f64; 3]; 2],
    },
    /// A log of forces that cannot be used, or does not belong to this program.
    #[error("measured forces: {error}")]
    Log {
        /// Underlying error.
        error: Box<CutError>,
    },
    /// Stopped on request.
    #[error("stopped on request; nothing was written")]
    Cancelled,
}

/// A corner in words.
fn corner([x, y, z]: &[f64; 3]) -> String {
    format!("({}, {}, {})", short(*x), short(*y), short(*z))
}
