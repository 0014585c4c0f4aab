//! Ends of pieces, with the corrections that hold before and after them, and the steps of the tool where the correction jumps.

use nalgebra::Vector6;
use serde::Serialize;

use crate::error::WriteError;
use crate::field::{Request, Turning};
use crate::path::moves::{Knowledge, Move, MoveKind, Path};
use crate::writing::options::WriteOptions;
use crate::writing::queries::FieldQueries;

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

/// The stretch of a turn that a corner step covers.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Turn {
    /// Move whose load holds before.
    pub from_move: usize,
    /// Share of that move.
    pub from_share: f64,
    /// Share of the step's own move at which its load is taken.
    pub to_share: f64,
    /// Part of the turn that is done before the step, 0 to 1.
    pub part_from: f64,
    /// Part of the turn that is done after the step, 0 to 1.
    pub part_to: f64,
}

impl Turn {
    /// True if the step is at the end of a rapid: the load is there at once, where others are at corners or inside a
    /// cut.
    ///
    /// ```
    /// use kinetostat_program::*;
    ///
    /// let program = Program::read("G21 G90\nG0 X0 Y0 Z0\nG1 X10 F600\nG1 Y10\n")?;
    /// let path = interpret(&program, &ReadOptions::default())?;
    /// let after = |from_move| Turn { from_move, from_share: 1.0, to_share: 0.0, part_from: 0.0, part_to: 1.0 };
    /// assert!(after(0).is_entry(&path) && !after(1).is_entry(&path));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn is_entry(&self, path: &Path) -> bool {
        let before = path.moves.get(self.from_move);
        before.is_some_and(|before| before.kind == MoveKind::Rapid)
    }
}

/// A jump of the correction and the corrections inside it.
#[derive(Debug, Clone)]
pub(crate) struct Jump {
    pub from_move: usize,
    pub from_share: f64,
    pub to_share: f64,
    /// Part of the turn and correction, in order, without the ends.
    pub inner: Vec<(f64, Vector6<f64>)>,
}

impl Jump {
    pub fn between(&self, part_from: f64, part_to: f64) -> Turn {
        Turn {
            from_move: self.from_move,
            from_share: self.from_share,
            to_share: self.to_share,
            part_from,
            part_to,
        }
    }
}

/// Halvings of one step at most: a thousandth of any jump is far below the tolerance.
const DEPTH: u32 = 10;

/// Place at which a step is evaluated besides its middle: a load that reverses has corrections that mirror each other
/// about the middle, which then shows nothing.
const BESIDE: f64 = 0.211_3;

struct Stretch {
    jump: usize,
    node: usize,
    part: [f64; 2],
    ends: [Vector6<f64>; 2],
    depth: u32,
}

/// Finds all jumps of the nodes, marks them there, and evaluates the corrections inside.
///
/// The load is taken to go evenly from the one before to the one after while the tool steps from one corrected place to the other.
/// Between the two the correction is no straight line, so a long step is divided like a block is: until straight pieces are within
/// the tolerance.
pub(crate) fn follow_turns(
    queries: &mut FieldQueries<'_>,
    nodes: &mut [Node],
    options: &WriteOptions,
) -> Result<Vec<Jump>, WriteError> {
    let mut jumps = Vec::new();
    let mut open = Vec::new();
    for index in 0..nodes.len() {
        let node = nodes[index];
        if !is_divided(&queries.path.moves[node.move_index]) {
            continue;
        }
        let begins = index == 0 || nodes[index - 1].move_index != node.move_index;
        let (from_move, from_share, to_share, before) = if begins {
            let Some(last) = index.checked_sub(1).map(|i| nodes[i]) else {
                continue;
            };
            let between = &queries.path.moves[last.move_index + 1..node.move_index];
            if between
                .iter()
                .any(|motion| motion.known == Knowledge::Nothing)
            {
                // The load before a cut is not known after a move without a correction.
                continue;
            }
            (last.move_index, last.share, node.share, last.after)
        } else {
            let [from, to] = node.bracket;
            (node.move_index, from, to, node.before)
        };
        if (node.after - before).norm() <= options.smallest_step_mm() {
            continue;
        }
        nodes[index].jump = Some(jumps.len());
        open.push(Stretch {
            jump: jumps.len(),
            node: index,
            part: [0.0, 1.0],
            ends: [before, node.after],
            depth: 0,
        });
        jumps.push(Jump {
            from_move,
            from_share,
            to_share,
            inner: Vec::new(),
        });
    }
    if !queries.field.turns() {
        return Ok(jumps);
    }
    while !open.is_empty() {
        let mut requests: Vec<Request> = Vec::new();
        for stretch in &open {
            let (node, jump) = (nodes[stretch.node], &jumps[stretch.jump]);
            for place in [0.5, BESIDE] {
                requests.push(Request {
                    turning: Some(Turning {
                        from_move: jump.from_move,
                        from_share: jump.from_share,
                        to_share: jump.to_share,
                        part: stretch.part[0] + place * (stretch.part[1] - stretch.part[0]),
                    }),
                    ..queries.request(node.move_index, node.share)
                });
            }
        }
        let answers = queries.evaluate(&requests)?;
        let mut next = Vec::new();
        for (stretch, answers) in open.into_iter().zip(answers.chunks_exact(2)) {
            let (middle, beside) = (answers[0], answers[1]);
            let [from, to] = stretch.part;
            let [first, last] = stretch.ends;
            let off = |value: Vector6<f64>, place| (value - first.lerp(&last, place)).norm();
            if off(middle, 0.5).max(off(beside, BESIDE)) <= options.tolerance_mm
                || stretch.depth == DEPTH
            {
                continue;
            }
            let part = 0.5 * (from + to);
            jumps[stretch.jump].inner.push((part, middle));
            for (part, ends) in [
                ([from, part], [first, middle]),
                ([part, to], [middle, last]),
            ] {
                next.push(Stretch {
                    part,
                    ends,
                    depth: stretch.depth + 1,
                    ..stretch
                });
            }
        }
        open = next;
    }
    for jump in &mut jumps {
        jump.inner.sort_by(|a, b| a.0.total_cmp(&b.0));
    }
    Ok(jumps)
}
