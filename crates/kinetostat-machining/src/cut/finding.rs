//! Warnings about cuts.

use std::collections::BTreeMap;

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
