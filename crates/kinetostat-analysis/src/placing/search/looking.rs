//! Services for every part of a search: the value of a placement at some places or at all, cancellation, and starts.

use std::sync::atomic::{AtomicUsize, Ordering};

use kinetostat_machining::{RunError, Watch};
use nalgebra::Vector3;
use rayon::prelude::*;
use sobol_burley::sample;

use crate::placing::answer::{Candidate, Evaluated};
use crate::placing::evaluate::Evaluator;
use crate::placing::space::{Place, Space};
use crate::placing::value::{Refusal, Value, Why};

/// Placements nearer than this share of the ranges are the same one.
pub(super) const SAME: f64 = 0.08;

/// A search that goes on.
pub(super) struct Search<'s, 'e> {
    pub(super) evaluator: &'s Evaluator<'e>,
    pub(super) effort: Effort,
    pub(super) watch: &'s dyn Watch,
    pub(super) evaluated: AtomicUsize,
}

impl Search<'_, '_> {
    pub(super) fn space(&self) -> &Space {
        self.evaluator.space
    }

    pub(super) fn worth(&self, place: &Place, active: &[usize]) -> Value {
        if self.watch.cancelled() {
            return Value::Refused(Refusal {
                why: Why::NoFigure,
                line: None,
                amount: f64::INFINITY,
                message: String::new(),
            });
        }
        let done = self.evaluated.fetch_add(1, Ordering::Relaxed) + 1;
        self.watch.advance(done);
        self.evaluator.at(place, active)
    }

    pub(super) fn still_wanted(&self) -> Result<(), RunError> {
        match self.watch.cancelled() {
            true => Err(RunError::Cancelled),
            false => Ok(()),
        }
    }

    pub(super) fn candidate(&self, place: &Place) -> (Candidate, Vec<usize>) {
        let found = self.evaluator.on_all(self.space().placement(place));
        let program = self.evaluator.program;
        let at = |i: usize| (program.line(i), program.position_mm(i).into());
        (
            Candidate::new(self.space(), place, &found, at),
            found.telling,
        )
    }
}

/// Effort of a search.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// Placements that fill the space, of each fixture; by the number of variables without it.
    pub samples: Option<usize>,
    /// The best ones apart from each other that are refined.
    pub starts: usize,
    /// Next best placements that are listed.
    pub listed: usize,
    /// Maximum number of places of the program; a longer one is thinned.
    pub most_places: usize,
    /// True if slices are solved for pictures.
    pub maps: bool,
}

impl Default for Effort {
    fn default() -> Self {
        Self {
            samples: None,
            starts: 6,
            listed: 10,
            most_places: 100_000,
            maps: true,
        }
    }
}

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
