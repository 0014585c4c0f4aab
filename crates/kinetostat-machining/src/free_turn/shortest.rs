//! The cheapest way from station to station through the postures of an arm.

use std::collections::BTreeSet;
use std::f64::consts::TAU;
use std::ops::Range;

use rayon::prelude::*;

use crate::free_turn::nodes::Node;
use crate::free_turn::way::{Gap, Station, Turns};

/// Fewer postures than this are not worth a second thread.
const TOGETHER: usize = 64;

/// A station, a posture at the one before it and a posture at it.
pub(crate) type Link = (usize, u32, u32);

/// Reason for which one posture cannot follow another.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Barrier {
    Configuration,
    Rate,
    JointStep(usize),
}

/// Constraints on two postures that follow one another.
#[derive(Clone, Debug)]
pub(crate) struct Links {
    pub turns: Turns,
    /// Joints that turn on and on.
    pub free: [bool; 6],
    /// Maximum rotation of a joint, rad.
    pub joint_step: f64,
    /// Weight of evenness, by share of the way.
    pub weight: f64,
    /// Length of the way, mm.
    pub length: f64,
    /// Links that were found not to hold between their stations.
    pub broken: BTreeSet<Link>,
}

/// Values of the cheapest way to every posture of a station, and from where it comes.
#[derive(Clone, Debug)]
pub(crate) struct Stage {
    pub values: Vec<f64>,
    from: Vec<u32>,
}

impl Stage {
    fn is_reached(&self) -> bool {
        self.values.iter().any(|value| value.is_finite())
    }
}

/// The turn of every joint from one posture to another, rad.
pub(crate) fn joint_turns(free: &[bool; 6], a: &[f64; 6], b: &[f64; 6]) -> [f64; 6] {
    let mut turns = [0.0; 6];
    for joint in 0..6 {
        let turn = b[joint] - a[joint];
        turns[joint] = match free[joint] {
            true => turn - TAU * (turn / TAU).round(),
            false => turn,
        };
    }
    turns
}

impl Links {
    /// Cost of the step from one posture to another.
    pub fn cost(&self, gap: &Gap, a: &Node, b: &Node) -> Result<f64, Barrier> {
        if a.configuration != b.configuration {
            return Err(Barrier::Configuration);
        }
        if !gap.known {
            return Ok(0.0);
        }
        let turn = self.turns.steps(a.turn, b.turn) as f64 * self.turns.step_deg;
        self.held(gap, turn, [&a.joints, &b.joints])?;
        Ok(self.evenness(gap, turn))
    }

    /// Checks that a turn (deg) and the joints go no faster than allowed.
    pub fn held(&self, gap: &Gap, turn: f64, [a, b]: [&[f64; 6]; 2]) -> Result<(), Barrier> {
        if !gap.known {
            return Ok(());
        }
        if turn.abs() > gap.turn_deg * (1.0 + 1e-9) {
            return Err(Barrier::Rate);
        }
        let turns = joint_turns(&self.free, a, b);
        match turns.iter().position(|turn| turn.abs() > self.joint_step) {
            Some(joint) => Err(Barrier::JointStep(joint)),
            None => Ok(()),
        }
    }

    /// Cost of a turn in deg.
    pub fn evenness(&self, gap: &Gap, turn: f64) -> f64 {
        let rate = match turn == 0.0 || !gap.known {
            true => 0.0,
            false => turn / gap.turn_deg,
        };
        self.weight * rate * rate * gap.length / self.length
    }

    /// Postures of the station before that a posture may come from by configuration and rate; ascending.
    fn candidates(&self, before: &[Node], gap: &Gap, node: &Node) -> [Range<usize>; 2] {
        let count = self.turns.count as i64;
        let steps = gap.turn_deg / self.turns.step_deg * (1.0 + 1e-9);
        let far = match gap.known && steps < count as f64 {
            true => steps as i64,
            false => count,
        };
        let place = |turn: i64| {
            before.partition_point(|other| {
                (other.configuration, i64::from(other.turn)) < (node.configuration, turn)
            })
        };
        let range = |from: i64, to: i64| match from < to {
            true => place(from)..place(to),
            false => 0..0,
        };
        let own = i64::from(node.turn);
        let (low, high) = (own - far, own + far + 1);
        match self.turns.circle {
            _ if high - low >= count => [range(0, count), 0..0],
            false => [range(low.max(0), high.min(count)), 0..0],
            true if low < 0 => [range(0, high), range(low + count, count)],
            true if high > count => [range(0, high - count), range(low, count)],
            true => [range(low, high), 0..0],
        }
    }

    /// Goes on from one station to the next.
    fn step(
        &self,
        station: usize,
        gap: &Gap,
        last: &Stage,
        before: &[Node],
        nodes: &[Node],
        share: f64,
    ) -> Stage {
        let found: Vec<(f64, u32)> = nodes
            .par_iter()
            .enumerate()
            .with_min_len(TOGETHER)
            .map(|(index, node)| {
                let mut best = (f64::INFINITY, u32::MAX);
                for other in self.candidates(before, gap, node).into_iter().flatten() {
                    let value = last.values[other];
                    if value >= best.0 {
                        continue;
                    }
                    let Ok(cost) = self.cost(gap, &before[other], node) else {
                        continue;
                    };
                    let link = (station, other as u32, index as u32);
                    if value + cost < best.0 && !self.broken.contains(&link) {
                        best = (value + cost, other as u32);
                    }
                }
                (best.0 + share * node.cost, best.1)
            })
            .collect();
        let (values, from) = found.into_iter().unzip();
        Stage { values, from }
    }
}

/// Result of the search along the way so far.
#[derive(Clone, Debug, Default)]
pub(crate) struct Progress {
    pub stages: Vec<Stage>,
}

impl Progress {
    /// Goes on until the last station or until no posture of a station is reached; tells at which one that is.
    pub fn go_on(
        &mut self,
        links: &Links,
        stations: &[Station],
        nodes: &[Vec<Node>],
        first: usize,
    ) -> Result<(), usize> {
        for index in first + self.stages.len()..stations.len() {
            let share = stations[index].share;
            let stage = match (stations[index].gap, self.stages.last()) {
                (Some(gap), Some(last)) => {
                    links.step(index, &gap, last, &nodes[index - 1], &nodes[index], share)
                }
                _ => Stage {
                    values: nodes[index].iter().map(|node| share * node.cost).collect(),
                    from: vec![u32::MAX; nodes[index].len()],
                },
            };
            if !stage.is_reached() {
                return Err(index);
            }
            self.stages.push(stage);
        }
        Ok(())
    }

    /// Forgets what follows from a station on.
    pub fn forget_from(&mut self, station: usize) {
        self.stages.truncate(station);
    }

    /// The cheapest way to the last station that was reached: its cost, and the number of the posture at every station.
    pub fn best(&self) -> Option<(f64, Vec<u32>)> {
        let last = self.stages.last()?;
        let (mut at, cost) = last
            .values
            .iter()
            .enumerate()
            .min_by(|a, b| a.1.total_cmp(b.1))
            .map(|(index, value)| (index as u32, *value))?;
        let mut chosen = Vec::with_capacity(self.stages.len());
        for stage in self.stages.iter().rev() {
            chosen.push(at);
            at = stage.from[at as usize];
        }
        chosen.reverse();
        Some((cost, chosen))
    }
}
