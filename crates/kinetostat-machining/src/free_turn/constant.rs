//! Turns that stay the same: how far each of them goes, and what it costs.

use rayon::prelude::*;

use crate::free_turn::choice::ConstantTurn;
use crate::free_turn::error::TurnPart;
use crate::free_turn::nodes::Node;
use crate::free_turn::search::Problem;

/// Constant turn from a station to another, in one configuration.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Run {
    first: usize,
    last: usize,
    cost: f64,
    singular_value: f64,
    configuration: u8,
}

/// The cheapest way to a posture, and the smallest singular value on it.
struct Reached<'n> {
    node: &'n Node,
    cost: f64,
    singular_value: f64,
}

/// Postures with a turn, of those of a station, which are in order by configuration and turn.
fn with_turn(nodes: &[Node], turn: u32) -> impl Iterator<Item = &Node> {
    (0..8).flat_map(move |configuration| {
        let own = (configuration, turn);
        let first = nodes.partition_point(|node| (node.configuration, node.turn) < own);
        let rest = nodes[first..].iter();
        rest.take_while(move |node| (node.configuration, node.turn) == own)
    })
}

/// Runs of stations along which a turn is possible, checked at the stations alone.
fn runs(problem: &Problem<'_, '_>, turn: u32) -> Vec<Run> {
    let mut runs: Vec<Run> = Vec::new();
    let mut reached: Vec<Reached<'_>> = Vec::new();
    for (index, nodes) in problem.nodes.iter().enumerate() {
        let station = &problem.stations[index];
        let own = || with_turn(nodes, turn);
        let at = |node: &Node| station.share * node.cost;
        let mut next: Vec<Reached<'_>> = Vec::new();
        if let Some(gap) = station.gap {
            for node in own() {
                let from = reached.iter().filter_map(|before| {
                    let link = problem.links.cost(&gap, before.node, node).ok()?;
                    Some((before.cost + link, before.singular_value))
                });
                if let Some((cost, least)) = from.min_by(|a, b| a.0.total_cmp(&b.0)) {
                    next.push(Reached {
                        node,
                        cost: cost + at(node),
                        singular_value: least.min(node.singular_value),
                    });
                }
            }
        }
        if next.is_empty() {
            next = own()
                .map(|node| Reached {
                    node,
                    cost: at(node),
                    singular_value: node.singular_value,
                })
                .collect();
            if let Some(best) = cheapest(&next) {
                runs.push(Run {
                    first: index,
                    ..of(best, index)
                });
            }
        } else if let (Some(run), Some(best)) = (runs.last_mut(), cheapest(&next)) {
            *run = Run {
                first: run.first,
                ..of(best, index)
            };
        }
        reached = next;
    }
    runs
}

fn of(reached: &Reached<'_>, last: usize) -> Run {
    Run {
        first: last,
        last,
        cost: reached.cost,
        singular_value: reached.singular_value,
        configuration: reached.node.configuration,
    }
}

fn cheapest<'r, 'n>(reached: &'r [Reached<'n>]) -> Option<&'r Reached<'n>> {
    reached.iter().min_by(|a, b| a.cost.total_cmp(&b.cost))
}

/// Distance from the start along which a constant turn is possible.
pub(crate) fn constant_turn(problem: &Problem<'_, '_>, turn: u32) -> ConstantTurn {
    let last = problem.stations.len() - 1;
    let run = runs(problem, turn).first().copied();
    let run = run.filter(|run| run.first == 0);
    let whole = run.filter(|run| run.last == last);
    let covered = run.map_or(0.0, |run| problem.stations[run.last].at);
    ConstantTurn {
        turn_deg: problem.turns.deg(turn),
        cost: whole.map(|run| run.cost),
        share_of_way: covered / problem.stations[last].at,
        smallest_singular_value: run.map_or(0.0, |run| run.singular_value),
        ends_on_line: match whole {
            Some(_) => None,
            None => Some(
                problem.stations[run.map_or(0, |run| run.last + 1)]
                    .place
                    .line,
            ),
        },
    }
}

/// The turn that is nearest to none, and the best one.
pub(crate) fn constant_turns(problem: &Problem<'_, '_>) -> [Option<ConstantTurn>; 2] {
    let turns = (0..problem.turns.count as u32).into_par_iter();
    let all: Vec<ConstantTurn> = turns.map(|turn| constant_turn(problem, turn)).collect();
    let from_none = |turn: &ConstantTurn| turn.turn_deg.abs();
    let as_programmed = all
        .iter()
        .min_by(|a, b| from_none(a).total_cmp(&from_none(b)))
        .filter(|turn| from_none(turn) <= 0.5 * problem.turns.step_deg + 1e-9);
    let best = all.iter().min_by(|a, b| {
        let cost = |turn: &ConstantTurn| turn.cost.unwrap_or(f64::INFINITY);
        cost(a)
            .total_cmp(&cost(b))
            .then(b.share_of_way.total_cmp(&a.share_of_way))
    });
    [as_programmed.copied(), best.copied()]
}

/// Longest part that each turn covers; the longest one first.
pub(crate) fn constant_parts(problem: &Problem<'_, '_>) -> Vec<TurnPart> {
    let stations = &problem.stations;
    let mut parts: Vec<TurnPart> = (0..problem.turns.count as u32)
        .into_par_iter()
        .filter_map(|turn| {
            let length = |run: &Run| stations[run.last].at - stations[run.first].at;
            let runs = runs(problem, turn).into_iter();
            let run = runs.max_by(|a, b| length(a).total_cmp(&length(b)))?;
            Some(TurnPart {
                from_line: stations[run.first].place.line,
                to_line: stations[run.last].place.line,
                from_mm: stations[run.first].at,
                to_mm: stations[run.last].at,
                turn_deg: problem.turns.deg(turn),
                configuration: run.configuration,
            })
        })
        .collect();
    parts.sort_by(|a, b| (b.to_mm - b.from_mm).total_cmp(&(a.to_mm - a.from_mm)));
    parts
}
