//! Answer of `verify`.

use kinetostat_machining::{
    Assessment, FeatureResult, FileRead, FlatProgram, MissedTolerance, PointResult, Verified,
    Warning, WarningCode, farthest_off,
};
use schemars::JsonSchema;
use serde::Serialize;

use crate::job::setting::Setting;
use crate::verify::other_language::SPINDLE;
use crate::verify::other_word::OtherWord;
use crate::verify::tilted::Tilted;

/// The answer of `verify`: lengths in mm, lines of the original and of the program.
#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct VerifyAnswer {
    pub(crate) schema: u32,
    pub(crate) kinetostat_version: &'static str,
    /// The program that was verified, and the original.
    pub(crate) program: String,
    pub(crate) against: String,
    pub(crate) model: String,
    pub(crate) load: String,
    pub(crate) files: Vec<FileRead>,
    /// Total allowed error.
    pub(crate) allowed_mm: f64,
    pub(crate) held: bool,
    /// Place of the largest violation.
    pub(crate) missed: Option<MissedTolerance>,
    /// Largest distance of the tool from where it should be, along the program and along the original as it is.
    pub(crate) max_position_error_mm: f64,
    pub(crate) rms_position_error_mm: f64,
    pub(crate) max_position_error_of_original_mm: f64,
    pub(crate) rms_position_error_of_original_mm: f64,
    pub(crate) max_residual_rotation_deg: f64,
    pub(crate) stable: bool,
    pub(crate) points: usize,
    /// Match of the program with its original.
    pub(crate) matched: kinetostat_machining::Matched,
    /// The forces come from the cut, so that other feeds and speeds are other forces.
    pub(crate) forces_from_cut: bool,
    /// Words that one of both programs has and the other does not, by which the control moves its places.
    pub(crate) other_words: Vec<OtherWord>,
    /// Place at which the tool is tilted, if its orientation is corrected.
    pub(crate) tilted: Option<Tilted>,
    /// Basis of the verdict, as for a program that is compensated.
    pub(crate) assessment: Assessment,
    pub(crate) features: Vec<FeatureResult>,
    /// Places where the program is farthest off, worst first; at most ten.
    pub(crate) worst_points: Vec<PointResult>,
    pub(crate) warnings: Vec<Warning>,
    /// The original as it was run, where that is another text than its file.
    #[serde(skip)]
    pub(crate) flat_original: Option<FlatProgram>,
}

impl VerifyAnswer {
    pub(crate) fn of(
        verified: &Verified,
        program: &Setting,
        original: &Setting,
        allowed_mm: f64,
        forces_from_cut: bool,
        other_words: Vec<OtherWord>,
        tilted: Option<Tilted>,
    ) -> Self {
        let result = &verified.run.result;
        let mut files = program.program_files.clone();
        files.extend(result.run_inputs.files.iter().cloned());
        let s = &result.summary;
        let points = &verified.run.points;
        let worst = farthest_off(points).into_iter();
        let worst_points: Vec<PointResult> = worst.map(|i| points[i].clone()).collect();
        let within = s.max_position_error_after_mm <= allowed_mm;
        let matched = &verified.matched;
        let whole =
            matched.uncut.is_empty() && matched.rapids.is_empty() && matched.extra_cuts.is_empty();
        let is_same = other_words.iter().all(|word| word.fault.is_none());
        let mut warnings = result.warnings.clone();
        let named = other_words.iter().filter(|word| word.fault.is_none());
        warnings.extend(named.map(|word| {
            let code = match word.word == SPINDLE {
                true => WarningCode::SpindleNotStarted,
                false => WarningCode::OtherThanOriginal,
            };
            Warning::new(code, word.text.clone())
        }));
        Self {
            schema: 1,
            kinetostat_version: env!("CARGO_PKG_VERSION"),
            program: program.program_name.clone(),
            against: original.program_name.clone(),
            model: result.run_inputs.model.clone(),
            load: result.run_inputs.load.clone(),
            files,
            allowed_mm,
            held: within
                && whole
                && is_same
                && tilted.is_none()
                && s.stable
                && result.features.iter().all(|f| f.held != Some(false)),
            missed: worst_points
                .first()
                .filter(|_| !within)
                .map(|p| MissedTolerance::at(p, String::new())),
            max_position_error_mm: s.max_position_error_after_mm,
            rms_position_error_mm: s.rms_position_error_after_mm,
            max_position_error_of_original_mm: s.max_position_error_before_mm,
            rms_position_error_of_original_mm: s.rms_position_error_before_mm,
            max_residual_rotation_deg: s.max_residual_rotation_deg,
            stable: s.stable,
            points: s.points,
            matched: verified.matched.clone(),
            forces_from_cut,
            other_words,
            tilted,
            assessment: Assessment::default(),
            features: result.features.clone(),
            worst_points,
            warnings,
            flat_original: original.flat.clone().filter(|_| original.robot.is_none()),
        }
    }

    /// Origin of a line of the original, as text; empty if it was not expanded.
    pub(crate) fn source(&self, line: usize) -> String {
        source_of(self.flat_original.as_ref(), line)
    }
}

/// Origin of a line of a program that was run once, as text.
pub(crate) fn source_of(flat: Option<&FlatProgram>, line: usize) -> String {
    let source = flat.and_then(|flat| flat.source_of(line));
    source.map_or_else(String::new, |(file, from)| {
        format!(" (line {from} of {file})")
    })
}
