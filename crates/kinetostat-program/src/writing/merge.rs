//! Fewer pieces from a division: halving leaves a trail of ever shorter pieces beside a jump, and up
//! to twice the pieces needed elsewhere; a field with many breaks is first divided at all of them.

use nalgebra::Vector6;

use crate::writing::departure::{Values, departure};
use crate::writing::directed_moves::DirectedMove;
use crate::writing::node::{Node, taken_up};
use crate::writing::options::WriteOptions;

/// A stretch that was accepted, by the share at which it begins, and the correction on it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Accepted {
    pub move_index: usize,
    pub share: f64,
    pub values: Values,
}

/// Joins neighbouring pieces as long as the bound that they were accepted by holds for the joined
/// piece.
///
/// Both lists are sorted by move and share; moves without accepted stretches keep their nodes.
pub(crate) fn merge(
    nodes: Vec<Node>,
    accepted: &[Accepted],
    directed: &[Option<DirectedMove<'_>>],
    options: &WriteOptions,
) -> Vec<Node> {
    if accepted.is_empty() {
        return nodes;
    }
    let mut merged = Vec::with_capacity(nodes.len());
    let mut rest = accepted;
    for group in nodes.chunk_by(|a, b| a.move_index == b.move_index) {
        let move_index = group[0].move_index;
        let own = rest.partition_point(|stretch| stretch.move_index <= move_index);
        let first = rest[..own].partition_point(|stretch| stretch.move_index < move_index);
        let own_stretches = &rest[first..own];
        let directed = directed[move_index].as_ref();
        merge_move(group, own_stretches, directed, options, &mut merged);
        rest = &rest[own..];
    }
    merged
}

fn merge_move(
    group: &[Node],
    accepted: &[Accepted],
    directed: Option<&DirectedMove<'_>>,
    options: &WriteOptions,
    merged: &mut Vec<Node>,
) {
    if accepted.is_empty() {
        merged.extend_from_slice(group);
        return;
    }
    let begins = |from: usize| match from {
        0 => taken_up(Some(group[0].before), group[0].after, options),
        _ => group[from].after,
    };
    // Nothing that the tool must pass exactly lies between.
    let open = |index: usize| !group[index].fixed && group[index].before == group[index].after;
    let fits = |from: usize, to: usize| {
        let (a, b) = (&group[from], &group[to]);
        let chord = |share: f64| -> Vector6<f64> {
            begins(from).lerp(&b.before, (share - a.share) / (b.share - a.share))
        };
        let first = accepted.partition_point(|stretch| stretch.share < a.share);
        let goes_on = directed.is_none_or(|own| own.goes_on(a.share, b.share));
        goes_on
            && (from..to).all(|index| {
                let [here, next] = [group[index].share, group[index + 1].share];
                accepted
                    .get(first + index - from)
                    .filter(|stretch| stretch.share == here)
                    .is_some_and(|stretch| {
                        departure(&stretch.values, [chord(here), chord(next)])
                            <= options.tolerance_mm
                    })
            })
    };
    let last = group.len() - 1;
    let (mut at, mut barrier) = (0, 0);
    merged.push(group[0]);
    while at < last {
        if at >= barrier {
            barrier = (at + 1..last).find(|index| !open(*index)).unwrap_or(last);
        }
        // Extends the piece in strides that double, then halve.
        let mut next = at + 1;
        let mut stride = 1;
        while next + stride <= barrier && fits(at, next + stride) {
            next += stride;
            stride *= 2;
        }
        while stride > 0 {
            if next + stride <= barrier && fits(at, next + stride) {
                next += stride;
            }
            stride /= 2;
        }
        merged.push(group[next]);
        at = next;
    }
}
