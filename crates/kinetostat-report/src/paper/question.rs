//! Request for a paper.

use kinetostat_machining::{FileRead, RunResult};

use crate::MachineShown;
use crate::paper::language::Language;

/// Request for a paper on a run.
///
/// ```
/// use kinetostat_machining::RunResult;
/// use kinetostat_report::{Language, Paper};
///
/// let result = RunResult::default();
/// let page = Paper::of(&result).in_language(Language::German).html();
/// assert!(page.contains("Unterschrift"));
/// ```
#[derive(Clone, Debug)]
pub struct Paper<'a> {
    pub(crate) result: &'a RunResult,
    pub(crate) language: Language,
    pub(crate) written: Vec<FileRead>,
    pub(crate) verified: Option<VerifiedProgram>,
    pub(crate) machine: Option<&'a MachineShown>,
}

/// Results of `verify` in addition to a run: the run's errors before are those of the original, its errors after those
/// of the program.
#[derive(Clone, Debug, Default)]
pub struct VerifiedProgram {
    /// File name of the original.
    pub original: String,
    /// True if the program passes.
    pub held: bool,
    /// Total tolerance, mm.
    pub allowed_mm: f64,
    /// Lines of the original that are not cut, first and last, with their length, mm.
    pub uncut: Vec<([usize; 2], f64)>,
    /// Lines of its rapids that go elsewhere than those of the original, with how far, mm.
    pub rapids: Vec<(usize, f64)>,
    /// Lines of its moves at feed that the original does not make, with their length, mm.
    pub extra_cuts: Vec<(usize, f64)>,
    /// Lines of it with another feed, spindle, tool or frame than the original, where that is a fault.
    pub other_words: Vec<usize>,
}

impl<'a> Paper<'a> {
    /// Creates a paper on a run, in English.
    #[must_use]
    pub fn of(result: &'a RunResult) -> Self {
        Self {
            result,
            language: Language::English,
            written: Vec::new(),
            verified: None,
            machine: None,
        }
    }

    /// Sets another language.
    #[must_use]
    pub fn in_language(self, language: Language) -> Self {
        Self { language, ..self }
    }

    /// Adds files that the run wrote, and their hashes.
    #[must_use]
    pub fn with_written(self, written: Vec<FileRead>) -> Self {
        Self { written, ..self }
    }

    /// Adds the drawing of the machine; its own words are English.
    #[must_use]
    pub fn with_machine(self, machine: Option<&'a MachineShown>) -> Self {
        Self { machine, ..self }
    }

    /// Adds the results of a verified program.
    #[must_use]
    pub fn of_verified(self, verified: VerifiedProgram) -> Self {
        Self {
            verified: Some(verified),
            ..self
        }
    }
}
