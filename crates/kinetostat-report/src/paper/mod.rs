//! A paper to be signed and filed: the report of a run without pictures, in English, French or German, as PDF or HTML.
//!
//! - `content` says what stands in it and in which order, from a run's result alone; nothing is computed anew.
//! - `words` has the texts of each language, `language` how it writes numbers.
//! - `block` is what a paper holds before anybody decides where it stands; `typeset` sets it on pages, `page` as HTML.

pub(crate) mod block;
mod content;
pub(crate) mod language;
mod page;
#[cfg(test)]
mod tests;
#[cfg(feature = "pdf")]
mod typeset;
pub(crate) mod words;

use kinetostat_machining::{FileRead, RunResult};

use crate::ReportError;
use crate::paper::language::Language;
use crate::run::shown::Shown;

/// What a paper is made of.
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
}

/// What `verify` adds to a run: the run's errors before are those of the original, those after those of the program.
#[derive(Clone, Debug, Default)]
pub struct VerifiedProgram {
    /// File name of the original.
    pub original: String,
    /// Whether everything is as it should be.
    pub held: bool,
    /// What is allowed in all, mm.
    pub allowed_mm: f64,
    /// Lines of the original that are not cut, first and last, with their length, mm.
    pub uncut: Vec<([usize; 2], f64)>,
}

impl<'a> Paper<'a> {
    /// Of a run, in English.
    #[must_use]
    pub fn of(result: &'a RunResult) -> Self {
        Self {
            result,
            language: Language::English,
            written: Vec::new(),
            verified: None,
        }
    }

    /// In another language.
    #[must_use]
    pub fn in_language(self, language: Language) -> Self {
        Self { language, ..self }
    }

    /// With files that the run wrote, and their hashes.
    #[must_use]
    pub fn with_written(self, written: Vec<FileRead>) -> Self {
        Self { written, ..self }
    }

    /// Of a program that was verified.
    #[must_use]
    pub fn of_verified(self, verified: VerifiedProgram) -> Self {
        Self {
            verified: Some(verified),
            ..self
        }
    }

    /// The paper as one HTML file, without scripts and network.
    #[must_use]
    pub fn html(&self) -> String {
        page::html(&content::contents(self, &Shown::of_result(self.result)))
    }

    /// The paper as PDF: A4, for archives (PDF/A-2b, where the run has a date), with its letters in it. The same result gives the same bytes.
    ///
    /// # Errors
    ///
    /// [`ReportError::Pdf`] if the document cannot be made; this is a fault of this crate, never of the data.
    #[cfg(feature = "pdf")]
    pub fn pdf(&self) -> Result<Vec<u8>, ReportError> {
        typeset::pdf(&content::contents(self, &Shown::of_result(self.result)))
    }

    /// The paper as PDF; this build makes none.
    ///
    /// # Errors
    ///
    /// [`ReportError::NoPdf`], always.
    #[cfg(not(feature = "pdf"))]
    pub fn pdf(&self) -> Result<Vec<u8>, ReportError> {
        Err(ReportError::NoPdf)
    }

    /// Whether this build makes PDF.
    #[must_use]
    pub fn makes_pdf() -> bool {
        cfg!(feature = "pdf")
    }
}
