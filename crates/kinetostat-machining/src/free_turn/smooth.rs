//! A smooth curve from the steps of the band: the cheapest one in a narrow corridor around what was found, in steps that are halved
//! again and again (dynamic programming in a corridor, Larson 1968). Every posture and every link keeps what those of the band keep, so
//! the curve stays where it is wherever nothing else is allowed, and it never costs more.

use std::collections::BTreeMap;

use kinetostat::number::larger;
use rayon::prelude::*;

use crate::free_turn::choice::TurnFigures;
use crate::free_turn::nodes::Node;
use crate::free_turn::search::{Found, Looked, Problem, Stand};

/// The step of the band is halved so often: 5 deg end at 0.0024.
const HALVINGS: usize = 11;

/// Maximum number of times that the corridor follows the curve with each step.
const PASSES: usize = 12;

/// Links that do not hold are taken out so often before a pass is given up.
const ROUNDS: usize = 50;

/// Steps from the curve that are tried, its own turn first: of what costs the same, the curve stays.
const STEPS: [i32; 5] = [0, -1, 1, -2, 2];

/// Candidates at a station.
type Tried = [Option<Node>; STEPS.len()];

/// The smooth curve around a curve.
pub(crate) fn smooth(problem: &Problem<'_, '_>, mut curve: Curve) -> Curve {
    let mut step_deg = problem.turns.step_deg;
    for _ in 0..HALVINGS {
        step_deg *= 0.5;
        let mut corridor = Corridor::around(problem, &curve, step_deg);
        for _ in 0..PASSES {
            if !corridor.follow(&mut curve) {
                break;
            }
        }
    }
    curve
}

/// Turns in steps from those of a curve.
struct Corridor<'p, 't, 'a> {
    problem: &'p Problem<'t, 'a>,
    step_deg: f64,
    /// Turns from which steps are counted, deg.
    base: Vec<f64>,
    /// Steps of the curve.
    at: Vec<i32>,
    /// Postures that were tried, by steps.
    known: Vec<BTreeMap<i32, Option<Node>>>,
}

impl<'p, 't, 'a> Corridor<'p, 't, 'a> {
    fn around(problem: &'p Problem<'t, 'a>, curve: &Curve, step_deg: f64) -> Self {
        let own = |node: &Node| BTreeMap::from([(0, Some(*node))]);
        Self {
            problem,
            step_deg,
            base: curve.turns.clone(),
            at: vec![0; curve.turns.len()],
            known: curve.nodes.iter().map(own).collect(),
        }
    }

    fn turn_deg(&self, station: usize, tried: usize) -> f64 {
        let steps = self.at[station] + STEPS[tried];
        self.base[station] + self.step_deg * f64::from(steps)
    }

    /// Candidates at all stations.
    fn candidates(&mut self, curve: &Curve) -> Vec<Tried> {
        let (problem, step_deg) = (self.problem, self.step_deg);
        let turns = &problem.turns;
        let least = turns.from_deg - 1e-9;
        let most = turns.from_deg + turns.step_deg * (turns.count - 1) as f64 + 1e-9;
        let stations = self.known.par_iter_mut().enumerate();
        let tried = stations.map(|(station, known)| {
            STEPS.map(|step| {
                let steps = self.at[station] + step;
                *known.entry(steps).or_insert_with(|| {
                    let turn = self.base[station] + step_deg * f64::from(steps);
                    let inside = turns.circle || (least..=most).contains(&turn);
                    let pose = &problem.stations[station].place.pose;
                    let pose = problem.way.turned(pose, turn);
                    let near = &curve.nodes[station];
                    inside.then(|| problem.postures.next_to(near, &pose))?
                })
            })
        });
        tried.collect()
    }

    /// Takes the curve to the cheapest one of the corridor; false if it is there already, or nothing else holds.
    fn follow(&mut self, curve: &mut Curve) -> bool {
        let mut tried = self.candidates(curve);
        for _ in 0..ROUNDS {
            let chosen = self.cheapest(&tried);
            if chosen.iter().all(|own| *own == 0) {
                return false;
            }
            let looked = self.look(&tried, &chosen);
            let broken = |(station, found): (usize, &Seen)| match found {
                Seen::Broken => Some(station),
                Seen::AsBefore | Seen::Holds(_) => None,
            };
            let broken: Vec<usize> = looked.iter().enumerate().filter_map(broken).collect();
            if broken.is_empty() {
                self.take(curve, &tried, &chosen, looked);
                return true;
            }
            // The ends of a broken link keep their values, for which it is feasible.
            for station in broken {
                for end in [station - 1, station] {
                    tried[end][1..].fill(None);
                }
            }
        }
        false
    }

    /// The cheapest candidate at every station.
    fn cheapest(&self, tried: &[Tried]) -> Vec<usize> {
        let problem = self.problem;
        let mut values = [f64::INFINITY; STEPS.len()];
        let mut from: Vec<[usize; STEPS.len()]> = Vec::with_capacity(tried.len());
        for (station, place) in problem.stations.iter().enumerate() {
            let mut next = [f64::INFINITY; STEPS.len()];
            let mut came = [0; STEPS.len()];
            for (own, node) in tried[station].iter().enumerate() {
                let Some(node) = node else { continue };
                let mut best = (f64::INFINITY, 0);
                match (place.gap, station.checked_sub(1)) {
                    (Some(gap), Some(before)) => {
                        for (other, node_before) in tried[before].iter().enumerate() {
                            let Some(node_before) = node_before else {
                                continue;
                            };
                            let turn = self.turn_deg(station, own) - self.turn_deg(before, other);
                            let ends = [&node_before.joints, &node.joints];
                            // The present curve is feasible.
                            let holds = (own, other) == (0, 0)
                                || problem.links.held(&gap, turn, ends).is_ok();
                            let value = values[other] + problem.links.evenness(&gap, turn);
                            if holds && value < best.0 {
                                best = (value, other);
                            }
                        }
                    }
                    _ => best.0 = 0.0,
                }
                next[own] = best.0 + place.share * node.cost;
                came[own] = best.1;
            }
            values = next;
            from.push(came);
        }
        let mut at = 0;
        for (own, value) in values.iter().enumerate() {
            if *value < values[at] {
                at = own;
            }
        }
        let mut chosen = vec![0; tried.len()];
        for station in (0..tried.len()).rev() {
            chosen[station] = at;
            at = from[station][at];
        }
        chosen
    }

    /// Checks the way between every station and the one before.
    fn look(&self, tried: &[Tried], chosen: &[usize]) -> Vec<Seen> {
        let between = self.problem.between();
        let stations = (0..chosen.len()).into_par_iter();
        let stand = |station: usize| {
            let own = chosen[station];
            let node = tried[station][own].as_ref()?;
            Some(Stand {
                station: &self.problem.stations[station],
                turn_deg: self.turn_deg(station, own),
                node,
            })
        };
        let seen = stations.map(|station| {
            let Some(before) = station.checked_sub(1) else {
                return Seen::AsBefore;
            };
            if chosen[before] == 0 && chosen[station] == 0 {
                return Seen::AsBefore;
            }
            let (Some(start), Some(end)) = (stand(before), stand(station)) else {
                return Seen::Broken;
            };
            let looked = between.look(start, end);
            looked.map_or(Seen::Broken, Seen::Holds)
        });
        seen.collect()
    }

    fn take(&mut self, curve: &mut Curve, tried: &[Tried], chosen: &[usize], looked: Vec<Seen>) {
        for (station, own) in chosen.iter().enumerate() {
            curve.turns[station] = self.turn_deg(station, *own);
            self.at[station] += STEPS[*own];
            if let Some(node) = tried[station][*own] {
                curve.nodes[station] = node;
            }
        }
        for (seen, looked) in curve.seen.iter_mut().zip(looked) {
            if let Seen::Holds(looked) = looked {
                *seen = looked;
            }
        }
    }
}

/// Result of a check between two stations.
enum Seen {
    AsBefore,
    Holds(Vec<Looked>),
    Broken,
}

/// Turns at all stations of a problem.
#[derive(Clone)]
pub(crate) struct Curve {
    /// deg, without jumps of 360.
    pub turns: Vec<f64>,
    pub nodes: Vec<Node>,
    /// Seen between every station and the one before.
    pub seen: Vec<Vec<Looked>>,
}

impl Curve {
    /// The steps of the band that were found.
    pub fn of(problem: &Problem<'_, '_>, found: Found) -> Self {
        let nodes = found.chosen.iter().enumerate();
        Self {
            turns: problem.turns_deg(&found.chosen),
            nodes: nodes
                .map(|(station, number)| *problem.node(station, *number))
                .collect(),
            seen: found.seen,
        }
    }

    /// A station with its turn and its posture.
    pub fn stand<'s>(&'s self, problem: &'s Problem<'_, '_>, station: usize) -> Stand<'s> {
        Stand {
            station: &problem.stations[station],
            turn_deg: self.turns[station],
            node: &self.nodes[station],
        }
    }

    /// Rates of turning to every station from the one before, deg/mm; `None` if the program does not state the way.
    fn rates(&self, problem: &Problem<'_, '_>) -> Vec<Option<f64>> {
        let gaps = problem.stations.iter().enumerate();
        gaps.map(|(station, place)| {
            let gap = place.gap.filter(|gap| gap.known)?;
            Some((self.turns[station] - self.turns[station - 1]) / gap.length)
        })
        .collect()
    }

    /// Cost and evenness of the curve.
    pub fn figures(&self, problem: &Problem<'_, '_>) -> TurnFigures {
        let mut cost = 0.0;
        for (station, place) in problem.stations.iter().enumerate() {
            cost += place.share * self.nodes[station].cost;
            if let (Some(gap), Some(before)) = (place.gap, station.checked_sub(1)) {
                let turn = self.turns[station] - self.turns[before];
                cost += problem.links.evenness(&gap, turn);
            }
        }
        let rates = self.rates(problem);
        let fastest = rates.iter().flatten().map(|rate| rate.abs());
        let changes = rates.windows(2).filter_map(|pair| match pair {
            [Some(before), Some(after)] => Some((after - before).abs()),
            _ => None,
        });
        TurnFigures {
            cost,
            largest_rate_deg_per_mm: fastest.fold(0.0, larger),
            largest_rate_change_deg_per_mm: changes.fold(0.0, larger),
        }
    }
}
