//! Results of a run at the features of its job.

use kinetostat_diagnostic::ErrorCode;
use kinetostat_machining::{
    FeatureResult, PointResult, Run, RunResult, Warning, WarningCode, feature_results,
};

use crate::job::setting::Setting;
use crate::ui::failure::{Answer, Failing};
use crate::ui::layout::columns;

/// Puts what was found of the features into a run; `allowed_mm` counts for those without a tolerance, and `uncut` are the lines of cuts
/// that a verified program leaves out.
pub(crate) fn put_features(run: &mut Run, setting: &Setting, allowed_mm: f64, uncut: &[usize]) {
    // Lines are those of the user's file: of an expanded program the one that a flat line came from.
    let own_file = setting.program_path.file_name();
    let own_file = own_file.map(|name| name.to_string_lossy().into_owned());
    let line_of = |line: usize| match &setting.flat {
        None => Some(line),
        Some(flat) => flat
            .source_of(line)
            .filter(|(file, _)| Some(*file) == own_file.as_deref())
            .map(|(_, line)| line),
    };
    let written = run.written.is_some();
    let of_point = |point: &PointResult| line_of(point.line);
    let mut found = feature_results(
        &setting.features,
        &run.points,
        of_point,
        allowed_mm,
        written,
    );
    for line in uncut.iter().copied().filter_map(line_of) {
        for feature in &mut found {
            feature.leave_out(line);
        }
    }
    put_found(&mut run.result, found);
}

/// Puts what was found of the features into a result, and says of which there is nothing to say.
pub(crate) fn put_found(result: &mut RunResult, found: Vec<FeatureResult>) {
    let empty = |feature: &&FeatureResult| feature.points == 0 && feature.uncut.is_none();
    for feature in found.iter().filter(empty) {
        let [first, last] = feature.lines;
        result.warnings.push(Warning::new(
            WarningCode::EmptyFeature,
            format!(
                "the feature {}, lines {first} to {last}: nothing is cut there, so that nothing can be said of it; compare its lines with the program",
                feature.name
            ),
        ));
    }
    result.features = found;
    result.assess();
}

/// A table of features, or nothing.
pub(crate) fn features_text(features: &[FeatureResult]) -> String {
    if features.is_empty() {
        return String::new();
    }
    let written = features.iter().any(|f| f.error_after_mm.is_some());
    let row = |cells: [String; 6]| {
        let [name, lines, before, after, allowed, verdict] = cells;
        match written {
            true => vec![name, lines, before, after, allowed, verdict],
            false => vec![name, lines, before, allowed, verdict],
        }
    };
    let head = ["feature", "lines", "before", "after", "allowed", ""].map(str::to_owned);
    let rows = std::iter::once(head).chain(features.iter().map(FeatureResult::cells));
    format!("\n{}", columns(&rows.map(row).collect::<Vec<_>>(), 2))
}

/// A feature whose tolerance is missed has the exit code of a missed tolerance; files are in place.
pub(crate) fn refuse_missed_features(features: &[FeatureResult], setting: &Setting) -> Answer<()> {
    let missed: Vec<String> = features
        .iter()
        .filter_map(FeatureResult::missed_text)
        .collect();
    match missed.is_empty() {
        true => Ok(()),
        false => Err(setting.within(ErrorCode::ToleranceMissed.failure(missed.join("\n")))),
    }
}
