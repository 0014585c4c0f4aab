//! Explanation of an infeasible choice of turns: place, reasons and remedies.

use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::PI;

use crate::free_turn::constant::constant_parts;
use crate::free_turn::error::{NoWay, TurnBarrier, TurnPart};
use crate::free_turn::nodes::{Node, Refused};
use crate::free_turn::search::{Found, Problem};
use crate::free_turn::shortest::{Barrier, Progress, joint_turns};
use crate::free_turn::task::{TurnBand, TurnTask};
use crate::free_turn::way::Gap;

/// Maximum number of parts in a suggested division of a program.
const MOST_PARTS: usize = 1000;

/// Barrier of a way, before it is put into words.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum End {
    Refused(Refused),
    Flip,
    Rate,
    JointStep(usize),
}

/// Barriers before a station that no sequence reaches, and remedies.
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

/// Postures reached at the station before, and turns that the rate lets follow.
struct Before<'n> {
    nodes: Vec<&'n Node>,
    /// Configuration and turn.
    next: BTreeSet<(u8, u32)>,
}

impl<'n> Before<'n> {
    fn of(problem: &'n Problem<'_, '_>, station: usize, progress: &Progress) -> Option<Self> {
        let before = station.checked_sub(1)?;
        let gap = problem.stations[station].gap?;
        let values = &progress.stages.get(before)?.values;
        let nodes = problem.nodes[before].iter().zip(values);
        let nodes = nodes.filter(|(_, value)| value.is_finite());
        let nodes: Vec<&Node> = nodes.map(|(node, _)| node).collect();
        let reached: BTreeSet<(u8, u32)> =
            nodes.iter().map(|n| (n.configuration, n.turn)).collect();
        let mut next = BTreeSet::new();
        for turn in 0..problem.turns.count as u32 {
            for (configuration, from) in &reached {
                let turned = problem.turns.steps(*from, turn).abs() as f64 * problem.turns.step_deg;
                if !gap.known || turned <= gap.turn_deg * (1.0 + 1e-9) {
                    next.insert((*configuration, turn));
                }
            }
        }
        Some(Self { nodes, next })
    }
}

/// Everything that ends at a station, the most frequent first.
fn barriers(
    problem: &Problem<'_, '_>,
    station: usize,
    progress: &Progress,
) -> Vec<(TurnBarrier, f64)> {
    let mut ends: BTreeMap<End, usize> = BTreeMap::new();
    let before = Before::of(problem, station, progress);
    let only = problem.task.bounds.configuration;
    for turn in 0..problem.turns.count as u32 {
        let pose = &problem.stations[station].place.pose;
        let pose = problem.way.turned(pose, problem.turns.deg(turn));
        let ways = problem.postures.refusals(&pose);
        for number in 0..8 {
            let counts = match &before {
                None => only.is_none_or(|only| only == number),
                Some(before) => before.next.contains(&(number, turn)),
            };
            let own = ways.iter().find(|way| way.0 == Some(number));
            let unknown = (None, Err(Refused::Singular));
            let why = match own.map(|way| way.1) {
                Some(Ok(())) => continue,
                Some(Err(why)) => why,
                None if ways.contains(&unknown) => Refused::Singular,
                None => Refused::OutOfReach,
            };
            if counts {
                *ends.entry(End::Refused(why)).or_default() += 1;
            }
        }
    }
    let links = before.map_or_else(Vec::new, |before| between(problem, station, &before));
    for end in links {
        *ends.entry(end).or_default() += 1;
    }
    in_words(problem, ends)
}

/// Barriers with their shares, the most frequent first.
fn in_words(problem: &Problem<'_, '_>, ends: BTreeMap<End, usize>) -> Vec<(TurnBarrier, f64)> {
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
                End::Flip => TurnBarrier::Flip,
                End::Rate => TurnBarrier::Rate,
                End::JointStep(joint) => TurnBarrier::JointStep { joint: name(joint) },
            };
            (barrier, count as f64 / all as f64)
        })
        .collect()
}

/// Reasons for which the postures of the station are not reached from those before.
fn between(problem: &Problem<'_, '_>, station: usize, before: &Before<'_>) -> Vec<End> {
    let Some(gap) = problem.stations[station].gap else {
        return Vec::new();
    };
    let links = &problem.links;
    let ends = problem.nodes[station].iter().filter_map(|node| {
        if !before.next.contains(&(node.configuration, node.turn)) {
            let anywhere = Gap {
                turn_deg: f64::INFINITY,
                ..gap
            };
            let faster = before.nodes.iter();
            let faster = faster.map(|other| links.cost(&anywhere, other, node));
            let flips = before.next.iter().any(|next| next.1 == node.turn);
            return match (faster.into_iter().any(|cost| cost.is_ok()), flips) {
                (true, _) => Some(End::Rate),
                (false, true) => Some(End::Flip),
                (false, false) => None,
            };
        }
        // The posture before from which the joints have least to turn.
        let nearest = before
            .nodes
            .iter()
            .filter_map(|other| match links.cost(&gap, other, node) {
                Ok(_) => Some((0.0, 0)),
                Err(Barrier::JointStep(_)) => {
                    let turns = joint_turns(&links.free, &other.joints, &node.joints);
                    let turns = turns.iter().map(|turn| turn.abs()).enumerate();
                    let farthest = turns.max_by(|a, b| a.1.total_cmp(&b.1));
                    farthest.map(|(joint, turn)| (turn, joint))
                }
                Err(Barrier::Configuration | Barrier::Rate) => None,
            });
        let (turn, joint) = nearest.min_by(|a, b| a.0.total_cmp(&b.0))?;
        Some(match turn {
            // A link that does not hold between the stations.
            0.0 => End::Refused(Refused::Singular),
            // Only a whole turn back: the joint has come to its limit.
            turn if turn > PI => End::Refused(Refused::Limit(joint)),
            _ => End::JointStep(joint),
        })
    });
    ends.collect()
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
    let turns = problem.turns_deg(&found.chosen);
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
