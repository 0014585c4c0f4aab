//! Selection of the measurements that a trial takes.

use kinetostat_program::WhyLeftOut;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::alignment::LeftOut;
use crate::deviation::{DeviationFigures, Measurement};
use crate::error::MirrorError;
use crate::trial::convergence::Convergence;
use crate::trial::machined::Seen;

/// Measurements that no trial has taken yet, this one included: one that comes twice says nothing of how trials repeat.
pub(crate) fn are_new(
    trials: &[Trial],
    measured: &[(MeasuredFile, Measurement)],
) -> Result<(), MirrorError> {
    let taken = trials.iter().flat_map(|trial| &trial.measured);
    for (k, (file, _)) in measured.iter().enumerate() {
        let same = |other: &&MeasuredFile| other.sha256 == file.sha256;
        if let Some(before) = taken.clone().find(same) {
            return Err(MirrorError::new(format!(
                "{} is the measurement {} of an earlier trial, point for point: measure the program with its new correction",
                file.name, before.name
            )));
        }
        if let Some(first) = measured[..k].iter().map(|(file, _)| file).find(same) {
            return Err(MirrorError::new(format!(
                "{} and {} are one measurement, point for point: give it once, and measure the trial again for a second one",
                first.name, file.name
            )));
        }
    }
    Ok(())
}

/// Checks that measurements may be of the program with the last correction: those of the program without it would have it corrected
/// twice. Returns true if they show it. Measurements of a program that `was_run` for certain are not refused.
pub(crate) fn may_show_the_correction(
    measured: &[(MeasuredFile, Measurement)],
    trials: &[Trial],
    seen: &Seen,
    was_run: bool,
) -> Result<bool, MirrorError> {
    if was_run || !seen.is_missing() {
        return Ok(seen.is_there());
    }
    let names: Vec<&str> = measured
        .iter()
        .map(|(file, _)| file.name.as_str())
        .collect();
    Err(MirrorError::new(format!(
        "{}: nothing is seen of the correction that trial {} wrote ({:.1} +- {:.1} % of it): the program before it seems to have been run or measured once more, and it would be corrected twice; nothing was mirrored. Measure the new program (all measurements of one trial are given together). Where it was run, the machine drifts from trial to trial by as much as is corrected: let it come to rest, or go on with --was-run",
        names.join(", "),
        trials.len(),
        100.0 * seen.answer,
        100.0 * seen.known_to
    )))
}

/// Measurements most of whose points have a place on the path: a few that found one by chance are nothing to correct by.
pub(crate) fn have_places(measured: &[(MeasuredFile, Measurement)]) -> Result<(), MirrorError> {
    for (file, found) in measured {
        let without = &found.left_out;
        let with = found.points.len() + found.outliers.len() + found.beside_corners.len();
        if without.len() > with {
            return Err(MirrorError::new(format!(
                "{}: {} of its {} points have no place on the path ({}); nothing was mirrored. {}, and leave out points that are not of this path",
                file.name,
                without.len(),
                without.len() + with,
                counted(without),
                what_to_do(without)
            )));
        }
    }
    Ok(())
}

const REASONS: [(WhyLeftOut, &str, &str); 4] = [
    (
        WhyLeftOut::OutOfOrder,
        "behind the points before them",
        "Give them in the order in which the tool went, or align each with its nearest place",
    ),
    (
        WhyLeftOut::BeyondWindow,
        "beyond the window",
        "Check units and frame, register the points, or widen the window",
    ),
    (
        WhyLeftOut::NotOnItsLine,
        "not on the cut of the line that they name",
        "Check the column line: it has numbers of lines of the program that cut at feed",
    ),
    (
        WhyLeftOut::SeveralStretches,
        "where several passes of the tool come by",
        "Align them by arc length in the order in which the tool went, name the line of each, or make the window smaller",
    ),
];

fn number_of(without: &[LeftOut], why: WhyLeftOut) -> usize {
    without.iter().filter(|point| point.why == why).count()
}

fn counted(without: &[LeftOut]) -> String {
    let all = REASONS.map(|(why, words, _)| (number_of(without, why), words));
    let named = all.iter().filter(|(count, _)| *count > 0);
    let named: Vec<String> = named
        .map(|(count, words)| format!("{count} {words}"))
        .collect();
    named.join(", ")
}

/// Remedy against the most frequent reason.
fn what_to_do(without: &[LeftOut]) -> &'static str {
    let most = REASONS
        .iter()
        .max_by_key(|(why, ..)| number_of(without, *why));
    most.map_or("", |(_, _, advice)| advice)
}

/// A file of measured points.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema, Deserialize)]
pub struct MeasuredFile {
    /// Name of the file.
    pub name: String,
    /// [`MeasuredPoints::sha256`](crate::MeasuredPoints::sha256): of its points, not of its text.
    pub sha256: String,
}

/// States without the word are of trials that were mirrored, or of the last one.
fn yes() -> bool {
    true
}

/// Record of a trial: the measurement of the program with the correction before, and its outcome.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema, Deserialize)]
pub struct Trial {
    /// Number from 1; trial 1 is the program without a correction by measurement.
    pub number: usize,
    /// The measurements.
    pub measured: Vec<MeasuredFile>,
    /// Share of the deviation that was mirrored.
    pub relaxation: f64,
    /// True if the correction was changed by it: not if nothing was left to correct.
    #[serde(default = "yes")]
    pub mirrored: bool,
    /// Sizes, of the first measurement where there are several.
    pub figures: DeviationFigures,
    /// Root mean square of the smoothed deviation, of the mean of all measurements, mm.
    pub left_mm: f64,
    /// Noise floor of the smoothed deviation, mm, if the repeatability is known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub floor_mm: Option<f64>,
    /// Convergence from the trial before.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub convergence: Option<Convergence>,
    /// True if the measurement shows that the program had the last correction in it; `None` if there was no correction.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shows_correction: Option<bool>,
}
