//! Rounded corners and chamfers as they are read: the lines beside them, and what they become.

use std::ops::Range;

use nalgebra::{Vector2, Vector3};

use crate::corner::{Beside, Corner, Cut, Leg};
use crate::heidenhain::blocks::Block;

/// True if a program may have rounded corners or chamfers.
pub(crate) fn has_corners(bytes: &[u8]) -> bool {
    bytes
        .windows(3)
        .any(|part| part.eq_ignore_ascii_case(b"RND") || part.eq_ignore_ascii_case(b"CHF"))
}

/// A straight block, or an arc about a pole, whose start and end are known, in the programmed axes, mm.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Line {
    pub block: Block,
    pub from: Vector3<f64>,
    pub to: Vector3<f64>,
    pub arc: Option<Beside>,
    pub rapid: bool,
    pub unit_mm: f64,
    /// In force at its end, as programmed.
    pub feed: Option<f64>,
}

impl Line {
    /// In the plane.
    pub(crate) fn leg(&self) -> Leg {
        Leg {
            from: self.from.xy(),
            to: self.to.xy(),
            arc: self.arc,
        }
    }
}

/// Remedy of a corner that is not followed.
pub(crate) const AS_ARC: &str =
    "let the CAM system write the corner as an arc (CR or C) between its lines";
pub(crate) const AS_LINE: &str =
    "let the CAM system write the chamfer as an L block between its lines";

/// A block RND or CHF behind a line.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Pending {
    pub line: Option<Line>,
    pub block: Block,
    pub span: Range<usize>,
    /// Cut of the corner, in mm, or the reason why it is unknown.
    pub cut: Result<Cut, String>,
    pub feed: Option<f64>,
    /// Remedy if the corner is not followed.
    pub remedy: &'static str,
}

/// A rounded corner, or a chamfer.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Rounded {
    /// The blocks of the line before, of the corner, and of the line behind.
    pub blocks: [Block; 3],
    pub corner: Corner,
    /// Cut as programmed, in mm.
    pub cut: Cut,
    /// F of the block itself, and the feed that is in force again behind it.
    pub feed: Option<f64>,
    pub feed_behind: Option<f64>,
    /// Programmed end of the second line, mm.
    pub to: Vector2<f64>,
    pub unit_mm: f64,
}

/// A corner that is not followed: where, why, what to do.
pub(crate) type Unrounded = (Range<usize>, String, &'static str);
