//! The search: everywhere, then locally, and checked at all places of the program.
//!
//! A placement is looked at at a few dozen places of the program: some along the path, those that lie farthest out, and those that
//! have turned out to be worst. The best placement is then solved at all places. If another place is worse, or refuses it, that place
//! is added and the search goes on from where it is. The figures of the search are therefore never above those of the whole program,
//! and the best one is that of the whole program.

mod findings;
mod looking;

use std::sync::atomic::{AtomicUsize, Ordering};

use kinetostat_machining::{MovableProgram, RunError, Task, Watch};
use rayon::prelude::*;

use crate::placing::answer::{Candidate, Evaluated, Placed};
use crate::placing::evaluate::{Evaluator, Question};
use crate::placing::refine::refined;
use crate::placing::search::looking::Search;
use crate::placing::sensitivity::{maps, sensitivity};
use crate::placing::space::{Place, Space};

pub use looking::Effort;

/// First step of a refinement, and of one that goes on with more places, as shares of the ranges.
const FIRST_STEP: f64 = 0.12;
const NEXT_STEP: f64 = 0.03;

/// Times that places are added.
const ROUNDS: usize = 8;

/// A figure of some places is that of all up to this share.
const AGREES: f64 = 1e-6;

/// Finds the best placement of the program of a task.
///
/// # Errors [`RunError::NoMotion`], [`RunError::Cancelled`]. A search without a placement that can be taken is no
/// error ([`Placed::nowhere`]).
pub fn place(
    task: &Task<'_>,
    space: &Space,
    question: &Question,
    effort: Effort,
    watch: &dyn Watch,
) -> Result<Placed, RunError> {
    let program = MovableProgram::new(task, effort.most_places, watch)?;
    let mechanism = task.mechanism;
    let home = mechanism.platforms()[mechanism.tool()].home;
    let evaluator = Evaluator {
        program: &program,
        space,
        question,
        home: home.translation.vector,
        size: mechanism.size(),
    };
    Search {
        evaluator: &evaluator,
        effort,
        watch,
        evaluated: AtomicUsize::new(0),
    }
    .run()
}

impl Search<'_, '_> {
    fn run(&self) -> Result<Placed, RunError> {
        self.watch.stage("placements", 0);
        let space = self.space();
        let mut active = self.first_places();
        let filling = self.filling(&active);
        self.still_wanted()?;
        let starts = self.distinct(&filling, self.effort.starts);
        let mut worths = self.all_refined(starts, &active, FIRST_STEP);
        self.still_wanted()?;
        for _ in 0..ROUNDS {
            let Some(best) = worths.first().filter(|best| best.value.figure().is_some()) else {
                break;
            };
            let (found, telling) = self.candidate(&best.place);
            let figure = best.value.figure().unwrap_or(f64::INFINITY);
            if found
                .figure
                .is_some_and(|all| all <= figure * (1.0 + AGREES))
            {
                break;
            }
            let new: Vec<usize> = telling
                .into_iter()
                .filter(|i| !active.contains(i))
                .collect();
            if new.is_empty() {
                // Refused for what only all places together show.
                worths.remove(0);
                continue;
            }
            active.extend(new);
            active.sort_unstable();
            let again = worths.iter().map(|before| Evaluated {
                place: before.place.clone(),
                value: self.worth(&before.place, &active),
            });
            let again = again.collect();
            worths = self.all_refined(again, &active, NEXT_STEP);
            self.still_wanted()?;
        }
        // Others that fill the space stand behind them in the list.
        let filling: Vec<Evaluated> = filling
            .par_iter()
            .map(|sample| Evaluated {
                place: sample.place.clone(),
                value: self.worth(&sample.place, &active),
            })
            .collect();
        self.still_wanted()?;
        let listed = self.listed(&worths, &filling)?;
        let (centre, _) = self.candidate(&space.centre());
        let mut placed = self.answer(listed, filling, centre, &active);
        if let Some(best) = placed.best.clone() {
            let at = |place: &Place| self.worth(place, &active);
            let worth = Evaluated {
                place: best.place.clone(),
                value: at(&best.place),
            };
            placed.sensitivity = sensitivity(space, &worth, at);
            if self.effort.maps {
                placed.maps = maps(space, &best.place, at);
            }
            placed.findings = self.findings(&placed, &best);
        } else {
            placed.nowhere = self.nowhere(&worths, &placed.filling);
        }
        self.still_wanted()?;
        placed.evaluated = self.evaluated.load(Ordering::Relaxed);
        Ok(placed)
    }

    fn answer(
        &self,
        listed: Vec<Candidate>,
        filling: Vec<Evaluated>,
        centre: Candidate,
        active: &[usize],
    ) -> Placed {
        let mut listed = listed.into_iter();
        Placed {
            best: listed.next(),
            next_best: listed.collect(),
            centre,
            given: self.evaluator.on_all(*self.space().given()).value.figure(),
            nowhere: None,
            sensitivity: Vec::new(),
            findings: Vec::new(),
            evaluated: 0,
            taken: filling
                .iter()
                .filter(|s| s.value.figure().is_some())
                .count(),
            samples: filling.len(),
            places: self.evaluator.program.len(),
            places_of_search: active.len(),
            maps: Vec::new(),
            filling,
        }
    }

    /// All refined, the best first.
    fn all_refined(&self, starts: Vec<Evaluated>, active: &[usize], step: f64) -> Vec<Evaluated> {
        let worth = |place: &Place| self.worth(place, active);
        let found = starts.into_par_iter();
        let found = found.map(|start| refined(self.space(), start, step, worth));
        let mut found: Vec<Evaluated> = found.collect();
        found.sort_by(|a, b| a.value.order(&b.value));
        found
    }
}
