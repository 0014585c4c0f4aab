//! Warnings about cuts, and errors of their computation.

use std::collections::BTreeMap;

use kinetostat::number::short;
use kinetostat_cutting::CutError;
use serde::Serialize;

/// Kind of a warning about a cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum CutFindingKind {
    /// A rapid goes through material.
    RapidThroughStock,
    /// The feed per tooth is more than the maker allows.
    ThickChip,
    /// The chip is outside the thicknesses for which the law was measured.
    OutsideTheLaw,
    /// More torque or power than the spindle has, or more speed.
    Spindle,
    /// The cut is deeper than the edges are long.
    ShortEdges,
    /// The cut is as deep as hardly a tool has edges, whose length nobody stated.
    DeepCut,
    /// An engagement is stated for lines on which nothing is cut.
    LinesWithoutCut,
    /// The tool goes down into material where its end is, as the whole tool is, in contact: tools that do not cut at the centre
    /// cannot.
    Plunge,
    /// The flat end takes chips that are thinner than the law of force knows: its force is that of edges, and a guess.
    EndBeyondTheLaw,
    /// A feed per tooth that is too small for a chip, as of a feed in mm/s.
    ThinFeed,
    /// The tip is further below the stock than the tool is wide.
    BelowTheStock,
    /// No feed move meets the stock.
    NothingCut,
    /// The program turns the spindle counter-clockwise, and the helix is that of a right-hand tool if nobody says otherwise.
    LeftHandTool,
    /// The log of the forces does not cover a move.
    NotMeasured,
    /// A force was measured in a rapid.
    ForceInRapid,
    /// The time of a move is not known because its path is not.
    TimeUnknown,
}

/// A finding on the line where it is worst.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CutFinding {
    /// Kind of the warning.
    pub kind: CutFindingKind,
    /// Line where it is worst.
    pub line: usize,
    /// Number of lines.
    pub lines: usize,
    /// Text of the warning.
    pub text: String,
}

/// Findings by kind, with the worst of each.
#[derive(Clone, Debug, Default)]
pub(crate) struct Findings {
    worst: BTreeMap<CutFindingKind, (f64, usize, CutFinding)>,
}

impl Findings {
    /// A finding on a line, of some size; the text is made for the worst alone.
    pub fn add(
        &mut self,
        kind: CutFindingKind,
        line: usize,
        size: f64,
        text: impl FnOnce() -> String,
    ) {
        let found = self.worst.entry(kind).or_insert_with(|| {
            let none = CutFinding {
                kind,
                line,
                lines: 0,
                text: String::new(),
            };
            (f64::NEG_INFINITY, 0, none)
        });
        if found.1 != line {
            found.1 = line;
            found.2.lines += 1;
        }
        if size > found.0 {
            found.0 = size;
            found.2.line = line;
            found.2.text = text();
        }
    }

    pub fn list(self) -> Vec<CutFinding> {
        self.worst
            .into_values()
            .map(|(_, _, found)| found)
            .collect()
    }
}

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
