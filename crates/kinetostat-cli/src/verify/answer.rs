//! What `verify` answers.

use kinetostat_machining::{
    FeatureResult, FileRead, FlatProgram, MissedTolerance, PointResult, RunResult, Verified,
    Warning, farthest_off,
};
use kinetostat_report::{Language, Paper, VerifiedProgram};
use serde::Serialize;

use crate::verify::conditions;
use crate::verify::other_word::OtherWord;
use crate::verify::tilted::Tilted;

/// The answer of `verify`: lengths in mm, lines of the original and of the program.
#[derive(Debug, Serialize)]
pub(crate) struct VerifyAnswer {
    pub(crate) schema: u32,
    pub(crate) kinetostat_version: &'static str,
    /// The program that was verified, and the original.
    pub(crate) program: String,
    pub(crate) against: String,
    pub(crate) model: String,
    pub(crate) load: String,
    pub(crate) files: Vec<FileRead>,
    /// What is allowed in all.
    pub(crate) allowed_mm: f64,
    pub(crate) held: bool,
    /// Where it is missed most.
    pub(crate) missed: Option<MissedTolerance>,
    /// Largest distance of the tool from where it should be, along the program and along the original as it is.
    pub(crate) max_position_error_mm: f64,
    pub(crate) rms_position_error_mm: f64,
    pub(crate) max_position_error_of_original_mm: f64,
    pub(crate) rms_position_error_of_original_mm: f64,
    pub(crate) max_residual_rotation_deg: f64,
    pub(crate) stable: bool,
    pub(crate) points: usize,
    /// How the program belongs to its original.
    pub(crate) matched: kinetostat_machining::Matched,
    /// The forces come from the cut, so that other feeds and speeds are other forces.
    pub(crate) forces_from_cut: bool,
    /// Words that one of both programs has and the other does not, by which the control moves its places.
    pub(crate) other_words: Vec<OtherWord>,
    /// Where the tool stands otherwise than it should, if its orientation is corrected.
    pub(crate) tilted: Option<Tilted>,
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
        (program, against): (&str, &str),
        files: Vec<FileRead>,
        allowed_mm: f64,
        (forces_from_cut, other_words): (bool, Vec<OtherWord>),
        tilted: Option<Tilted>,
        flat_original: Option<FlatProgram>,
    ) -> Self {
        let result = &verified.run.result;
        let s = &result.summary;
        let points = &verified.run.points;
        let worst = farthest_off(points).into_iter();
        let worst_points: Vec<PointResult> = worst.map(|i| points[i].clone()).collect();
        let within = s.max_position_error_after_mm <= allowed_mm;
        let matched = &verified.matched;
        let whole =
            matched.uncut.is_empty() && matched.rapids.is_empty() && matched.extra_cuts.is_empty();
        let mut conditions = matched.conditions.iter();
        let is_same = !conditions.any(|other| conditions::is_fault(other, forces_from_cut))
            && other_words.iter().all(|word| word.fault.is_none());
        let mut warnings = result.warnings.clone();
        warnings.extend(conditions::warnings(
            &matched.conditions,
            &other_words,
            forces_from_cut,
            |line| source_of(flat_original.as_ref(), line),
        ));
        Self {
            schema: 1,
            kinetostat_version: env!("CARGO_PKG_VERSION"),
            program: program.to_owned(),
            against: against.to_owned(),
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
            features: result.features.clone(),
            worst_points,
            warnings,
            flat_original,
        }
    }

    /// What stands behind a line of the original: nothing, or where it came from.
    pub(crate) fn source(&self, line: usize) -> String {
        source_of(self.flat_original.as_ref(), line)
    }

    /// The run as a paper has it: what was verified is its program, with what it says of its tolerance.
    pub(crate) fn as_run(&self, verified: &Verified) -> RunResult {
        let mut run = verified.run.result.clone();
        run.run_inputs.program.clone_from(&self.program);
        run.run_inputs.files.clone_from(&self.files);
        // Files of the original follow behind the first one, which is that of the program.
        if let Some(first) = run.run_inputs.files.first_mut() {
            first.what = "verified program".to_owned();
        }
        run.run_inputs.tolerance_mm = self.allowed_mm;
        run.run_inputs.chord_tolerance_mm = 0.0;
        run.summary.max_rounding_error_mm = 0.0;
        run.tolerance.allowed_mm = self.allowed_mm;
        run.tolerance.held = Some(self.missed.is_none());
        run.tolerance.missed.clone_from(&self.missed);
        run.worst_points.clone_from(&self.worst_points);
        run
    }

    /// Its paper.
    pub(crate) fn paper<'a>(&self, run: &'a RunResult, language: Language) -> Paper<'a> {
        let uncut = self.matched.uncut.iter();
        let rapids = self.matched.rapids.iter();
        let extra = self.matched.extra_cuts.iter();
        let in_file = |line: usize| match &self.flat_original {
            // Of files that are called the paper has the lines as they were run.
            Some(flat) => match flat.source_of(line) {
                Some((file, source)) if flat.files.first().is_some_and(|own| own == file) => source,
                _ => line,
            },
            None => line,
        };
        Paper::of(run)
            .in_language(language)
            .of_verified(VerifiedProgram {
                original: self.against.clone(),
                held: self.held,
                allowed_mm: self.allowed_mm,
                uncut: uncut
                    .map(|uncut| (uncut.lines.map(in_file), uncut.length_mm))
                    .collect(),
                rapids: rapids
                    .map(|rapid| (rapid.line, rapid.distance_mm))
                    .collect(),
                extra_cuts: extra.map(|cut| (cut.line, cut.length_mm)).collect(),
                other_words: self.lines_of_other_words(),
            })
    }

    /// Lines of the program with another feed, spindle, tool or frame, where that is a fault.
    fn lines_of_other_words(&self) -> Vec<usize> {
        let conditions = self.matched.conditions.iter();
        let conditions = conditions
            .filter(|other| conditions::is_fault(other, self.forces_from_cut))
            .map(|other| other.lines[0]);
        let words = self.other_words.iter().filter(|word| word.fault.is_some());
        let words = words.map(|word| word.line.unwrap_or(1));
        conditions.chain(words).collect()
    }
}

/// Where a line of a program that was run came from.
fn source_of(flat: Option<&FlatProgram>, line: usize) -> String {
    let source = flat.and_then(|flat| flat.source_of(line));
    source.map_or_else(String::new, |(file, from)| {
        format!(" (line {from} of {file})")
    })
}
