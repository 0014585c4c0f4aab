//! A verification on paper.

use kinetostat_machining::{RunResult, Verified, Warning, WarningCode};
use kinetostat_report::{Language, Paper, VerifiedProgram};

use crate::verify::answer::VerifyAnswer;

impl VerifyAnswer {
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
        run.warnings.clone_from(&self.warnings);
        let others = self.faults_of_words().into_iter();
        let others = others.map(|text| Warning::new(WarningCode::OtherThanOriginal, text));
        run.warnings.splice(0..0, others);
        run.assess();
        run
    }

    /// Report on paper.
    pub(crate) fn paper<'a>(&self, run: &'a RunResult, language: Language) -> Paper<'a> {
        let uncut = self.matched.uncut.iter();
        let rapids = self.matched.rapids.iter();
        let extra = self.matched.extra_cuts.iter();
        let in_file = |line: usize| match &self.flat_original {
            // Lines of called files are numbered as they were run.
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
        let words = self.other_words.iter().filter(|word| word.fault.is_some());
        words.map(|word| word.line.unwrap_or(1)).collect()
    }
}
