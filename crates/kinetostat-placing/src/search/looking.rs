//! Services for every part of a search: the value of a placement at some places or at all, and cancellation.

use std::sync::atomic::{AtomicUsize, Ordering};

use kinetostat_machining::{RunError, Watch};

use crate::answer::Candidate;
use crate::evaluate::Evaluator;
use crate::space::{Place, Space};
use crate::value::{Refusal, Value, Why};

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
