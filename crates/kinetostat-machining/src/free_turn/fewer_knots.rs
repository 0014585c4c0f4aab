//! A smooth curve with fewer knots: where its turns lie on a line but for a hundredth of a degree they are put on it, so that a program
//! needs no more places than its turn does (Douglas and Peucker 1973). The changed curve stays within the same bounds.

use rayon::prelude::*;

use crate::free_turn::between::{Looked, Stand};
use crate::free_turn::curve::Curve;
use crate::free_turn::nodes::Node;
use crate::free_turn::search::Problem;

/// A turn is moved by no more, deg.
const MOST_DEG: f64 = 0.01;

/// Turns, postures and what is seen before each, behind the first station of a part up to its last one.
struct Part {
    first: usize,
    turns: Vec<f64>,
    nodes: Vec<Node>,
    seen: Vec<Vec<Looked>>,
}

/// The curve with the turns between its knots on lines.
pub(crate) fn fewer_knots(problem: &Problem<'_, '_>, mut curve: Curve) -> Curve {
    let knots = knots(problem, &curve);
    let parts: Vec<Part> = knots
        .par_windows(2)
        .filter_map(|ends| part(problem, &curve, [ends[0], ends[1]]))
        .collect();
    for part in parts {
        let inner = part.first + 1..part.first + 1 + part.turns.len();
        curve.turns[inner.clone()].copy_from_slice(&part.turns);
        curve.nodes[inner].copy_from_slice(&part.nodes);
        for (index, seen) in part.seen.into_iter().enumerate() {
            curve.seen[part.first + 1 + index] = seen;
        }
    }
    curve
}

/// The turn on the line between two stations, deg.
fn on_line(problem: &Problem<'_, '_>, curve: &Curve, [first, last]: [usize; 2], at: usize) -> f64 {
    let way = |station: usize| problem.stations[station].at;
    let share = (way(at) - way(first)) / (way(last) - way(first));
    curve.turns[first] + share * (curve.turns[last] - curve.turns[first])
}

/// Stations at which the curve bends, the first and the last of every stretch among them; ascending.
fn knots(problem: &Problem<'_, '_>, curve: &Curve) -> Vec<usize> {
    let count = curve.turns.len();
    let begins = |station: usize| problem.stations[station].gap.is_none_or(|gap| !gap.known);
    let mut is_knot: Vec<bool> = (0..count)
        .map(|station| station + 1 == count || begins(station) || begins(station + 1))
        .collect();
    let fixed: Vec<usize> = (0..count).filter(|station| is_knot[*station]).collect();
    let mut open: Vec<[usize; 2]> = fixed.windows(2).map(|ends| [ends[0], ends[1]]).collect();
    while let Some([first, last]) = open.pop() {
        if begins(last) {
            continue;
        }
        let off = |at: usize| (curve.turns[at] - on_line(problem, curve, [first, last], at)).abs();
        let inner = (first + 1..last).map(|at| (off(at), at));
        let Some((farthest, at)) = inner.max_by(|a, b| a.0.total_cmp(&b.0)) else {
            continue;
        };
        if farthest > MOST_DEG {
            is_knot[at] = true;
            open.extend([[first, at], [at, last]]);
        }
    }
    (0..count).filter(|station| is_knot[*station]).collect()
}

/// Part of the curve between two knots, on a line; `None` if it is there already, or may not be.
fn part(problem: &Problem<'_, '_>, curve: &Curve, ends: [usize; 2]) -> Option<Part> {
    let [first, last] = ends;
    let turns: Vec<f64> = (first + 1..last)
        .map(|at| on_line(problem, curve, ends, at))
        .collect();
    if turns.is_empty() || turns == curve.turns[first + 1..last] {
        return None;
    }
    let placed = turns.iter().enumerate().map(|(index, turn)| {
        let station = first + 1 + index;
        let pose = &problem.stations[station].place.pose;
        let pose = problem.way.turned(pose, *turn);
        problem.postures.next_to(&curve.nodes[station], &pose)
    });
    let nodes: Vec<Node> = placed.collect::<Option<_>>()?;
    let stand = |station: usize| match station == first || station == last {
        true => curve.stand(problem, station),
        false => Stand {
            station: &problem.stations[station],
            turn_deg: turns[station - first - 1],
            node: &nodes[station - first - 1],
        },
    };
    let between = problem.between();
    let mut seen = Vec::with_capacity(last - first);
    for station in first + 1..=last {
        let (start, end) = (stand(station - 1), stand(station));
        let gap = end.station.gap?;
        let turn = end.turn_deg - start.turn_deg;
        let joints = [&start.node.joints, &end.node.joints];
        problem.links.held(&gap, turn, joints).ok()?;
        seen.push(between.look(start, end).ok()?);
    }
    Some(Part {
        first,
        turns,
        nodes,
        seen,
    })
}
