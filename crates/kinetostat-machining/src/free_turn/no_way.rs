//! Where all sequences of turns end, why, and what helps.

use std::collections::{BTreeMap, BTreeSet};

use crate::free_turn::constant::constant_parts;
use crate::free_turn::error::{NoWay, TurnBarrier, TurnPart};
use crate::free_turn::nodes::Refused;
use crate::free_turn::search::{Found, Problem};
use crate::free_turn::shortest::{Barrier, Progress};
use crate::free_turn::task::{TurnBand, TurnTask};

/// Most parts into which a program is said to be divided.
const MOST_PARTS: usize = 1000;

/// What ends a way, before it has words.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum End {
    Refused(Refused),
    Between(Barrier),
}

/// What stands in the way to a station that no sequence reaches, and what helps.
pub(crate) fn no_way(problem: &Problem<'_, '_>, station: usize, progress: &Progress) -> NoWay {
    let place = &problem.stations[station].place;
    NoWay {
        line: place.line,
        position_mm: place.position_mm.into(),
        way_mm: problem.stations[station].at,
        barriers: barriers(problem, station, progress),
        wider_band_deg: wider_band(problem.task),
        other_configuration: other_configuration(problem.task),
        parts: parts(problem),
        constant: constant_parts(problem),
    }
}

/// Everything that ends at a station, the most frequent first.
fn barriers(
    problem: &Problem<'_, '_>,
    station: usize,
    progress: &Progress,
) -> Vec<(TurnBarrier, f64)> {
    let mut ends: BTreeMap<End, usize> = BTreeMap::new();
    // Configurations in which the station before is reached.
    let before = station.checked_sub(1);
    let alive: BTreeSet<u8> = before.map_or_else(BTreeSet::new, |before| {
        let values = progress.stages.get(before).map(|stage| &stage.values);
        let nodes = problem.nodes[before]
            .iter()
            .zip(values.into_iter().flatten());
        let reached = nodes.filter(|(_, value)| value.is_finite());
        reached.map(|(node, _)| node.configuration).collect()
    });
    let counts = |number: u8| match before {
        None => problem
            .task
            .bounds
            .configuration
            .is_none_or(|only| only == number),
        Some(_) => alive.contains(&number),
    };
    for turn in 0..problem.turns.count as u32 {
        let pose = &problem.stations[station].place.pose;
        let pose = problem.way.turned(pose, problem.turns.deg(turn));
        for (number, found) in problem.postures.refusals(&pose) {
            match (found, number) {
                (Err(why), Some(number)) if counts(number) => {
                    *ends.entry(End::Refused(why)).or_default() += 1;
                }
                (Err(why), None) => *ends.entry(End::Refused(why)).or_default() += 1,
                _ => {}
            }
        }
    }
    for end in between(problem, station, progress, &alive) {
        *ends.entry(end).or_default() += 1;
    }
    let all: usize = ends.values().sum();
    let mut listed: Vec<(End, usize)> = ends.into_iter().collect();
    listed.sort_by(|a, b| b.1.cmp(&a.1).then(a.0.cmp(&b.0)));
    let names = problem.task.mechanism.actuator_names();
    let name = |joint: usize| names.get(joint).cloned().unwrap_or_default();
    listed
        .into_iter()
        .map(|(end, count)| {
            let barrier = match end {
                End::Refused(Refused::OutOfReach) => TurnBarrier::OutOfReach,
                End::Refused(Refused::Limit(joint)) => TurnBarrier::Limit { joint: name(joint) },
                End::Refused(Refused::Singular) => TurnBarrier::Singular,
                End::Between(Barrier::Configuration) => TurnBarrier::Flip,
                End::Between(Barrier::Rate) => TurnBarrier::Rate,
                End::Between(Barrier::JointStep(joint)) => {
                    TurnBarrier::JointStep { joint: name(joint) }
                }
            };
            (barrier, count as f64 / all as f64)
        })
        .collect()
}

/// Why the postures that the station has are not reached from those before.
fn between(
    problem: &Problem<'_, '_>,
    station: usize,
    progress: &Progress,
    alive: &BTreeSet<u8>,
) -> Vec<End> {
    let Some(before) = station.checked_sub(1) else {
        return Vec::new();
    };
    let (Some(gap), Some(stage)) = (problem.stations[station].gap, progress.stages.get(before))
    else {
        return Vec::new();
    };
    let from = problem.nodes[before].iter().zip(&stage.values);
    let from: Vec<_> = from
        .filter(|(_, value)| value.is_finite())
        .map(|(node, _)| node)
        .collect();
    let nodes = problem.nodes[station].iter();
    nodes
        .filter_map(|node| {
            if !alive.contains(&node.configuration) {
                return Some(End::Between(Barrier::Configuration));
            }
            // What is least in the way: a link that was broken between its stations, a joint, the rate.
            let links = from
                .iter()
                .map(|other| problem.links.cost(&gap, other, node));
            let mut least: Option<Barrier> = None;
            for link in links {
                match link {
                    Ok(_) => return Some(End::Refused(Refused::Singular)),
                    Err(barrier) => least = least.max(Some(barrier)),
                }
            }
            least.map(End::Between)
        })
        .collect()
}

/// Turns from and to, deg, of a way that is found on the whole circle.
fn wider_band(task: &TurnTask<'_>) -> Option<[f64; 2]> {
    if task.band.to_deg - task.band.from_deg > 360.0 - 1e-9 {
        return None;
    }
    let mut wider = task.clone();
    wider.band = TurnBand {
        from_deg: -180.0,
        to_deg: 180.0,
        step_deg: task.band.step_deg,
    };
    let mut problem = Problem::of(&wider).ok()?;
    let found = problem.search().ok()?;
    let turns = turns_deg(&problem, &found.chosen);
    let low = turns
        .iter()
        .copied()
        .fold(f64::INFINITY, crate::number::smaller);
    let high = turns
        .iter()
        .copied()
        .fold(f64::NEG_INFINITY, crate::number::larger);
    // A band of one turn is none.
    Some([low - problem.turns.step_deg, high + problem.turns.step_deg])
}

/// A configuration in which there is a way, where the task asks for another one.
fn other_configuration(task: &TurnTask<'_>) -> Option<u8> {
    task.bounds.configuration?;
    let mut any = task.clone();
    any.bounds.configuration = None;
    let mut problem = Problem::of(&any).ok()?;
    let Found { chosen, .. } = problem.search().ok()?;
    Some(problem.node(0, *chosen.first()?).configuration)
}

/// Turns along a sequence, deg, without jumps of 360.
pub(crate) fn turns_deg(problem: &Problem<'_, '_>, chosen: &[u32]) -> Vec<f64> {
    let mut turn = None;
    let mut last = 0;
    chosen
        .iter()
        .enumerate()
        .map(|(station, number)| {
            let own = problem.node(station, *number).turn;
            let steps = problem.turns.steps(last, own) as f64;
            let now = match turn {
                None => problem.turns.deg(own),
                Some(before) => before + steps * problem.turns.step_deg,
            };
            (turn, last) = (Some(now), own);
            now
        })
        .collect()
}

/// Parts into which the program can be divided, each as long as can be.
fn parts(problem: &Problem<'_, '_>) -> Vec<TurnPart> {
    let stations = &problem.stations;
    let mut parts = Vec::new();
    let mut first = 0;
    while first + 1 < stations.len() && parts.len() < MOST_PARTS {
        let mut progress = Progress::default();
        let end = match progress.go_on(&problem.links, stations, &problem.nodes, first) {
            Ok(()) => stations.len() - 1,
            Err(station) => station.saturating_sub(1),
        };
        let start = progress
            .best()
            .and_then(|(_, chosen)| chosen.first().copied());
        let (Some(start), true) = (start, end > first) else {
            return Vec::new();
        };
        let node = problem.node(first, start);
        parts.push(TurnPart {
            from_line: stations[first].place.line,
            to_line: stations[end].place.line,
            from_mm: stations[first].at,
            to_mm: stations[end].at,
            turn_deg: problem.turns.deg(node.turn),
            configuration: node.configuration,
        });
        first = end;
    }
    parts
}
