//! The answer of `mirror`, stable names with units.

use kinetostat_mirror::{
    Convergence, DeviationFigures, LeftOut, Measurement, MirrorState, Outcome, Outlier, Register,
    Registration, Repeatability, ToldBy, Unseen,
};
use kinetostat_program::Accounting;
use serde::Serialize;

use crate::mirror::features::FeatureMeasured;

#[derive(Serialize)]
pub(crate) struct MirrorAnswer {
    pub(crate) schema: u32,
    pub(crate) kinetostat_version: &'static str,
    pub(crate) program: String,
    pub(crate) model: Option<String>,
    pub(crate) trial: usize,
    pub(crate) relaxation: f64,
    pub(crate) smoothing_mm: f64,
    pub(crate) register: Register,
    pub(crate) outcome: Outcome,
    pub(crate) measurements: Vec<MeasurementResult>,
    /// Smoothed deviation of the mean of all measurements, root mean square.
    pub(crate) left_mm: f64,
    pub(crate) floor_mm: Option<f64>,
    pub(crate) left_in_trials_mm: Vec<f64>,
    pub(crate) convergence: Option<Convergence>,
    /// True if it was seen that the last correction was in the program that was measured.
    pub(crate) shows_correction: Option<bool>,
    /// True if the program was said to have been run (`--was-run`).
    pub(crate) was_run: bool,
    pub(crate) largest_correction_mm: f64,
    pub(crate) accounting: Accounting,
}

#[derive(Serialize)]
pub(crate) struct MeasurementResult {
    pub(crate) file: String,
    pub(crate) registration: Option<RegistrationResult>,
    pub(crate) figures: DeviationFigures,
    /// Ratio of a point's scatter to the stated repeatability, if it is more than two.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) scatter_of_repeatability: Option<f64>,
    pub(crate) outliers: Vec<Outlier>,
    /// Rows beside a corner that may belong to its other leg.
    pub(crate) beside_corners: Vec<usize>,
    pub(crate) left_out: Vec<LeftOut>,
    pub(crate) unseen: Vec<Unseen>,
    /// Features of the job.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(crate) features: Vec<FeatureMeasured>,
}

/// Motion from the frame of the measurement to that of the program.
#[derive(Serialize)]
pub(crate) struct RegistrationResult {
    pub(crate) rotation_vector_deg: [f64; 3],
    pub(crate) shift_mm: [f64; 3],
    pub(crate) scale: f64,
    /// Evidence that distinguished the motion from others.
    pub(crate) told_by: ToldBy,
    /// Motions that the points do not determine, in words.
    pub(crate) free: Vec<String>,
    /// Largest way by which it moves a point that counts.
    pub(crate) moved_mm: f64,
    pub(crate) scatter_mm: f64,
    pub(crate) rejected_rows: Vec<usize>,
}

impl From<&Registration> for RegistrationResult {
    fn from(found: &Registration) -> Self {
        let turn = found.motion.rotation.scaled_axis();
        Self {
            rotation_vector_deg: turn.map(f64::to_degrees).into(),
            shift_mm: found.motion.shift_mm.into(),
            scale: found.motion.scale,
            told_by: found.told_by,
            free: found.free.iter().map(ToString::to_string).collect(),
            moved_mm: found.moved_mm,
            scatter_mm: found.deviation_mm,
            rejected_rows: found.rejected_rows.clone(),
        }
    }
}

/// Points that scatter by so many times the repeatability stated are not what was stated: with the fewest neighbours that a
/// scatter is taken from it comes out twice as large by chance once in some hundred times.
const TIMES: f64 = 2.0;

/// Ratio of the scatter to the stated repeatability, if it is known to be too large. The kinks of a program that follows its
/// correction within a tolerance are of about that size: they are no scatter of the measurement.
fn scatter_of_repeatability(found: &Measurement, stated: Option<Repeatability>) -> Option<f64> {
    let times = match stated {
        Some(Repeatability::OfPoints(sigma_mm)) => found.figures.scatter_mm / sigma_mm,
        _ => return None,
    };
    let beyond_known = found.figures.scatter_mm > TIMES * found.known_to_mm;
    (times > TIMES && beyond_known && !found.figures.scatter_has_bends).then_some(times)
}

impl MeasurementResult {
    pub(crate) fn of(
        file: &str,
        (found, stated): (&Measurement, Option<Repeatability>),
        features: Vec<FeatureMeasured>,
    ) -> Self {
        Self {
            scatter_of_repeatability: scatter_of_repeatability(found, stated),
            file: file.to_owned(),
            registration: found.registration.as_ref().map(Into::into),
            figures: found.figures,
            outliers: found.outliers.clone(),
            beside_corners: found.beside_corners.clone(),
            left_out: found.left_out.clone(),
            unseen: found.unseen.clone(),
            features,
        }
    }
}

/// The largest correction of a state, mm.
pub(crate) fn largest_correction_mm(state: &MirrorState) -> f64 {
    let sizes = state.correction_mm.iter().map(nalgebra::Vector3::norm);
    sizes.fold(0.0, kinetostat::number::larger)
}
