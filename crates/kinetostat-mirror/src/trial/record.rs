//! Record of a trial.

use serde::{Deserialize, Serialize};

use crate::deviation::DeviationFigures;
use crate::trial::convergence::Convergence;

/// A file of measured points.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
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
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
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
