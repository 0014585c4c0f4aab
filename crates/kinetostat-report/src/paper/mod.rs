//! A paper to be signed and filed: the report of a run in English, French or German, as HTML or as PDF.
//!
//! - `content` says what stands in it and in which order, from a run's result alone; nothing is computed anew.
//! - `words` has the texts of each language, `language` how it writes numbers.
//! - `block` is what a paper holds before anybody decides where it stands; `typeset` sets it on pages, `page` as HTML.

pub(crate) mod block;
mod content;
pub(crate) mod document;
pub(crate) mod language;
mod page;
pub(crate) mod question;
#[cfg(test)]
mod tests;
#[cfg(feature = "pdf")]
mod typeset;
pub(crate) mod words;

use crate::ReportError;
use crate::paper::question::Paper;
use crate::run::Shown;

impl Paper<'_> {
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

    /// True if this build makes PDF.
    #[must_use]
    pub fn makes_pdf() -> bool {
        cfg!(feature = "pdf")
    }
}
