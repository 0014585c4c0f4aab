//! Measured deviations at the features of a job.

use kinetostat_machining::Feature;
use kinetostat_machining::number::largest_length;
use kinetostat_mirror::{Measurement, NominalPath, OnLines, on_lines};
use serde::Serialize;

use crate::ui::layout::item;
use crate::ui::numbers::short;

/// A feature of the part as it was measured: before the correction of this trial.
#[derive(Serialize)]
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
    (nominal, measured): (&NominalPath<'_>, &Measurement),
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
