//! Fewer pieces from a division: bisection leaves a trail of ever shorter pieces beside a jump, and up
//! to twice the pieces needed elsewhere.

use nalgebra::Vector3;

use crate::divide::Node;

/// A correction that was asked for inside an accepted piece of a straight move.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Sample {
    pub move_index: usize,
    pub share: f64,
    pub value: Vector3<f64>,
}

/// Joins neighbouring pieces of straight moves as long as every correction that was ever asked for
/// within them lies within the tolerance of the joined piece.
///
/// Both lists are sorted by move and share; moves without samples keep their nodes.
pub(crate) fn merge(nodes: Vec<Node>, samples: &[Sample], tolerance_mm: f64) -> Vec<Node> {
    if samples.is_empty() {
        return nodes;
    }
    let mut merged = Vec::with_capacity(nodes.len());
    let mut rest = samples;
    for group in nodes.chunk_by(|a, b| a.move_index == b.move_index) {
        let move_index = group[0].move_index;
        let own = rest.partition_point(|sample| sample.move_index <= move_index);
        let first = rest[..own].partition_point(|sample| sample.move_index < move_index);
        merge_move(group, &rest[first..own], tolerance_mm, &mut merged);
        rest = &rest[own..];
    }
    merged
}

fn merge_move(group: &[Node], samples: &[Sample], tolerance_mm: f64, merged: &mut Vec<Node>) {
    if samples.is_empty() {
        merged.extend_from_slice(group);
        return;
    }
    let fits = |from: usize, to: usize| {
        let (a, b) = (&group[from], &group[to]);
        let near = |share: f64, value: &Vector3<f64>| {
            let part = (share - a.share) / (b.share - a.share);
            (value - a.after.lerp(&b.before, part)).norm() <= tolerance_mm
        };
        let begin = samples.partition_point(|sample| sample.share <= a.share);
        let end = samples.partition_point(|sample| sample.share < b.share);
        group[from + 1..to]
            .iter()
            .all(|node| near(node.share, &node.before))
            && samples[begin..end]
                .iter()
                .all(|sample| near(sample.share, &sample.value))
    };
    let last = group.len() - 1;
    let mut at = 0;
    merged.push(group[0]);
    while at < last {
        let mut next = at + 1;
        while next < last && group[next].before == group[next].after && fits(at, next + 1) {
            next += 1;
        }
        merged.push(group[next]);
        at = next;
    }
}
