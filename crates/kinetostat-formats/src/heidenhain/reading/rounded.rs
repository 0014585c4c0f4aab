//! Rounded corners as they are read: the lines beside them, and what they become.

use std::ops::Range;

use nalgebra::{Vector2, Vector3};

use crate::corner::Corner;
use crate::heidenhain::blocks::Block;

/// Whether a program may hold rounded corners.
pub(crate) fn has_corners(bytes: &[u8]) -> bool {
    bytes
        .windows(3)
        .any(|part| part.eq_ignore_ascii_case(b"RND"))
}

/// A straight block whose start and end are known, in the programmed axes, mm.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Line {
    pub block: Block,
    pub from: Vector3<f64>,
    pub to: Vector3<f64>,
    pub rapid: bool,
    pub unit_mm: f64,
    /// In force at its end, as programmed.
    pub feed: Option<f64>,
}

/// A block RND behind a line.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Pending {
    pub line: Option<Line>,
    pub block: Block,
    pub span: Range<usize>,
    pub radius: Option<f64>,
    pub feed: Option<f64>,
}

/// A rounded corner.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Rounded {
    /// The blocks of the line before, of the corner, and of the line behind.
    pub blocks: [Block; 3],
    pub corner: Corner,
    /// As programmed.
    pub radius: f64,
    /// F of the block itself, and the feed that is in force again behind it.
    pub feed: Option<f64>,
    pub feed_behind: Option<f64>,
    /// Where the line behind is programmed to end, mm.
    pub to: Vector2<f64>,
    pub unit_mm: f64,
}

/// A corner that is not followed: where, why.
pub(crate) type Unrounded = (Range<usize>, String);
