//! The answer of a search: the best placements, remarks on them, and an explanation where there is none.

use kinetostat::number::larger;
use kinetostat_machining::RunError;
use nalgebra::Vector3;

use crate::placing::answer::{Candidate, Evaluated, Finding, Nowhere, Placed};
use crate::placing::search::looking::{SAME, Search};
use crate::placing::space::Place;

impl Search<'_, '_> {
    /// Remarks on an answer at the end of a range, with equals, or from few samples.
    pub(super) fn findings(&self, placed: &Placed, best: &Candidate) -> Vec<Finding> {
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

impl Search<'_, '_> {
    /// The placement that is nearest to being taken, and how far the part would have to be moved.
    pub(super) fn nowhere(&self, worths: &[Evaluated], filling: &[Evaluated]) -> Option<Nowhere> {
        let all = worths.iter().chain(filling);
        let place = &all.min_by(|a, b| a.value.order(&b.value))?.place;
        let (nearest, _) = self.candidate(place);
        Some(Nowhere {
            move_mm: self.way_back(place),
            nearest,
        })
    }

    /// The shortest move of the part towards the tool at home with which all of the program is reached, base axes, mm.
    pub(super) fn way_back(&self, place: &Place) -> Option<[f64; 3]> {
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
}
