//! The search: everywhere, then locally, and checked at all places of the program.
//!
//! A placement is looked at at a few dozen places of the program: some along the path, those that lie farthest out, and those
//! that have turned out to be worst. The best placement is then solved at all places. Where another place is worse, or
//! refuses it, that place is added and the search goes on from where it is. So the figures of the search are never above those of the
//! whole program, and the best one is that of the whole program.

use std::sync::atomic::{AtomicUsize, Ordering};

use kinetostat::number::larger;
use kinetostat_machining::{MovableProgram, RunError, Task, Watch};
use nalgebra::Vector3;
use rayon::prelude::*;
use sobol_burley::sample;

use crate::answer::{Candidate, Evaluated, Finding, Nowhere, Placed};
use crate::evaluate::{Evaluator, Question};
use crate::maps::maps;
use crate::refine::{Worth, refined};
use crate::sensitivity::sensitivity;
use crate::space::{Place, Space};
use crate::value::{Refusal, Value, Why};

/// How long to look.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// Placements that fill the space, of each fixture; by the number of variables without it.
    pub samples: Option<usize>,
    /// The best ones apart from each other that are refined.
    pub starts: usize,
    /// Next best placements that are listed.
    pub listed: usize,
    /// Most places of the program; of a longer one every so many are looked at.
    pub most_places: usize,
    /// Whether slices are solved for pictures.
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

/// Placements nearer than this share of the ranges are the same one.
const SAME: f64 = 0.08;

/// First step of a refinement, and of one that goes on with more places, as shares of the ranges.
const FIRST_STEP: f64 = 0.12;
const NEXT_STEP: f64 = 0.03;

/// Times that places are added.
const ROUNDS: usize = 8;

/// A figure of some places is that of all up to this share.
const AGREES: f64 = 1e-6;

/// Places along the path that a search begins with.
const ALONG: usize = 24;

/// Most placements that are solved at all places for the list.
const MOST_CHECKED: usize = 40;

/// Where the program of a task lies best.
///
/// # Errors
/// [`RunError::NoMotion`], [`RunError::Cancelled`]. That no placement can be taken is an answer ([`Placed::nowhere`]).
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

struct Search<'s, 'e> {
    evaluator: &'s Evaluator<'e>,
    effort: Effort,
    watch: &'s dyn Watch,
    evaluated: AtomicUsize,
}

impl Search<'_, '_> {
    fn space(&self) -> &Space {
        self.evaluator.space
    }

    fn worth(&self, place: &Place, active: &[usize]) -> Value {
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

    fn still_wanted(&self) -> Result<(), RunError> {
        match self.watch.cancelled() {
            true => Err(RunError::Cancelled),
            false => Ok(()),
        }
    }

    fn candidate(&self, place: &Place) -> (Candidate, Vec<usize>) {
        let found = self.evaluator.on_all(self.space().placement(place));
        let program = self.evaluator.program;
        let at = |i: usize| (program.line(i), program.position_mm(i).into());
        (
            Candidate::new(self.space(), place, &found, at),
            found.telling,
        )
    }

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
            let Some(best) = worths.first().filter(|best| best.1.figure().is_some()) else {
                break;
            };
            let (found, telling) = self.candidate(&best.0);
            let figure = best.1.figure().unwrap_or(f64::INFINITY);
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
            let again = worths.iter().map(|(place, _)| {
                let value = self.worth(place, &active);
                (place.clone(), value)
            });
            let again: Vec<Worth> = again.collect();
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
            let worth = (best.place.clone(), at(&best.place));
            placed.sensitivity = sensitivity(space, &worth, &at);
            if self.effort.maps {
                placed.maps = maps(space, &best.place, &at);
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

    /// Places that a search begins with: evenly along the path, and those that lie farthest out in 26 directions.
    fn first_places(&self) -> Vec<usize> {
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
    fn filling(&self, active: &[usize]) -> Vec<Evaluated> {
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
    fn distinct(&self, samples: &[Evaluated], count: usize) -> Vec<Worth> {
        let mut sorted: Vec<&Evaluated> = samples.iter().collect();
        sorted.sort_by(|a, b| a.value.order(&b.value));
        let mut chosen: Vec<Worth> = Vec::new();
        for sample in sorted {
            if chosen.len() == count {
                break;
            }
            let apart = |(other, _): &Worth| self.space().distance(other, &sample.place) > SAME;
            if chosen.iter().all(apart) {
                chosen.push((sample.place.clone(), sample.value.clone()));
            }
        }
        chosen
    }

    /// All refined, the best first.
    fn all_refined(&self, starts: Vec<Worth>, active: &[usize], step: f64) -> Vec<Worth> {
        let worth = |place: &Place| self.worth(place, active);
        let found = starts.into_par_iter();
        let found = found.map(|start| refined(self.space(), start, step, &worth));
        let mut found: Vec<Worth> = found.collect();
        found.sort_by(|a, b| a.1.order(&b.1));
        found
    }

    /// The best and the next best placements, solved at all places, the best first.
    fn listed(&self, worths: &[Worth], filling: &[Evaluated]) -> Result<Vec<Candidate>, RunError> {
        let refined = worths.iter().map(|(place, value)| (place.clone(), value));
        let others = filling.iter().map(|e| (e.place.clone(), &e.value));
        let mut all: Vec<(Place, &Value)> = refined.chain(others).collect();
        all.retain(|(_, value)| value.figure().is_some());
        // The sort is stable: of equal ones a refined one stays before.
        all.sort_by(|a, b| a.1.order(b.1));
        let mut chosen: Vec<Candidate> = Vec::new();
        let mut checked = 0;
        for (place, _) in all {
            if chosen.len() > self.effort.listed || checked == MOST_CHECKED {
                break;
            }
            let apart = |other: &Candidate| self.space().distance(&other.place, &place) > SAME;
            if !chosen.iter().all(apart) {
                continue;
            }
            self.still_wanted()?;
            checked += 1;
            let (candidate, _) = self.candidate(&place);
            if candidate.figure.is_some() {
                chosen.push(candidate);
            }
        }
        let figure = |c: &Candidate| c.figure.unwrap_or(f64::INFINITY);
        chosen.sort_by(|a, b| figure(a).total_cmp(&figure(b)));
        Ok(chosen)
    }

    /// The placement that is nearest to being taken, and how far the part would have to be moved.
    fn nowhere(&self, worths: &[Worth], filling: &[Evaluated]) -> Option<Nowhere> {
        let filled = filling.iter().map(|e| (&e.place, &e.value));
        let all = worths
            .iter()
            .map(|(place, value)| (place, value))
            .chain(filled);
        let (place, _) = all.min_by(|a, b| a.1.order(b.1))?;
        let (nearest, _) = self.candidate(place);
        Some(Nowhere {
            move_mm: self.way_back(place),
            nearest,
        })
    }

    /// The shortest move of the part towards the tool at home with which all of the program is reached, base axes, mm.
    fn way_back(&self, place: &Place) -> Option<[f64; 3]> {
        let program = self.evaluator.program;
        let lies = self.space().placement(place);
        let probes = self.first_places();
        let tip = |i: &usize| program.tool_pose(lies, *i).translation.vector;
        let middle: Vector3<f64> =
            probes.iter().map(tip).sum::<Vector3<f64>>() / probes.len() as f64;
        let way = self.evaluator.home - middle;
        let reached = |share: f64| {
            let mut moved = lies;
            moved.base_from_part.translation.vector += way * share;
            let reach = |i: &usize| program.reach(moved, *i);
            let reached = |i: &usize| matches!(reach(i), kinetostat_machining::Reach::Reached);
            probes.iter().all(reached)
        };
        const STEPS: usize = 40;
        let first = (1..=STEPS).find(|i| reached(*i as f64 / STEPS as f64))?;
        let (mut short, mut far) = (
            (first - 1) as f64 / STEPS as f64,
            first as f64 / STEPS as f64,
        );
        for _ in 0..12 {
            let middle = (short + far) / 2.0;
            match reached(middle) {
                true => far = middle,
                false => short = middle,
            }
        }
        Some((way * far * 1e3).into())
    }

    fn findings(&self, placed: &Placed, best: &Candidate) -> Vec<Finding> {
        let mut findings = Vec::new();
        let mut add = |kind, message| findings.push(Finding { kind, message });
        let space = self.space();
        let figures: Vec<f64> = placed
            .filling
            .iter()
            .filter_map(|sample| sample.value.figure())
            .collect();
        let largest = figures.iter().copied().fold(0.0, larger);
        let own = best.figure.unwrap_or(f64::NAN);
        let what = self.evaluator.question.objective.what();
        let flat = figures.len() > 1 && largest <= 1.01 * own;
        if flat {
            add(
                "flat",
                format!(
                    "the {what} hardly depends on where the part lies: between all placements that were looked at it differs by {:.2} %. Any of them is as good",
                    100.0 * (largest / own - 1.0)
                ),
            );
        }
        for (range, value) in space.ranges().iter().zip(&best.place.values) {
            let close = 0.005 * (range.to - range.from);
            let whole_turn = range.variable.unit() == "deg" && range.to - range.from >= 360.0;
            let end = match () {
                () if value - range.from <= close => range.from,
                () if range.to - value <= close => range.to,
                () => continue,
            };
            if !flat && !whole_turn {
                add(
                    "at_bound",
                    format!(
                        "the best placement lies at the end of a range: {} = {} {} (range {} to {}). Beyond it the figure may be less: widen the range if there is room",
                        range.variable.words(),
                        end,
                        range.variable.unit(),
                        range.from,
                        range.to
                    ),
                );
            }
        }
        let share = placed.taken as f64 / placed.samples as f64;
        if placed.samples > 20 && share < 0.1 {
            add(
                "few_reachable",
                format!(
                    "only {} of {} placements that fill the ranges can be taken: narrower ranges around the best one show more",
                    placed.taken, placed.samples
                ),
            );
        }
        let every = self.evaluator.program.every();
        if every > 1 {
            add(
                "thinned",
                format!(
                    "the program is long: one of {every} of its places was looked at; `kinetostat deflect` at the best placement looks at all of them"
                ),
            );
        }
        findings
    }
}
