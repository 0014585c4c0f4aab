//! Ends of pieces, with the corrections that hold before and after them.

use nalgebra::Vector6;

use crate::path::moves::{Knowledge, Move, MoveKind};
use crate::writing::options::WriteOptions;

/// A point of a move between two pieces (or at its ends), with the correction that holds before it
/// and the one that holds after it; they differ where the correction jumps inside the move.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Node {
    pub move_index: usize,
    pub share: f64,
    /// Corrections as lengths, in mm: of the position, and of the orientation at [`WriteOptions::turn_lever_mm`].
    pub before: Vector6<f64>,
    pub after: Vector6<f64>,
    /// Shares between which the correction jumps, where it jumps inside the move.
    pub bracket: [f64; 2],
    /// Index of the jump at this node, see [`crate::writing::dividing::divide::Division::jumps`].
    pub jump: Option<usize>,
    /// The end of an arc's chord: pieces on its two sides are never joined.
    pub fixed: bool,
}

impl Node {
    pub(crate) fn smooth(move_index: usize, share: f64, value: Vector6<f64>) -> Self {
        Self {
            move_index,
            share,
            before: value,
            after: value,
            bracket: [share; 2],
            jump: None,
            fixed: false,
        }
    }
}

/// True if a move is divided: feed moves from a known start with a length, or with a rotation of the tool.
pub(crate) fn is_divided(motion: &Move) -> bool {
    motion.is_known_feed() && (motion.has_length() || motion.turns_in_place())
}

/// True if only the end of a move is corrected: rapids, and moves from an unknown place.
pub(crate) fn is_corrected_at_end(motion: &Move) -> bool {
    let at_once = motion.kind == MoveKind::Rapid;
    motion.known == Knowledge::End || motion.known == Knowledge::Whole && at_once
}

/// Start of the first piece of a move: its own first correction, or the last one before it if the jump between them
/// is too small for a step and small enough to be part of the tolerance.
pub(crate) fn taken_up(
    before: Option<Vector6<f64>>,
    first: Vector6<f64>,
    options: &WriteOptions,
) -> Vector6<f64> {
    let smallest = options.smallest_step_mm().min(options.tolerance_mm);
    before
        .filter(|before| (before - first).norm() <= smallest)
        .unwrap_or(first)
}
