//! Features of a part: ranges of lines with a name and a tolerance of their own, and how a run stands to them.

use kinetostat::number::{against, largest_length, mean_length};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::result::point::{PointKind, PointResult, size};

/// A feature of the part: lines of the program that cut it.
#[derive(Clone, Debug, PartialEq)]
pub struct Feature {
    /// Name, as the user calls it.
    pub name: String,
    /// First and last line of the program.
    pub lines: [usize; 2],
    /// Maximum error of the tool there, mm; `None` if that of the whole program applies.
    pub tolerance_mm: Option<f64>,
}

/// Result of a run for a feature.
#[derive(Clone, Debug, Default, PartialEq, Serialize, JsonSchema, Deserialize)]
#[non_exhaustive]
pub struct FeatureResult {
    /// Name of the feature.
    pub name: String,
    /// First and last line of the program.
    pub lines: [usize; 2],
    /// Places at feed that were solved there.
    pub points: usize,
    /// Largest distance of the tool from where it should be in the original program, mm; `None` if nothing is cut.
    pub error_before_mm: Option<f64>,
    /// Largest error of the program that was written or verified; `None` if there is none.
    pub error_after_mm: Option<f64>,
    /// Line of the largest error: of the written or verified program where there is one.
    pub worst_line: Option<usize>,
    /// Allowed error, mm.
    pub allowed_mm: f64,
    /// True if that is kept: by the written or verified program if there is one, else by the original. `None` if nothing is
    /// cut.
    pub held: Option<bool>,
    /// First and last line of what a verified program does not cut of it; `None` if it cuts all of it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub uncut: Option<[usize; 2]>,
}

impl FeatureResult {
    /// Results of features before the first point.
    #[must_use]
    pub fn without_points(features: &[Feature]) -> Vec<Self> {
        let of = |feature: &Feature| Self {
            name: feature.name.clone(),
            lines: feature.lines,
            ..Self::default()
        };
        features.iter().map(of).collect()
    }
}

/// Results of a run for features: `points` are those of the whole run, `line_of` the line of the user's program that a point
/// belongs to, `allowed_mm` the tolerance of features that state none. `written` says whether there is a second program.
///
/// ```
/// use kinetostat_machining::{Feature, feature_results};
///
/// let pocket = Feature { name: "pocket".into(), lines: [4, 9], tolerance_mm: Some(0.05) };
/// let found = feature_results(&[pocket], &[], |point| Some(point.line), 0.1, true);
/// // No point, no verdict.
/// assert_eq!((found[0].points, found[0].held), (0, None));
/// ```
pub fn feature_results(
    features: &[Feature],
    points: &[PointResult],
    line_of: impl Fn(&PointResult) -> Option<usize>,
    allowed_mm: f64,
    written: bool,
) -> Vec<FeatureResult> {
    let mut results = FeatureResult::without_points(features);
    add_to_features(&mut results, points, line_of, written);
    judge_features(&mut results, features, allowed_mm, written);
    results
}

/// Takes the next points of a run into what was found of features, which begins as [`FeatureResult::without_points`]; the other
/// arguments are those of [`feature_results`].
pub fn add_to_features(
    results: &mut [FeatureResult],
    points: &[PointResult],
    line_of: impl Fn(&PointResult) -> Option<usize>,
    written: bool,
) {
    for point in points.iter().filter(|p| p.kind != PointKind::Rapid) {
        let Some(line) = line_of(point) else { continue };
        let inside = |result: &&mut FeatureResult| {
            let [first, last] = result.lines;
            (first..=last).contains(&line)
        };
        for result in results.iter_mut().filter(inside) {
            result.points += 1;
            let before = size(&point.error_before_mm);
            // Only a second program has steps.
            if !point.kind.is_step() {
                note(&mut result.error_before_mm, before);
            }
            let (most, own) = match written {
                true => (&mut result.error_after_mm, size(&point.error_after_mm)),
                false => (&mut result.error_before_mm, before),
            };
            let is_worst = result.worst_line.is_none() || most.is_none_or(|most| own >= most);
            note(most, own);
            if is_worst {
                result.worst_line = Some(match written {
                    true => point.output_line,
                    false => line,
                });
            }
        }
    }
}

/// The verdicts, once all points were taken.
pub fn judge_features(
    results: &mut [FeatureResult],
    features: &[Feature],
    allowed_mm: f64,
    written: bool,
) {
    for (result, feature) in results.iter_mut().zip(features) {
        result.allowed_mm = feature.tolerance_mm.unwrap_or(allowed_mm);
        let counts = match written {
            true => result.error_after_mm,
            false => result.error_before_mm,
        };
        // NaN keeps no tolerance.
        result.held = counts.map(|mm| mm <= result.allowed_mm);
    }
}

/// The larger of both; NaN stays.
fn note(most: &mut Option<f64>, own: f64) {
    if most.is_none_or(|most| own > most || own.is_nan()) {
        *most = Some(own);
    }
}

impl FeatureResult {
    /// Takes lines of it that a verified program does not cut: then it is not kept, however near the tool is on the others.
    pub fn leave_out(&mut self, line: usize) {
        let [first, last] = self.lines;
        if !(first..=last).contains(&line) {
            return;
        }
        let [from, to] = self.uncut.unwrap_or([line, line]);
        self.uncut = Some([from.min(line), to.max(line)]);
        self.held = Some(false);
    }

    /// Sentence for a missed tolerance, with place and amount; `None` if it is kept.
    #[must_use]
    pub fn missed_text(&self) -> Option<String> {
        if self.held != Some(false) {
            return None;
        }
        if let Some([first, last]) = self.uncut {
            let lines = match first == last {
                true => format!("line {first} of the original"),
                false => format!("lines {first} to {last} of the original"),
            };
            return Some(format!(
                "THE FEATURE {} IS NOT CUT by this program at {lines}.",
                self.name
            ));
        }
        let error_mm = self.error_after_mm.or(self.error_before_mm)?;
        let (error, allowed) = against(error_mm, self.allowed_mm);
        let of = match self.error_after_mm {
            Some(_) => "of the written program",
            None => "of the program",
        };
        Some(format!(
            "THE TOLERANCE OF {} IS MISSED at line {} {of}: the tool is {error} off, more than the {allowed} that are allowed.",
            self.name,
            self.worst_line.unwrap_or(0)
        ))
    }

    /// Row of a table: name, lines, error before, error after, allowed error, verdict.
    #[must_use]
    pub fn cells(&self) -> [String; 6] {
        let length = |mm: Option<f64>| mm.map_or_else(String::new, largest_length);
        let [first, last] = self.lines;
        let allowed = match self.error_after_mm.or(self.error_before_mm) {
            Some(error_mm) => against(error_mm, self.allowed_mm).1,
            None => mean_length(self.allowed_mm),
        };
        [
            self.name.clone(),
            match first == last {
                true => first.to_string(),
                false => format!("{first} to {last}"),
            },
            length(self.error_before_mm),
            length(self.error_after_mm),
            allowed,
            match self.held {
                _ if self.uncut.is_some() => "NOT CUT".to_owned(),
                Some(true) => "kept".to_owned(),
                Some(false) => "MISSED".to_owned(),
                None => "nothing is cut".to_owned(),
            },
        ]
    }
}
