//! The answer of `mirror`, stable names with units.

use kinetostat_machining::Feature;
use kinetostat_machining::number::largest_length;
use kinetostat_mirror::{
    Convergence, DeviationFigures, LeftOut, Measurement, MirrorState, NominalPath, OnLines,
    Outcome, Outlier, Register, Registration, Repeatability, ToldBy, Unseen, on_lines,
};
use kinetostat_program::Accounting;
use schemars::JsonSchema;
use serde::Serialize;

use crate::ui::layout::item;
use crate::ui::numbers::short;

#[derive(Serialize, JsonSchema)]
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

#[derive(Serialize, JsonSchema)]
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
#[derive(Serialize, JsonSchema)]
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
        found: &Measurement,
        stated: Option<Repeatability>,
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

/// A feature of the part as it was measured: before the correction of this trial.
#[derive(Serialize, JsonSchema)]
pub(crate) struct FeatureMeasured {
    pub(crate) name: String,
    pub(crate) lines: [usize; 2],
    #[serde(flatten)]
    pub(crate) found: OnLines,
    /// Tolerance of the feature, mm; none if the job states none.
    pub(crate) allowed_mm: Option<f64>,
    /// True if the smoothed deviation keeps it; none without points, a tolerance, or on a part of it without points.
    pub(crate) held: Option<bool>,
}

/// Features of a job in a measurement.
pub(crate) fn of_features(
    features: &[Feature],
    nominal: &NominalPath<'_>,
    measured: &Measurement,
    smoothing_mm: f64,
) -> Vec<FeatureMeasured> {
    let one = |feature: &Feature| {
        let found = on_lines(nominal, measured, feature.lines, smoothing_mm);
        let held = found.smoothed_largest_mm.zip(feature.tolerance_mm);
        // Unmeasured points may be worse: a partly measured feature is never kept, but can be missed.
        let held = held.map(|(most, allowed)| most <= allowed);
        FeatureMeasured {
            name: feature.name.clone(),
            lines: feature.lines,
            allowed_mm: feature.tolerance_mm,
            held: held.filter(|held| !held || found.unseen_mm == 0.0),
            found,
        }
    };
    features.iter().map(one).collect()
}

impl FeatureMeasured {
    /// Describes the result, as an item of a list.
    pub(crate) fn text(&self) -> String {
        let [first, last] = self.lines;
        let name = format!("{} (lines {first} to {last})", self.name);
        let f = &self.found;
        let Some((most, raw)) = f.smoothed_largest_mm.zip(f.largest_mm) else {
            return item(&match f.length_mm > 0.0 {
                true => format!(
                    "{name}: NO POINT WAS MEASURED on its {} mm; nothing is known of it",
                    short(f.length_mm)
                ),
                false => format!("{name}: no feed move lies there; nothing can be measured"),
            });
        };
        let verdict = match (self.allowed_mm, self.held) {
            (Some(allowed), Some(true)) => format!(", within {}", largest_length(allowed)),
            (Some(allowed), Some(false)) => {
                format!(", MORE THAN THE {} ALLOWED", largest_length(allowed))
            }
            _ => String::new(),
        };
        let unseen = match f.unseen_mm > 0.0 {
            true => format!(
                "; {} mm of its {} mm are farther than the smoothing length from every point",
                short(f.unseen_mm),
                short(f.length_mm)
            ),
            false => String::new(),
        };
        item(&format!(
            "{name}: {} points, at most {} from the path, {} after smoothing{verdict}{unseen}",
            f.points,
            largest_length(raw),
            largest_length(most)
        ))
    }
}
