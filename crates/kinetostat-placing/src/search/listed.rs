//! The best and the next best placements.

use kinetostat_machining::RunError;

use crate::answer::{Candidate, Evaluated};
use crate::search::looking::{SAME, Search};

/// Maximum number of placements that are solved at all places for the list.
const MOST_CHECKED: usize = 40;

impl Search<'_, '_> {
    /// The best and the next best placements, solved at all places, the best first.
    pub(super) fn listed(
        &self,
        worths: &[Evaluated],
        filling: &[Evaluated],
    ) -> Result<Vec<Candidate>, RunError> {
        let mut all: Vec<&Evaluated> = worths.iter().chain(filling).collect();
        all.retain(|evaluated| evaluated.value.figure().is_some());
        // The sort is stable: of equal ones a refined one stays before.
        all.sort_by(|a, b| a.value.order(&b.value));
        let mut chosen: Vec<Candidate> = Vec::new();
        let mut checked = 0;
        for Evaluated { place, .. } in all {
            if chosen.len() > self.effort.listed || checked == MOST_CHECKED {
                break;
            }
            let apart = |other: &Candidate| self.space().distance(&other.place, place) > SAME;
            if !chosen.iter().all(apart) {
                continue;
            }
            self.still_wanted()?;
            checked += 1;
            let (candidate, _) = self.candidate(place);
            if candidate.figure.is_some() {
                chosen.push(candidate);
            }
        }
        let figure = |c: &Candidate| c.figure.unwrap_or(f64::INFINITY);
        chosen.sort_by(|a, b| figure(a).total_cmp(&figure(b)));
        Ok(chosen)
    }
}
