//! Motion of the tool where the correction jumps: at a corner the load turns, a cut begins.
//!
//! The load is taken to go evenly from the one before to the one after while the tool steps from one
//! corrected place to the other. Between the two the correction is no straight line, so a long step is
//! divided like a block is: until straight pieces are within the tolerance.

use nalgebra::Vector6;

use crate::error::WriteError;
use crate::field::request::{Request, Turning};
use crate::path::moves::Knowledge;
use crate::writing::jump::Jump;
use crate::writing::node::{Node, is_divided};
use crate::writing::options::WriteOptions;
use crate::writing::queries::FieldQueries;

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
