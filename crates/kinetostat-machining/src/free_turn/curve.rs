//! The turn along the way as a curve, evenly between its stations, with the posture at each of them.

use kinetostat::number::larger;

use crate::free_turn::between::{Looked, Stand};
use crate::free_turn::choice::TurnFigures;
use crate::free_turn::nodes::Node;
use crate::free_turn::search::{Found, Problem};

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
