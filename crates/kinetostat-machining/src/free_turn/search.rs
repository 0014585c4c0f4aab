//! The cheapest sequence of postures that holds also between its stations.

use std::collections::BTreeSet;
use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;

use crate::free_turn::error::TurnError;
use crate::free_turn::nodes::{Node, Postures, Refused};
use crate::free_turn::serial::Joints;
use crate::free_turn::shortest::{Link, Links, Progress, joint_turns};
use crate::free_turn::task::TurnTask;
use crate::free_turn::way::{Station, Turns, Way, lets_turn, stations};

/// Rounds of searching again without the links that do not hold, ...
const ROUNDS: usize = 2000;

/// ... and how often all stations, or so many, are gone through again in all.
const TIMES: usize = 50;
const AT_LEAST: usize = 10_000;

/// Everything that a search goes through.
pub(crate) struct Problem<'t, 'a> {
    pub task: &'t TurnTask<'a>,
    pub way: Way<'a>,
    pub turns: Turns,
    pub stations: Vec<Station>,
    pub postures: Postures<'a>,
    pub nodes: Vec<Vec<Node>>,
    pub links: Links,
}

/// A sequence that holds.
pub(crate) struct Found {
    /// The number of the posture at every station.
    pub chosen: Vec<u32>,
    /// Seen between every station and the one before.
    pub seen: Vec<Vec<Looked>>,
}

/// Reason for which there is no sequence.
pub(crate) enum Failed {
    /// No posture of a station is reached.
    At(usize, Progress),
    Error(TurnError),
}

impl<'t, 'a> Problem<'t, 'a> {
    /// Prepares a task whose numbers have been checked.
    pub fn of(task: &'t TurnTask<'a>) -> Result<Self, TurnError> {
        let mut postures = Postures::of(task)?;
        let way = Way::of(task)?;
        let turns = Turns::of(&task.band);
        let stations = stations(task, &way)?;
        lets_turn(task, &stations, &turns)?;
        let most = task.bounds.most_postures;
        let kept = AtomicUsize::new(0);
        let nodes: Result<Vec<Vec<Node>>, TurnError> = stations
            .par_iter()
            .map(|station| {
                let nodes = postures.at(station, &way, &turns)?;
                let before = kept.fetch_add(nodes.len(), Ordering::Relaxed);
                match before + nodes.len() > most {
                    true => Err(TurnError::TooMany {
                        what: format!(
                            "{} turns at {} stations have too many postures",
                            turns.count,
                            stations.len()
                        ),
                        most,
                    }),
                    false => Ok(nodes),
                }
            })
            .collect();
        let mut nodes = nodes?;
        postures.put_costs(&mut nodes);
        let free = [0, 1, 2, 3, 4, 5].map(|joint| postures.ranges.is_free(joint));
        let links = Links {
            turns,
            free,
            joint_step: task.bounds.joint_step_deg.to_radians(),
            weight: postures.weights.turning,
            length: way.length,
            broken: BTreeSet::new(),
        };
        Ok(Self {
            task,
            way,
            turns,
            stations,
            postures,
            nodes,
            links,
        })
    }

    /// The posture of a number at a station.
    pub fn node(&self, station: usize, number: u32) -> &Node {
        &self.nodes[station][number as usize]
    }

    /// Turns along a sequence, deg, without jumps of 360.
    pub fn turns_deg(&self, chosen: &[u32]) -> Vec<f64> {
        let mut before: Option<(f64, u32)> = None;
        let turns = chosen.iter().enumerate().map(|(station, number)| {
            let own = self.node(station, *number).turn;
            let turn = match before {
                None => self.turns.deg(own),
                Some((turn, last)) => {
                    turn + self.turns.step_deg * self.turns.steps(last, own) as f64
                }
            };
            before = Some((turn, own));
            turn
        });
        turns.collect()
    }

    /// The cheapest sequence that holds also between its stations: where it does not, it is looked for again without those links.
    pub fn search(&mut self) -> Result<Found, Failed> {
        let mut progress = Progress::default();
        let mut seen: Vec<(Link, Vec<Looked>)> =
            vec![((0, u32::MAX, u32::MAX), Vec::new()); self.stations.len()];
        let mut again = 0;
        for _ in 0..ROUNDS {
            if let Err(station) = progress.go_on(&self.links, &self.stations, &self.nodes, 0) {
                return Err(Failed::At(station, progress));
            }
            let Some((_, chosen)) = progress.best() else {
                return Err(Failed::At(0, progress));
            };
            let broken = self.look_between(&chosen, &mut seen);
            let Some(first) = broken.iter().map(|link| link.0).min() else {
                let seen = seen.into_iter().map(|(_, looked)| looked).collect();
                return Ok(Found { chosen, seen });
            };
            self.links.broken.extend(broken);
            progress.forget_from(first);
            again += self.stations.len() - first;
            if again > AT_LEAST.max(TIMES * self.stations.len()) {
                break;
            }
        }
        Err(Failed::Error(TurnError::Input {
            what: format!(
                "stations of {} mm are too far apart for this path: whatever is chosen at them leaves what is allowed between them. Take \
                 stations that are closer together (station_mm), and a smaller step of the band",
                self.task.station_mm
            ),
        }))
    }

    /// Settings for checking the way between stations.
    pub fn between(&self) -> Between<'_, 'a> {
        Between {
            way: &self.way,
            postures: &self.postures,
            free: self.links.free,
            joint_step: self.links.joint_step,
            checks: self.task.bounds.checks_between,
        }
    }

    /// Looks at the links of a sequence that were not looked at before; those that do not hold.
    fn look_between(&self, chosen: &[u32], seen: &mut [(Link, Vec<Looked>)]) -> Vec<Link> {
        let between = self.between();
        let found = seen.par_iter_mut().enumerate().skip(1).map(|(to, known)| {
            let link = (to, chosen[to - 1], chosen[to]);
            if known.0 == link {
                return None;
            }
            let (a, b) = (self.node(to - 1, link.1), self.node(to, link.2));
            let start = Stand {
                station: &self.stations[to - 1],
                turn_deg: self.turns.deg(a.turn),
                node: a,
            };
            let steps = self.turns.steps(a.turn, b.turn) as f64;
            let end = Stand {
                station: &self.stations[to],
                turn_deg: start.turn_deg + steps * self.turns.step_deg,
                node: b,
            };
            match between.look(start, end) {
                Ok(looked) => {
                    *known = (link, looked);
                    None
                }
                Err(_) => Some(link),
            }
        });
        found.flatten_iter().collect()
    }
}

/// A place at which the way was looked at.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Looked {
    /// Line of the program.
    pub line: usize,
    /// Joint values, rad.
    pub joints: Joints,
    /// Smallest singular value.
    pub singular_value: f64,
}

/// A posture at a station, with the turn of the tool.
#[derive(Clone, Copy)]
pub(crate) struct Stand<'s> {
    pub station: &'s Station,
    /// deg, without jumps of 360 from one station to the next.
    pub turn_deg: f64,
    pub node: &'s Node,
}

/// Settings for checking the way between stations.
pub(crate) struct Between<'t, 'a> {
    pub way: &'t Way<'a>,
    pub postures: &'t Postures<'a>,
    pub free: [bool; 6],
    pub joint_step: f64,
    pub checks: usize,
}

impl Between<'_, '_> {
    /// Places between two stations: evenly, and where moves meet, as way in mm with the section.
    fn places(&self, from: &Station, to: &Station) -> Vec<(f64, usize)> {
        let length = to.at - from.at;
        let pieces = self.checks + 1;
        let even = (1..pieces).map(|piece| from.at + length * piece as f64 / pieces as f64);
        let sections = from.place.move_index..=to.place.move_index;
        let ends = self.way.sections[sections]
            .iter()
            .map(|section| section.from);
        let mut places: Vec<f64> = even.chain(ends).collect();
        places.retain(|at| *at > from.at && *at < to.at);
        places.sort_by(f64::total_cmp);
        places.dedup();
        places
            .into_iter()
            .map(|at| (at, self.way.section_at(at)))
            .collect()
    }

    /// Follows the arm from a posture at one station to a posture at the next; what was seen, or where and why it may not go on.
    pub fn look(&self, start: Stand<'_>, end: Stand<'_>) -> Result<Vec<Looked>, (usize, Refused)> {
        let (from, to) = (start.station, end.station);
        let (a, b) = (start.node, end.node);
        let length = to.at - from.at;
        if length <= 0.0 || to.gap.is_none_or(|gap| !gap.known) {
            return Ok(Vec::new());
        }
        let turn_deg = end.turn_deg - start.turn_deg;
        let whole = joint_turns(&self.free, &a.joints, &b.joints);
        let mut seen = Vec::new();
        for (at, section) in self.places(from, to) {
            let share = (at - from.at) / length;
            let place = self.way.place(section, at);
            let pose = self
                .way
                .turned(&place.pose, start.turn_deg + share * turn_deg);
            let mut even = a.joints;
            for (joint, turn) in even.iter_mut().zip(whole) {
                *joint += share * turn;
            }
            let refused = |why| (place.line, why);
            let found = self.postures.arm.serial.near(&pose, &even);
            let joints = found.ok_or(refused(Refused::Singular))?;
            // Elsewhere than between its neighbours: the arm would have to leave the way.
            let strays = (0..6).any(|joint| (joints[joint] - even[joint]).abs() > self.joint_step);
            if strays || self.postures.configuration_of(&joints) != Some(a.configuration) {
                return Err(refused(Refused::Singular));
            }
            let singular_value = self.postures.allowed(&joints).map_err(refused)?;
            seen.push(Looked {
                line: place.line,
                joints,
                singular_value,
            });
        }
        Ok(seen)
    }
}
