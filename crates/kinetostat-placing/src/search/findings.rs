//! Remarks on an answer.

use kinetostat::number::larger;

use crate::answer::{Candidate, Finding, Placed};
use crate::search::looking::Search;

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
