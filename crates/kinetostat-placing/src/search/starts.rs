//! Starts of a search: places of the program, and placements that fill the space.

use nalgebra::Vector3;
use rayon::prelude::*;
use sobol_burley::sample;

use crate::answer::Evaluated;
use crate::search::looking::{SAME, Search};
use crate::space::Place;

/// Seed of the sequence that fills the space.
const SEED: u32 = 16;

/// Places along the path that a search begins with.
const ALONG: usize = 24;

impl Search<'_, '_> {
    /// Places that a search begins with: evenly along the path, and those that lie farthest out in 26 directions.
    pub(super) fn first_places(&self) -> Vec<usize> {
        let program = self.evaluator.program;
        let count = program.len();
        let mut chosen: Vec<usize> = (0..ALONG.min(count))
            .map(|k| k * count / ALONG.min(count))
            .collect();
        for code in 0..27 {
            let part = |k: u32| f64::from(code / 3_i32.pow(k) % 3 - 1);
            let direction = Vector3::new(part(0), part(1), part(2));
            for feed in [true, false] {
                let of_kind = (0..count).filter(|i| program.at_feed(*i) == feed);
                let far = |i: &usize| program.position_mm(*i).dot(&direction);
                let farthest = of_kind.max_by(|a, b| far(a).total_cmp(&far(b)).then(b.cmp(a)));
                chosen.extend(farthest);
            }
        }
        chosen.sort_unstable();
        chosen.dedup();
        chosen
    }

    /// Placements that fill the space evenly, with the middle of it.
    pub(super) fn filling(&self, active: &[usize]) -> Vec<Evaluated> {
        let space = self.space();
        let size = space.ranges().len();
        let count = match (self.effort.samples, size) {
            (Some(count), _) => count.max(1),
            (None, 0) => 1,
            (None, 1) => 64,
            (None, 2) => 256,
            (None, 3) => 512,
            (None, _) => 1024,
        };
        // A longer sequence has other bits, but is as even.
        let point = |i: usize| -> Vec<f64> {
            let (index, seed) = ((i & 0xffff) as u32, SEED + (i >> 16) as u32);
            (0..size)
                .map(|k| f64::from(sample(index, k as u32, seed)))
                .collect()
        };
        let fixtures = space.fixtures().len().max(1);
        let mut places: Vec<Place> = (0..fixtures)
            .flat_map(|fixture| {
                let middle = std::iter::once(space.at(fixture, &vec![0.5; size]));
                let spread = (0..count).map(point).map(move |shares| (fixture, shares));
                middle.chain(spread.map(|(fixture, shares)| space.at(fixture, &shares)))
            })
            .collect();
        places.dedup();
        places
            .into_par_iter()
            .map(|place| {
                let value = self.worth(&place, active);
                Evaluated { place, value }
            })
            .collect()
    }

    /// The best ones, each apart from those before it.
    pub(super) fn distinct(&self, samples: &[Evaluated], count: usize) -> Vec<Evaluated> {
        let mut sorted: Vec<&Evaluated> = samples.iter().collect();
        sorted.sort_by(|a, b| a.value.order(&b.value));
        let mut chosen: Vec<Evaluated> = Vec::new();
        for sample in sorted {
            if chosen.len() == count {
                break;
            }
            let apart =
                |other: &Evaluated| self.space().distance(&other.place, &sample.place) > SAME;
            if chosen.iter().all(apart) {
                chosen.push(sample.clone());
            }
        }
        chosen
    }
}
