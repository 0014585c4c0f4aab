//! Warnings of a long program, put together from those of its parts: what only the whole tells is said of the whole, and what
//! every part says is said once, with the lines.

use serde::{Deserialize, Serialize};

use crate::checks::unusual::unusual_figures;
use crate::result::point::PointKind;
use crate::result::summary::Summary;
use crate::run::conclude::Run;
use crate::task::Task;
use crate::warning::{Warning, WarningCode};

/// Warnings that are kept; further ones are counted.
const MOST: usize = 200;

/// Lines of further parts that a warning names.
const MOST_LINES: usize = 5;

/// A warning with the lines of further parts that say the same.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Said {
    warning: Warning,
    /// Index of the part that said it first.
    part: usize,
    further_lines: Vec<usize>,
    further_parts: usize,
}

/// Warnings of the parts that are done.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct MergedWarnings {
    said: Vec<Said>,
    /// Number of warnings for which no room was left.
    further: usize,
    /// A load acts somewhere; else what was said of that.
    acts: bool,
    never_acts: Option<Warning>,
    /// Largest correction of a part that cuts, mm, and what is unusual about it.
    largest_correction_mm: Option<f64>,
    of_correction: Option<Warning>,
    /// Warnings about the figures of all parts.
    of_figures: Vec<Warning>,
}

impl MergedWarnings {
    /// Takes those of the next part; `whole` are the figures with it.
    pub(crate) fn add(&mut self, task: &Task<'_>, part: usize, run: &Run, whole: &Summary) {
        let cuts = |kind: PointKind| kind != PointKind::Rapid;
        let does_cut = run.points.iter().any(|p| cuts(p.kind));
        let loaded = |force: [f64; 3]| force.iter().any(|x| *x != 0.0);
        self.acts |= run.points.iter().any(|p| cuts(p.kind) && loaded(p.force_n));
        self.of_figures = unusual_figures(task, whole);
        let own_mm = run.result.summary.max_correction_mm;
        let is_largest = does_cut && self.largest_correction_mm.is_none_or(|most| own_mm > most);
        if is_largest {
            (self.largest_correction_mm, self.of_correction) = (Some(own_mm), None);
        }
        for warning in &run.result.warnings {
            match warning.code {
                WarningCode::LoadNeverActs => self.never_acts = Some(warning.clone()),
                WarningCode::LargeCorrection | WarningCode::SmallCorrection if is_largest => {
                    self.of_correction = Some(warning.clone());
                }
                WarningCode::LargeCorrection
                | WarningCode::SmallCorrection
                | WarningCode::OddStiffness
                | WarningCode::NearLimit => {}
                _ => self.say(part, warning),
            }
        }
    }

    pub(crate) fn say(&mut self, part: usize, warning: &Warning) {
        let alike = |own: &Said| {
            own.warning.code == warning.code
                && (own.warning.line.is_none()
                    || own.warning.message == warning.message
                    || (own.part < part && same_words(&own.warning.message, &warning.message)))
        };
        match self.said.iter().position(alike) {
            None if self.said.len() < MOST => self.said.push(Said {
                warning: warning.clone(),
                part,
                further_lines: Vec::new(),
                further_parts: 0,
            }),
            None => self.further += 1,
            // Both parts at a seam see the same line.
            Some(index) => {
                let own = &mut self.said[index];
                let Some(line) = warning.line.filter(|line| own.warning.line < Some(*line)) else {
                    return;
                };
                own.further_parts += 1;
                if own.further_lines.len() < MOST_LINES && !own.further_lines.contains(&line) {
                    own.further_lines.push(line);
                }
            }
        }
    }

    /// All that is to be said of the whole.
    pub(crate) fn finish(self) -> Vec<Warning> {
        let of_whole = self.never_acts.filter(|_| !self.acts).into_iter();
        let mut all: Vec<Warning> = self.said.into_iter().map(Said::in_words).collect();
        all.extend(of_whole.chain(self.of_correction).chain(self.of_figures));
        if let Some(last) = all.last_mut().filter(|_| self.further > 0) {
            let more = format!("; and {} more warnings", self.further);
            last.message.push_str(&more);
        }
        all
    }
}

impl Said {
    fn in_words(self) -> Warning {
        let mut warning = self.warning;
        if self.further_parts > 0 {
            let lines: Vec<String> = self.further_lines.iter().map(usize::to_string).collect();
            let more = match self.further_parts > lines.len() {
                true => " and further ones",
                false => "",
            };
            let (word, times) = match (lines.len(), self.further_parts) {
                (1, 1) => ("line", "once more".to_owned()),
                (_, times) => ("lines", format!("{times} more times")),
            };
            warning.message.push_str(&format!(
                "; in later parts of the program {times}, at {word} {}{more}",
                lines.join(", ")
            ));
        }
        warning
    }
}

/// True if two messages differ only in their figures: the same words, whatever the numbers, units and plurals are.
pub(crate) fn same_words(one: &str, other: &str) -> bool {
    let words = |text: &str| -> Vec<String> {
        let all = text.split(|c: char| !(c.is_alphanumeric() || c == '_'));
        let all = all.map(|word| word.trim_end_matches('s'));
        let says = |word: &&str| word.chars().count() > 4 && !is_figure(word);
        all.filter(says).map(str::to_owned).collect()
    };
    words(one) == words(other)
}

/// A number, or a coordinate with its letter.
fn is_figure(word: &str) -> bool {
    let digits = word.trim_start_matches(|c: char| "XYZABC".contains(c));
    digits.chars().all(|c| c.is_ascii_digit())
}
